"""Which cases there are, and which a user means."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

from benchmark.errors import InputError
from fem.verification import Case


def all_cases() -> tuple[Case, ...]:
    """Every case of the finite elements and of the wave model."""
    from benchmark.verification import wave_model
    from fem.verification.registry import fem_cases

    return (*fem_cases(), *wave_model.cases())


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
    near = difflib.get_close_matches(name, [*families(cases), *(case.name for case in cases)], n=3)
    meant = f"did you mean {' or '.join(near)}? " if near else ""
    return f"{meant}Families: {', '.join(families(cases))}"
