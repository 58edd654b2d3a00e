"""The verdict: what the reader must know first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from reports.blocks.base import one_of

VERDICTS: Mapping[str, str] = MappingProxyType(
    {"good": "Good", "finding": "Finding", "failed": "Failed", "incomplete": "Incomplete", "unknown": "Unknown"}
)


@dataclass(frozen=True)
class Verdict:
    """What the reader must know first.

    Attributes
    ----------
    status
        `good`, `finding`, `failed`, `incomplete` or `unknown` (the data cannot tell).
    headline
        One sentence.
    points
        The lines under it.
    """

    status: str
    headline: str
    points: Sequence[str] = ()

    def __post_init__(self) -> None:
        one_of("Verdict status", self.status, VERDICTS)

    @property
    def label(self) -> str:
        """The status as a word."""
        return VERDICTS[self.status]
