"""Runs cases one after the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import perf_counter

from benchmark.errors import InputError
from benchmark.verification.row import Row, rows_of
from benchmark.verification.selection import wanted
from fem.verification import Case


def run_cases(
    cases: Sequence[Case],
    names: Sequence[str] = (),
    on_case: Callable[[Case, int], None] | None = None,
    clock: Callable[[], float] = perf_counter,
) -> tuple[Row, ...]:
    """Compute cases; one that fails to compute becomes a row that did not pass, and the others go on.

    Parameters
    ----------
    cases
        Those selected by `names`.
    names
        What the user named; rows outside it are left out.
    on_case
        Called before each case with its number from 0.
    clock
        Seconds that rise.

    Raises
    ------
    InputError
        A name fits a case but none of its rows.
    """
    rows: list[Row] = []
    for number, case in enumerate(cases):
        if on_case is not None:
            on_case(case, number)
        rows += run_case(case, clock)
    for name in names:
        if not any(_answers(row, name) for row in rows):
            known = ", ".join(row.case for row in rows if wanted(row.case, [name.rpartition("/")[0]]))
            raise InputError(f"verify: no quantity is called {name!r}; there are {known}")
    return tuple(row for row in rows if row.quantity is None or wanted(row.case, names))


def run_case(case: Case, clock: Callable[[], float] = perf_counter) -> tuple[Row, ...]:
    """Compute one case."""
    start = clock()
    try:
        found = case.compute()
    except (ArithmeticError, ValueError, RuntimeError) as error:  # what solvers raise; a fault of ours goes through
        return (Row(case.name, case.source, None, clock() - start, f"{type(error).__name__}: {error}"),)
    return rows_of(case, found, clock() - start)


def _answers(row: Row, name: str) -> bool:
    """Say whether a row is what a user named, or stands for it because its case could not be computed."""
    return wanted(row.case, [name]) or (row.quantity is None and wanted(name, [row.case]))
