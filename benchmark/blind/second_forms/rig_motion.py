"""Second forms of effects between motor and specimen: a tilted tool, a dead gap, one loose screw, soft bearings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, play
from benchmark.blind.motion import Array


@dataclass(frozen=True, kw_only=True)
class LeaningTool(Hidden):
    """The tool stands beside the middle towards `angle` (rad), and the sheet moves more on that side."""

    slug = "off_centre_load"
    only_markers = True
    angle: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Any direction."""
        return cls(scale=scale, angle=float(rng.uniform(-np.pi, np.pi)))

    def centre(self) -> tuple[float, float]:
        """Where the axis is."""
        offset = 5e-3 * self.amplitude
        return offset * float(np.cos(self.angle)), offset * float(np.sin(self.angle))

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """A slope over the field of 2 % for each millimetre of offset."""
        side = (x * np.cos(self.angle) + y * np.sin(self.angle)) / 15e-3
        factor = np.outer(np.ones(depth.size), 1.0 + 0.1 * self.amplitude * side)
        return factor, factor


class DeadGap(Hidden):
    """Nothing moves until the gap is used up."""

    slug = "contact_gap"
    largest = 2.0

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth less the gap."""
        gap = 0.4 * self.amplitude * self.scale.shallow
        return np.where(depth > 0.0, np.clip(depth - gap, 0.0, None), depth)


@dataclass(frozen=True, kw_only=True)
class LooseScrew(Hidden):
    """One play of one width; `side` as in the first form."""

    slug = "backlash"
    side: int

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either side."""
        return cls(scale=scale, side=int(rng.choice([-1, 1])))

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """What is left of the motion behind the play."""
        lost = 0.3 * self.amplitude * self.scale.shallow
        start = float(depth[0]) + 0.5 * self.side * lost
        out: Array = play(depth, lost, start) - start + depth[0]
        return out


class SoftBearings(Hidden):
    """Bearings that give way at small loads and then lie on: c (F + 3 F0 (1 - exp(-F / (0.3 F0)))) / 4."""

    slug = "machine_compliance"
    only_markers = True
    gives_way = True
    largest = 2.0

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth less what the rig has given way."""
        load = np.clip(force / self.scale.force, 0.0, None)
        lost = 0.7 * load - 0.3 * np.expm1(-load / 0.3)
        return depth - 0.15 * self.amplitude * self.scale.deep * lost
