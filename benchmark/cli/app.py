"""The `benchmark` command: one verb a file (those about what lies on disk in `folders`), exit codes in one place.

Nothing heavy is imported here or at the top of a verb's file, so that `--help` answers at once.
"""

from __future__ import annotations

import sys
import textwrap
import traceback
import warnings
from collections.abc import Sequence
from typing import Annotated

import typer

from bench_hw.starting import refuse_repeats, unsaid, usage_words
from benchmark.cli import (
    blind,
    check,
    discover,
    fit,
    hands_on,
    reproduce,
    run,
    sweep,
    verify,
)
from benchmark.cli.folders import results, shipped

PROGRAM = "python -m benchmark"
EXIT_USAGE = 2
TOO_LITTLE = "there is too little memory for this: end other programs, or ask for less (a coarser mesh, fewer workers)"
EXIT_INTERRUPTED = 130
EXIT_BUG = 70

app = typer.Typer(
    name="benchmark",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for verb in (
    run,
    fit,
    discover,
    blind,
    check,
    sweep,
    results,
    reproduce,
    verify,
    shipped,
    hands_on,
):
    verb.register(app)
refuse_repeats(app)


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"tissuebench {version('tissuebench')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and leave.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    """Validate and benchmark fast soft-tissue models against finite elements and measured trials."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    0 good, 1 a gate failed, 2 usage, configuration or input data, 3 not comparable, 4 a solver did not converge,
    5 a device failed; 70 is a fault of the program itself, 130 an interruption.
    """
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    try:
        if "--debug" not in arguments:  # what NumPy says of an overflow tried on the way is for who mends the program
            warnings.filterwarnings("ignore", category=RuntimeWarning)
            sys.warnoptions.append("ignore::RuntimeWarning")  # for the processes that are started
        code = app(args=arguments or ["--help"], prog_name=PROGRAM, standalone_mode=False)
    except KeyboardInterrupt:
        code = EXIT_INTERRUPTED
    except SystemExit as end:  # nothing of ours ends so; an effects file of the user's may
        return _fail(unsaid() or _who_ended(end), EXIT_USAGE)
    except Exception as error:
        if not _is_interruption(error):
            return _report(error, debug="--debug" in arguments)
        code = EXIT_INTERRUPTED
    if code == EXIT_INTERRUPTED:  # by the command-line library or from before it
        return _fail("interrupted; results that were not finished were not written", EXIT_INTERRUPTED)
    if not arguments:
        return EXIT_USAGE
    return code if isinstance(code, int) else 0


def _is_interruption(error: BaseException | None) -> bool:
    """Whether an error is Ctrl-C under another name, as libraries give it whose callbacks it met.

    An error `from None` speaks for itself.
    """
    while error is not None:
        if isinstance(error, KeyboardInterrupt) or "KeyboardInterrupt" in str(error):
            return True
        error = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    return False


def _report(error: Exception, *, debug: bool) -> int:
    """Print one paragraph for an error and return its exit code."""
    if debug:
        traceback.print_exc()
    if hasattr(error, "format_message"):  # a usage error of the command-line library
        return _fail(usage_words(error, PROGRAM), EXIT_USAGE)
    if isinstance(error, typer.Abort):
        return _fail("interrupted", EXIT_INTERRUPTED)
    from bench_hw.errors import BenchError, refusal, system_words, what_is_missing
    from benchmark.errors import TissuebenchError

    if isinstance(error, TissuebenchError | BenchError):
        return _fail(str(error), error.exit_code)
    refused = refusal(error)
    if refused is not None:
        return _fail(unsaid() or system_words(refused), EXIT_USAGE)
    if isinstance(error, MemoryError):
        return _fail(f"{TOO_LITTLE}; {error}" if str(error) else TOO_LITTLE, EXIT_USAGE)
    missing = what_is_missing(error)
    if missing is not None:
        return _fail(missing, EXIT_USAGE)
    text = f"a fault of the program, {type(error).__name__}: {error}; --debug shows where"
    return _fail(text, EXIT_BUG)


def _who_ended(end: SystemExit) -> str:
    """Where the program was told to end, in a sentence."""
    from benchmark.child_processes import exit_unless_users

    frame = traceback.extract_tb(end.__traceback__)[-1]
    if frame.name == exit_unless_users.__name__:  # it stands for os._exit, which is called a frame before
        frame = traceback.extract_tb(end.__traceback__)[-2]
    return (
        f"{frame.filename}, line {frame.lineno}: the program was told to end there (exit code {end.code}) and has no "
        "result; a file of effects or a model must return instead"
    )


def _fail(text: str, code: int) -> int:
    """Write the paragraph to stderr."""
    print(
        textwrap.fill(f"error: {text}", width=100, break_long_words=False, break_on_hyphens=False),
        file=sys.stderr,
    )
    return code
