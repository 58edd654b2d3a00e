"""What the comparison must show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from tests.performance.peers.comparison import Compared

Cases = Mapping[str, Mapping[str, Compared]]


@dataclass(frozen=True)
class Bar:
    """A figure with its limit; `least` bars are for speed, the others for agreement or growth."""

    name: str
    value: float
    limit: float
    least: bool

    @property
    def held(self) -> bool:
        """Whether the figure is within its limit."""
        return self.value >= self.limit if self.least else self.value <= self.limit

    def __str__(self) -> str:
        """One line."""
        sign = ">=" if self.least else "<="
        return f"  {'held  ' if self.held else 'MISSED'} {self.name}: {self.value:.3g} ({sign} {self.limit:g})"


SPEED = (
    ("linear 44k", "calculix", 1.5),
    ("linear 97k", "calculix", 2.0),
    ("hyperelastic", "calculix", 4.0),
    ("hyperelastic", "felupe", 3.0),
)
PARTS = (("process", "whole process"), ("cpu", "its CPU time"))
AGREEMENT = {("linear", "calculix"): 1e-5, ("linear", "felupe"): 1e-8, ("hyperelastic", "felupe"): 1e-6}


def bars(found: Cases, unknowns: Mapping[str, int]) -> Iterator[Bar]:
    """The bars of the programs and cases that were run."""
    for case, program, limit in SPEED:
        for part, words in PARTS:
            if program in found.get(case, {}):
                yield Bar(f"{case}, {program} over ours, {words}", found[case][program].ratio[part].median, limit, True)
    for (kind, program), limit in AGREEMENT.items():
        differences = [c[program].difference for name, c in found.items() if name.startswith(kind) and program in c]
        if differences:
            yield Bar(f"{kind}, largest difference from {program}", max(differences), limit, False)
    for part, words in PARTS:
        sizes = {unknowns[c]: found[c]["ours"].seconds[part].median for c in found if c.startswith("linear")}
        large = {size: seconds for size, seconds in sizes.items() if size >= 15_000}
        if len(large) > 1:
            exponent = np.polyfit(np.log(list(large)), np.log(list(large.values())), 1)[0]
            yield Bar(
                f"growth exponent of ours from {min(large)} to {max(large)} unknowns, {words}", exponent, 1.5, False
            )
