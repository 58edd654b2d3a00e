"""Hidden effects between motor and specimen: a gap, backlash, a rig that gives way, a tool beside its axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.body.specimens import HOLE_RADIUS
from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, play
from benchmark.blind.motion import Array

WIDTHS = (0.6, 1.0, 1.4)


@dataclass(frozen=True, kw_only=True)
class HiddenOffCentreLoad(Hidden):
    """The whole field moves to `angle` (rad); nearer to the rim the sheet is a little stiffer."""

    slug = "off_centre_load"
    only_markers = True
    angle: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Any direction."""
        return cls(scale=scale, angle=float(rng.uniform(-np.pi, np.pi)))

    @property
    def offset(self) -> float:
        """Of the axis, m."""
        return 5e-3 * self.amplitude

    def centre(self) -> tuple[float, float]:
        """Where the axis is."""
        return self.offset * float(np.cos(self.angle)), self.offset * float(np.sin(self.angle))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Stiffer towards the rim."""
        return 0.8 * (self.offset / HOLE_RADIUS) ** 2 * elastic


class HiddenContactGap(Hidden):
    """Travel is lost up to the gap, and less and less of it on the way there."""

    slug = "contact_gap"
    largest = 2.0

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth less what the gap has taken."""
        gap = 0.4 * self.amplitude * self.scale.shallow
        if gap == 0.0:
            return depth
        lost = gap * (1.0 - np.exp(-((np.clip(depth, 0.0, None) / (0.6 * gap)) ** 2)))
        return np.where(depth > 0.0, np.clip(depth - lost, 0.0, None), depth)


@dataclass(frozen=True, kw_only=True)
class HiddenBacklash(Hidden):
    """`side` -1: taken up for pressing when the trial begins; +1: for retracting, so that the first press is late."""

    slug = "backlash"
    side: int

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either side."""
        return cls(scale=scale, side=int(rng.choice([-1, 1])))

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """What is left of the motion behind the plays."""
        lost = 0.3 * self.amplitude * self.scale.shallow
        out = np.zeros_like(depth)
        for share in WIDTHS:
            start = depth[0] + 0.5 * self.side * share * lost
            out += (play(depth, share * lost, start) - start + depth[0]) / len(WIDTHS)
        return out


class HiddenMachineCompliance(Hidden):
    """Lost depth c F + c2 F^2 / (1 + F / F0)."""

    slug = "machine_compliance"
    only_markers = True  # in series with a linear specimen its force is a gain, and nobody can see it
    gives_way = True
    largest = 2.0

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth less what the rig has given way."""
        load = force / self.scale.force
        return depth - 0.15 * self.amplitude * self.scale.deep * (0.6 * load + 0.8 * load**2 / (1.0 + abs(load)))
