"""Second forms of effects that follow the history of the press: power laws, plastic elements, published drainage."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from scipy.signal import fftconvolve
from scipy.special import erf

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, lost_memory, play, touching
from benchmark.blind.motion import Array

DECADES = np.geomspace(0.05, 50.0, 16)
"""Times of a power law's modes, s."""


@dataclass(frozen=True, kw_only=True)
class PowerLawRelaxation(Hidden):
    """Memory that fades as t^-`power`, `hurry` times faster under the largest load (Schapery's shifted time)."""

    slug = "viscoelastic_relaxation"
    power: float
    hurry: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Powers 0.1 to 0.3, up to twice as fast."""
        return cls(scale=scale, power=float(rng.uniform(0.1, 0.3)), hurry=float(rng.uniform(0.0, 1.0)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What has been forgotten is missing."""
        shares = DECADES**-self.power
        faster = 1.0 + self.hurry * np.clip(elastic, 0.0, None) / self.scale.force
        lost: Array = lost_memory(time, elastic, faster[:, None] / DECADES) @ (shares / shares.sum())
        return -0.5 * self.amplitude * lost


@dataclass(frozen=True, kw_only=True)
class EyringDamping(Hidden):
    """Drag asinh(v / v0) (Eyring's flow), growing with depth; `bend` is the fastest speed over v0."""

    slug = "viscous_damping"
    bend: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """A little or more bent."""
        return cls(scale=scale, bend=float(rng.uniform(0.5, 3.0)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Against the motion."""
        drag = np.arcsinh(self.bend * np.gradient(depth, time) / self.scale.speed) / np.arcsinh(self.bend)
        grown = touching(depth, 0.1 * self.scale.shallow) * (0.4 + 0.6 * np.clip(depth, 0.0, None) / self.scale.deep)
        drawn: Array = 0.3 * self.amplitude * self.scale.force * grown * drag
        return drawn


@dataclass(frozen=True, kw_only=True)
class PunchDrainage(Hidden):
    """Relaxation under a cylindrical punch, g = 1.304 exp(-sqrt(s)) - 0.304 exp(-0.254 s), s = t / `time`.

    Hu, Zhao, Vlassak and Suo, Applied Physics Letters 96 (2010) 121904.
    """

    slug = "poroelastic_drainage"
    time: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """One to eight seconds."""
        return cls(scale=scale, time=float(np.exp(rng.uniform(0.0, np.log(8.0)))))

    def under_tool(self, radius: float) -> Self:
        """Fluid has farther to go: the time grows with the radius squared."""
        longer = (radius / self.scale.tool_radius) ** 2
        return replace(super().under_tool(radius), time=longer * self.time)

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What has drained is missing: each rise of the force drains by itself."""
        since = (time - time[0]) / self.time
        drained = 1.0 - (1.304 * np.exp(-np.sqrt(since)) - 0.304 * np.exp(-0.254 * since))
        lost: Array = fftconvolve(np.diff(elastic, prepend=0.0), drained)[: time.size]
        return -0.5 * self.amplitude * lost


@dataclass(frozen=True, kw_only=True)
class EnergySoftening(Hidden):
    """Ogden and Roxburgh's loss: the error function of the energy that the deepest press had more, over `width`."""

    slug = "stress_softening"
    largest = 2.0
    width: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Sharp or wide."""
        return cls(scale=scale, width=float(rng.uniform(0.2, 0.8)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What is missing."""
        energy = (np.clip(depth, 0.0, None) / self.scale.deep) ** 2
        loss: Array = erf((np.maximum.accumulate(energy) - energy) / self.width)
        return -0.4 * self.amplitude * loss * elastic


@dataclass(frozen=True, kw_only=True)
class YieldSet(Hidden):
    """What is pressed beyond a yield depth stays at once; `shown` of it in the lower face."""

    slug = "permanent_set"
    largest = 3.0
    limit: float
    shown: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Yield at 0.1 to 0.4 of the shallow press, seen by the camera or not."""
        return cls(scale=scale, limit=float(rng.uniform(0.1, 0.4)), shown=float(rng.choice([0.0, 0.5, 1.0])))

    def indent(self, time: Array, depth: Array) -> Array:
        """Depth less the set so far."""
        return depth - self._set(depth)

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """The lower face keeps its share of the set."""
        return np.clip(strained, 0.0, None) + self.shown * self._set(depth)

    def _set(self, depth: Array) -> Array:
        beyond = np.maximum.accumulate(np.clip(depth - self.limit * self.scale.shallow, 0.0, None))
        return 0.2 * self.amplitude * beyond


@dataclass(frozen=True, kw_only=True)
class IwanFriction(Hidden):
    """Four stops side by side that slip after other distances (Iwan's model), rested in air."""

    slug = "dry_friction"
    reach: float
    growing: bool

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """A friction force that grows with depth, or not."""
        return cls(scale=scale, reach=float(rng.uniform(0.05, 0.15)) * scale.shallow, growing=bool(rng.random() < 0.5))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Friction against the motion."""
        path = np.clip(depth, 0.0, None)
        state = np.zeros_like(path)
        for share in (0.4, 0.8, 1.2, 1.6):
            width = 2.0 * share * self.reach
            state += 0.25 * (path - play(path, width, 0.0)) / (0.5 * width)
        load = 0.4 + 0.6 * path / self.scale.deep if self.growing else 1.0
        return 0.2 * self.amplitude * self.scale.force * load * touching(depth, 0.05 * self.scale.shallow) * state
