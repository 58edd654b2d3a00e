"""Which faults a twin is to show, by position in its stream (counted from 1) or by chance."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from bench_hw.errors import InputError


@dataclass(frozen=True, slots=True)
class StreamFaults:
    """Faults of a stream of records.

    Parameters
    ----------
    loss : float
        Chance that a record is lost, 0 to 1.
    drop, duplicate, reorder : frozenset of int
        Positions that are lost, sent twice, or sent after the record that follows.
    duplication, reordering : float
        The same by chance, 0 to 1.
    """

    loss: float = 0.0
    drop: frozenset[int] = field(default_factory=frozenset)
    duplicate: frozenset[int] = field(default_factory=frozenset)
    reorder: frozenset[int] = field(default_factory=frozenset)
    duplication: float = 0.0
    reordering: float = 0.0

    def __post_init__(self) -> None:
        for name in ("loss", "duplication", "reordering"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise InputError(f"{name} = {getattr(self, name)}: allowed are 0 to 1")


def parse_positions(text: str) -> frozenset[int]:
    """Read positions like `200-202,500`.

    Raises
    ------
    InputError
        Not numbers and ranges separated by commas, below 1, or a range that runs backwards.
    """
    return frozenset(position for part in text.split(",") if part.strip() for position in _range(part.strip()))


def _range(part: str) -> Iterable[int]:
    first, dash, last = part.partition("-")
    ends = (first, last if dash else first)
    if not all(end.strip().isdecimal() for end in ends) or not 1 <= int(ends[0]) <= int(ends[1]) <= 10_000_000:
        raise InputError(f"positions {part!r}: allowed are numbers from 1 and ranges like 200-202")
    return range(int(ends[0]), int(ends[1]) + 1)
