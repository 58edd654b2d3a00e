"""What every verb shares: its common options, its errors in one paragraph, its JSON on standard output."""

from __future__ import annotations

import json
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer

from bench_hw.errors import BenchError, refusal, system_words, what_is_missing
from bench_hw.starting import unsaid

EXIT_MISSING = 2
EXIT_BUG = 70
"""A mistake in the program; the codes of the contract stay for what a user can mend."""

Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object and nothing else; without a result stdout is empty.")
]
Debug = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print errors only.")]


@contextmanager
def reporting(debug: bool = False) -> Iterator[None]:
    """Turn an error of the bench into a paragraph on standard error and its exit code.

    Parameters
    ----------
    debug : bool
        Print the traceback, too.

    Raises
    ------
    typer.Exit
        With the error's exit code; 2 where a file cannot be written or read.
    """
    try:
        yield
    except (BenchError, OSError, MemoryError) as error:
        if debug:
            traceback.print_exc()
        say_error(error)
        raise typer.Exit(error.exit_code if isinstance(error, BenchError) else 2) from error


def say_error(error: BaseException) -> None:
    """Print an error, and what was noted on it, as one paragraph on standard error."""
    said = unsaid() or system_words(error) if isinstance(error, OSError) else str(error)
    plain = "there is too little memory for this" if isinstance(error, MemoryError) else type(error).__name__
    parts = [said or plain, *getattr(error, "__notes__", [])]
    print("error: " + " ".join("; ".join(parts).split()), file=sys.stderr)


def report_unexpected(error: Exception, debug: bool) -> int:
    """Print an error that no verb foresaw, and return the exit code: the system's, a library left out, our mistake."""
    if debug:
        traceback.print_exception(error)
    refused = refusal(error)
    if refused is not None:
        say_error(refused)
        return EXIT_MISSING
    missing = what_is_missing(error)
    if missing is not None:
        print(f"error: {missing}", file=sys.stderr)
        return EXIT_MISSING
    hint = "" if debug else "; `--debug` shows where"
    print(f"unexpected error: {type(error).__name__}: {error}{hint}", file=sys.stderr)
    return EXIT_BUG


def print_json(content: dict[str, Any]) -> None:
    """Print one JSON object; what is not a number in it becomes null."""
    print(json.dumps(_plain(content), indent=2, allow_nan=False, ensure_ascii=False))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and not abs(value) < float("inf"):
        return None
    return value
