"""Hidden effects of the body that follow the history of the press: memory, drag, drainage, softening, set, friction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, lost_memory, touching
from benchmark.blind.motion import Array


@dataclass(frozen=True, kw_only=True)
class HiddenViscoelasticRelaxation(Hidden):
    """Shares and times (s) of the modes; a stretched exponential is a broad spectrum of many."""

    slug = "viscoelastic_relaxation"
    shares: tuple[float, ...]
    times: tuple[float, ...]

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Three terms a decade apart, or a spectrum of 13."""
        if rng.random() < 0.5:
            times = np.array([0.12, 1.1, 9.0]) * np.exp(rng.uniform(-0.5, 0.5, 3))
            shares = rng.dirichlet([4.0, 4.0, 4.0])
        else:
            shift = np.linspace(-3.0, 3.0, 13)
            times = rng.uniform(0.5, 2.0) * np.exp(shift)
            shares = np.exp(-0.5 * (shift / rng.uniform(1.0, 1.6)) ** 2)
            shares /= shares.sum()
        return cls(scale=scale, shares=tuple(shares.tolist()), times=tuple(times.tolist()))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What has been forgotten is missing."""
        lost: Array = lost_memory(time, elastic, 1.0 / np.array(self.times)) @ np.array(self.shares)
        return -0.5 * self.amplitude * lost


@dataclass(frozen=True, kw_only=True)
class HiddenViscousDamping(Hidden):
    """|v|^p against the motion, while the tool touches."""

    slug = "viscous_damping"
    power: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Powers 0.75 to 0.9."""
        return cls(scale=scale, power=float(rng.uniform(0.75, 0.9)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Against the motion."""
        speed = np.gradient(depth, time) / self.scale.speed
        drag = np.sign(speed) * np.abs(speed) ** self.power
        return 0.3 * self.amplitude * self.scale.force * touching(depth, 0.15 * self.scale.shallow) * drag


MODES = np.arange(1.0, 9.0)


@dataclass(frozen=True, kw_only=True)
class HiddenPoroelasticDrainage(Hidden):
    """`time` s of the slowest mode at full contact; mode n is n^2 faster and n^2 smaller."""

    slug = "poroelastic_drainage"
    time: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Two to ten seconds."""
        return cls(scale=scale, time=float(np.exp(rng.uniform(np.log(2.0), np.log(10.0)))))

    def under_tool(self, radius: float) -> Self:
        """Fluid has farther to go: the time grows with the radius squared."""
        longer = (radius / self.scale.tool_radius) ** 2
        return replace(super().under_tool(radius), time=longer * self.time)

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What has drained is missing."""
        contact = 0.1 + 0.9 * np.clip(depth, 0.0, None) / self.scale.deep  # radius squared, of the largest
        rates = MODES**2 / (self.time * contact[:, None])
        shares = MODES**-2 / (MODES**-2).sum()
        drained: Array = lost_memory(time, elastic, rates) @ shares
        return -0.5 * self.amplitude * drained


@dataclass(frozen=True, kw_only=True)
class HiddenStressSoftening(Hidden):
    """Loss of force with the distance to the deepest depth so far."""

    slug = "stress_softening"
    largest = 2.0
    logarithmic: bool

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either form."""
        return cls(scale=scale, logarithmic=bool(rng.random() < 0.5))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What is missing."""
        deepest = np.maximum.accumulate(np.clip(depth, 1e-9, None))
        below = np.clip(1.0 - np.clip(depth, 0.0, None) / deepest, 0.0, 1.0)
        loss = np.log1p(5.0 * below) / np.log(6.0) if self.logarithmic else np.sqrt(below)
        return -0.4 * self.amplitude * loss * elastic


@dataclass(frozen=True, kw_only=True)
class HiddenPermanentSet(Hidden):
    """`delay` s until the set is there; `shown` of it stays in the lower face."""

    slug = "permanent_set"
    largest = 3.0
    delay: float
    shown: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Quick or slow, seen by the camera or not."""
        return cls(scale=scale, delay=float(rng.uniform(0.1, 0.6)), shown=float(rng.choice([0.0, 0.5, 1.0])))

    def indent(self, time: Array, depth: Array) -> Array:
        """Depth less the set so far."""
        return depth - self._set(time, depth)

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """The lower face keeps its share of the set, pressed or not."""
        return np.clip(strained, 0.0, None) + self.shown * self._set(time, depth)

    def _set(self, time: Array, depth: Array) -> Array:
        """(n,) m: it follows the largest set that the depth asks for, never back."""
        wanted = 0.25 * self.amplitude * self.scale.deep * -np.expm1(-np.clip(depth, 0.0, None) / self.scale.deep)
        share = -np.expm1(-(time[1] - time[0]) / self.delay)
        out, now = np.zeros(depth.size), 0.0
        for row, target in enumerate(wanted.tolist()):
            now += share * max(target - now, 0.0)
            out[row] = now
        return out


@dataclass(frozen=True, kw_only=True)
class HiddenDryFriction(Hidden):
    """w' = v / `reach` (1 - |w|^n (0.7 sign(v w) + 0.3)), rested whenever the tool is in air."""

    slug = "dry_friction"
    reach: float
    power: float
    growing: bool

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """A friction force that grows with the load, or not."""
        return cls(
            scale=scale,
            reach=float(rng.uniform(0.03, 0.12)) * scale.shallow,
            power=float(rng.uniform(1.0, 2.0)),
            growing=bool(rng.random() < 0.5),
        )

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Friction against the motion."""
        load = 0.3 + 0.7 * elastic / self.scale.force if self.growing else touching(depth, 0.1 * self.scale.shallow)
        return 0.2 * self.amplitude * self.scale.force * load * self._state(depth)

    def _state(self, depth: Array) -> Array:
        out, now = np.zeros(depth.size), 0.0
        pressed, moves = (depth > 0.0).tolist(), (np.diff(depth) / self.reach).tolist()
        for row, move in enumerate(moves):
            part = min(max(move, -0.5), 0.5)
            now += part * (1.0 - abs(now) ** self.power * (0.7 * np.sign(part * now) + 0.3))
            now = now if pressed[row + 1] else 0.0
            out[row + 1] = now
        return out
