"""Agreement and ratios of one case, as figures and as lines of text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.performance.peers.running import Timing

PARTS = ("process", "cpu", "solve")


@dataclass(frozen=True)
class Ratio:
    """Medians over the repeats, with the range."""

    median: float
    least: float
    most: float

    def __str__(self) -> str:
        """Median and range."""
        return f"{self.median:.2f} [{self.least:.2f}, {self.most:.2f}]"

    @classmethod
    def of(cls, values: Sequence[float]) -> Ratio:
        """Of one value a repeat."""
        return cls(float(np.median(values)), float(np.min(values)), float(np.max(values)))


@dataclass(frozen=True)
class Compared:
    """One program on one case.

    Attributes
    ----------
    seconds, ratio
        For each of "process", "cpu" and "solve": times in s, and times over ours of the same repeat.
    difference
        Largest difference of the displacements from ours, over our largest displacement.
    """

    program: str
    seconds: Mapping[str, Ratio]
    ratio: Mapping[str, Ratio]
    difference: float

    def __str__(self) -> str:
        """One line."""
        return (
            f"  {self.program:9s} process {self.seconds['process']} s, CPU {self.seconds['cpu']} s, "
            f"solve {self.seconds['solve']} s; over ours: process {self.ratio['process']}, CPU {self.ratio['cpu']}, "
            f"solve {self.ratio['solve']}; largest difference {self.difference:.1e}"
        )


def compare(runs: Mapping[str, Sequence[Timing]]) -> dict[str, Compared]:
    """Every program against ours, repeat by repeat."""
    own = runs["ours"]
    reference = own[0].displacement
    found = {}
    for name, timings in runs.items():
        seconds = {part: Ratio.of([getattr(t, part) for t in timings]) for part in PARTS}
        ratio = {
            part: Ratio.of([getattr(t, part) / getattr(o, part) for t, o in zip(timings, own, strict=True)])
            for part in PARTS
        }
        off = float(np.nanmax(np.abs(timings[0].displacement - reference)) / np.abs(reference).max())
        found[name] = Compared(name, seconds, ratio, off)
    return found
