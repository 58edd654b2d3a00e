"""The two models that a figure compares: how each is drawn, and what it is called."""

from __future__ import annotations

from dataclasses import dataclass, replace

from reports.figures.style import FEM, WAVE, Stroke
from reports.formatting import shortened

LABEL_LENGTH = 24


@dataclass(frozen=True)
class Pair:
    """The reference (drawn as the FEM) and the fast model beside it (drawn as the wave)."""

    fem: Stroke = FEM
    wave: Stroke = WAVE

    @classmethod
    def named(cls, fem: str | None = None, wave: str | None = None) -> Pair:
        """Return the pair with names of its own; None keeps the name."""
        return cls(_named(FEM, fem), _named(WAVE, wave))

    def caption(self, both: bool, fem: str = "solid", wave: str = "dashed") -> str:
        """Say which line is which model, or that the second one has no values."""
        if both:
            return f"{self.fem.name} ({fem}) and {self.wave.name} ({wave})"
        return f"{self.fem.name} alone; the {self.wave.name} has no values here"


DEFAULT = Pair()


def _named(stroke: Stroke, name: str | None) -> Stroke:
    return stroke if name is None else replace(stroke, label=shortened(name, LABEL_LENGTH), name=name)
