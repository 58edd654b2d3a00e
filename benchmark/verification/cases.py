"""The cases of `verify`: which there are and which a user means, one after the other, a row for each quantity."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

from benchmark.errors import InputError
from fem.verification import Case, Quantity


@dataclass(frozen=True)
class VerificationRow:
    """A compared quantity of a case, or a case that could not be computed.

    Attributes
    ----------
    case
        Name of the case, "/" and the quantity where there are several.
    source
        Where the reference comes from.
    quantity
        What was compared; None where the case failed before.
    seconds
        Wall time of the case; its quantities come from the same run and share it.
    reason
        Why the case could not be computed, or "".
    """

    case: str
    source: str
    quantity: Quantity | None
    seconds: float
    reason: str = ""

    @property
    def passed(self) -> bool:
        """Whether there is a quantity and its error is allowed."""
        return self.quantity is not None and self.quantity.passed

    def to_dict(self) -> dict[str, Any]:
        """Return the row as `verification.json` has it; None stands for what could not be computed."""
        found = self.quantity
        return {
            "case": self.case,
            "source": self.source,
            "reference": None if found is None else found.reference,
            "ours": None if found is None else found.ours,
            "unit": "" if found is None else found.unit,
            "error_percent": None if found is None else found.error_percent,
            "allowed_percent": None if found is None else found.allowed_percent,
            "unknowns": None if found is None else found.unknowns,
            "seconds": self.seconds,
            "passed": self.passed,
        }


def rows_of(case: Case, found: tuple[Quantity, ...], seconds: float) -> tuple[VerificationRow, ...]:
    """Rows of a computed case."""
    names = (f"{case.name}/{quantity.name}" if quantity.name else case.name for quantity in found)
    return tuple(
        VerificationRow(name, case.source, quantity, seconds) for name, quantity in zip(names, found, strict=True)
    )


def all_cases() -> tuple[Case, ...]:
    """Every case of the finite elements and of the wave model."""
    from benchmark.verification import wave_cases
    from fem.verification.registry import fem_cases

    return (*fem_cases(), *wave_cases.cases())


def families(cases: Sequence[Case]) -> tuple[str, ...]:
    """First words of the names, each once, in order."""
    return tuple(dict.fromkeys(case.name.partition("/")[0] for case in cases))


def select(cases: Sequence[Case], names: Sequence[str]) -> tuple[Case, ...]:
    """Return the cases a user names by family, by case, or by the row of a case; all where nothing is named.

    Raises
    ------
    InputError
        A name fits no case.
    """
    for name in names:
        if not any(_fits(case, name) for case in cases):
            raise InputError(f"verify: no case is called {name!r}; {_allowed(cases, name)}")
    return tuple(case for case in cases if not names or any(_fits(case, name) for name in names))


def wanted(row: str, names: Sequence[str]) -> bool:
    """Say whether a row is among what a user names."""
    return not names or any(_within(row, name) for name in names)


def _fits(case: Case, name: str) -> bool:
    return _within(case.name, name) or _within(name, case.name)


def _within(name: str, whole: str) -> bool:
    """Say whether `name` is `whole` or a part of it."""
    return name == whole or name.startswith(f"{whole}/")


def _allowed(cases: Sequence[Case], name: str) -> str:
    near = difflib.get_close_matches(name, dict.fromkeys([*families(cases), *(case.name for case in cases)]), n=3)
    meant = f"did you mean {' or '.join(near)}? " if near else ""
    return f"{meant}Families: {', '.join(families(cases))}"


def run_cases(
    cases: Sequence[Case],
    names: Sequence[str] = (),
    on_case: Callable[[Case, int], None] | None = None,
    clock: Callable[[], float] = perf_counter,
) -> tuple[VerificationRow, ...]:
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
    rows: list[VerificationRow] = []
    for number, case in enumerate(cases):
        if on_case is not None:
            on_case(case, number)
        rows += run_case(case, clock)
    for name in names:
        if not any(_answers(row, name) for row in rows):
            known = ", ".join(row.case for row in rows if wanted(row.case, [name.rpartition("/")[0]]))
            raise InputError(f"verify: no quantity is called {name!r}; there are {known}")
    return tuple(row for row in rows if row.quantity is None or wanted(row.case, names))


def run_case(case: Case, clock: Callable[[], float] = perf_counter) -> tuple[VerificationRow, ...]:
    """Compute one case."""
    start = clock()
    try:
        found = case.compute()
    except (ArithmeticError, ValueError, RuntimeError) as error:  # what solvers raise; a fault of ours goes through
        return (VerificationRow(case.name, case.source, None, clock() - start, f"{type(error).__name__}: {error}"),)
    return rows_of(case, found, clock() - start)


def _answers(row: VerificationRow, name: str) -> bool:
    """Say whether a row is what a user named, or stands for it because its case could not be computed."""
    return wanted(row.case, [name]) or (row.quantity is None and wanted(name, [row.case]))
