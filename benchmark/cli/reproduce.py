"""`benchmark reproduce`: the article's printed numbers and figures, computed live."""

from __future__ import annotations

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("reproduce", help=reproduce.__doc__)(reproduce)


def reproduce(out: Out = None, json: Json = False, quiet: Quiet = False, debug: Debug = False) -> int:
    """Recompute the article's Tables 1 and 2 and equations 5 to 8, and redraw its figures.

    Writes reproduce.json, tables/items.csv and report.html. Exit code 0 whatever it finds.
    """
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.reproduce import reproduce as carry_out
    from benchmark.reproduce.items import headline, text_table

    made = carry_out(out, Console(quiet=quiet))
    if json:
        print_json({**made.document, "out": str(made.folder)})
    else:
        print(f"{text_table(made.items)}\n\n{headline(made.items)}.\n  report: {made.report}")
    return 0
