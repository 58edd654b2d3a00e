"""`benchmark blind`: the discovery on sessions with hidden effects."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from benchmark.cli.options import Debug, Json, Out, Quiet, Seed

if TYPE_CHECKING:
    from benchmark.blind.scoring.judging import Judged

Suite = Annotated[str, typer.Option("--suite", help="small | first | medium | labs | full.")]
Cases = Annotated[str, typer.Option("--cases", metavar="SLUG,...", help="Only these effects, pairs, or null.")]
Labs = Annotated[str, typer.Option("--labs", metavar="LAB,...", help="Only cases of these labs (docs/blind.md).")]
Most = Annotated[int, typer.Option("--most", min=0, metavar="N", help="Only the first N cases; 0 for all.")]
Scheduler = Annotated[
    str, typer.Option("--scheduler", metavar="ADDRESS", help="A Dask cluster that works instead of local processes.")
]
Workers = Annotated[int, typer.Option("--workers", min=1, help="Processes.")]
PrintScatter = Annotated[
    str, typer.Option("--print-scatter", metavar="LENGTH", help='How far markers are printed off, as "0.06 mm".')
]
Named = Annotated[
    str,
    typer.Option(
        "--discoverer", metavar="MODULE:FUNCTION", help="Another discovery, called with a session and a seed."
    ),
]
Without = Annotated[str, typer.Option("--without", metavar="PART", help="The discovery without one of its parts.")]

Experiments = Annotated[
    int,
    typer.Option(
        "--experiments", min=0, metavar="N", help="Do up to N proposed experiments on each case, and decide again."
    ),
]

MOST_SCATTER = 1e-3
"""Markers printed farther off than this are no grid, m."""


def register(app: typer.Typer) -> None:
    """Add the verb to the command line."""
    app.command("blind", help=blind.__doc__)(blind)


def blind(
    suite: Suite = "small",
    cases: Cases = "",
    labs: Labs = "",
    out: Out = None,
    seed: Seed = 0,
    workers: Workers = 2,
    scheduler: Scheduler = "",
    most: Most = 0,
    print_scatter: PrintScatter = "",
    discoverer: Named = "benchmark.discovery:discover",
    without: Without = "",
    experiments: Experiments = 0,
    json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> int:
    """Hide effects in synthetic sessions and count how often the discovery finds and names them.

    Writes report.html, table.md, cases.csv, confusion.csv and blind.json. The same command goes on where it was
    stopped. Exit code 0 whatever it finds.
    """
    from benchmark.blind.blind_folder import confusion_text, finish, open_folder, rows_of, text_table
    from benchmark.blind.running import load_discoverer, run_cases
    from benchmark.blind.suites import chosen
    from benchmark.blind.suites import suite as cases_of
    from benchmark.cli.console import Console
    from benchmark.cli.show import print_json
    from benchmark.resumable import going_on, say_waiting
    from benchmark.runs.output.destination import claimed, fresh

    console = Console(quiet=quiet)
    slugs, places = _listed(cases), _listed(labs)
    scatter = _scatter(print_scatter)
    picked = chosen(cases_of(suite, seed), slugs, places)[: most or None]
    names = tuple(replace(each, print_scatter=scatter) for each in picked)
    discoverer = _discoverer(discoverer, without)
    _check_loop(experiments, discoverer)
    settings = {"suite": suite, "seed": seed, "cases": list(slugs), "discoverer": discoverer}
    settings |= {"print_scatter": print_scatter} if scatter else {}
    settings |= {"labs": list(places)} if places else {}
    settings |= {"most": most} if most else {}
    settings |= {"experiments": experiments} if experiments else {}
    folder = fresh("blind") if out is None else out
    load_discoverer(discoverer)
    with claimed(out, "blind"), console.progress(f"blind trials, suite {suite} (synthetic)") as advance:
        journal = open_folder(folder, settings)
        say_waiting(folder, console.say)

        def on_case(done: int, total: int, last: Judged | None) -> None:
            remark = "" if last is None else f"{last.truth or 'null'}: {last.verdict} {last.said}"
            advance("cases", done, total, remark)

        with going_on(folder):
            judged = run_cases(names, discoverer, journal, scheduler or workers, on_case, experiments, console.say)
            result = finish(folder, settings, judged)
    if json:
        print_json({**result, "out": str(folder)})
    else:
        print(text_table(rows_of(settings, judged)))
        print(f"\ntaken for something else:\n{confusion_text(judged)}\n  report: {folder / 'report.html'}")
    return 0


def _listed(text: str) -> tuple[str, ...]:
    """What stands between commas."""
    return tuple(each.strip() for each in text.split(",") if each.strip())


def _discoverer(discoverer: str, without: str) -> str:
    """The discovery that is put on trial; raises InputError."""
    from benchmark.blind.rivals.ablations import discoverer_without
    from benchmark.blind.running import PRODUCT
    from benchmark.errors import InputError

    if not without:
        return discoverer
    if discoverer != PRODUCT:
        raise InputError(f"--without {without!r}: only the product's own discovery has parts; leave --discoverer out")
    return discoverer_without(without)


def _check_loop(experiments: int, discoverer: str) -> None:
    """Raise InputError where another discovery is to propose experiments."""
    from benchmark.blind.running import PRODUCT
    from benchmark.errors import InputError

    if experiments and discoverer != PRODUCT:
        raise InputError("--experiments: only the product's own discovery proposes them; leave --discoverer out")


def _scatter(text: str) -> float:
    """A print scatter in m; raises InputError."""
    from benchmark.errors import InputError
    from benchmark.files.units import LENGTH, QuantityError, parse_quantity

    if not text:
        return 0.0
    try:
        value = parse_quantity(text, LENGTH)
    except QuantityError as error:
        raise InputError(f"--print-scatter {text!r}: {error}") from None
    if not 0.0 <= value <= MOST_SCATTER:
        raise InputError(f'--print-scatter {text!r}: allowed: 0 mm to {1e3 * MOST_SCATTER:g} mm, as "0.06 mm"')
    return value
