"""The application: it finds the verbs beside it and turns whatever goes wrong into one paragraph.

A verb is a module of this package with a function `register(app)`. It imports what it needs inside its
command, so that `--help` answers at once.
"""

from __future__ import annotations

import importlib
import os
import pkgutil
import sys
from pathlib import Path
from typing import Annotated

import typer

from bench_hw.cli._report import EXIT_MISSING, report_unexpected, say_error
from bench_hw.starting import EXIT_INTERRUPTED, interrupted, refuse_repeats, usage_words

PROGRAM = "python -m bench_hw"


def make_app() -> typer.Typer:
    """Make the application with all verbs, in alphabetical order."""
    application = typer.Typer(
        name="bench_hw",
        help="The measuring bench: devices, trials, files. Exit codes: 0 good, 2 input, 5 a device failed.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
    )
    application.callback()(_bench)
    for module in sorted(pkgutil.iter_modules([str(Path(__file__).parent)]), key=lambda info: info.name):
        if not module.name.startswith("_"):
            importlib.import_module(f"bench_hw.cli.{module.name}").register(application)
    refuse_repeats(application)
    return application


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"tissuebench {version('tissuebench')}")
        raise typer.Exit


def _bench(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and leave.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    """Measure with the bench, look at what was measured, save it, take it elsewhere."""


app = make_app()


def main() -> int:
    """Run the command line and return its exit code."""
    os.environ.setdefault("OPENCV_LOG_LEVEL", "SILENT")  # a camera that is missing is said by the bench itself
    try:
        code = app(prog_name=PROGRAM, standalone_mode=False)
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # the command-line library met it
            say_error(end.__context__)
            return EXIT_MISSING
        return end.code if isinstance(end.code, int) else 1
    except Exception as error:
        if hasattr(error, "format_message"):  # a usage error of the command-line library
            helped = type(error).__name__ == "NoArgsIsHelpError"  # which is not public; its message is the help
            said = error.format_message() if helped else f"error: {usage_words(error, PROGRAM)}"
            print(said, file=sys.stderr)
            return EXIT_MISSING
        return report_unexpected(error, debug="--debug" in sys.argv)
    if code == EXIT_INTERRUPTED:  # the command-line library met it, and says nothing
        return interrupted()
    return code if isinstance(code, int) else 0
