"""A blind session before its noise: body, conditions, noise levels and the places of its signals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from benchmark.blind.body.true_body import TrueBody
from benchmark.blind.hidden import Hidden, SessionScale
from benchmark.blind.labs import LabConditions
from benchmark.blind.motion import Array, Flags, PressPlan, ReportedMotion, motion, phases
from benchmark.blind.simulate import FaceMarkers, Signals, simulate


@dataclass(frozen=True)
class Noise:
    """Of one channel: standard deviation (N or m) and correlation from sample to sample."""

    std: float
    memory: float


@dataclass(frozen=True)
class Scene:
    """What a session measures and how well.

    Attributes
    ----------
    body : TrueBody
    plans : tuple of PressPlan
        One a condition.
    repeats : int
        Trials of each condition.
    grid : FaceMarkers or None
    rate, frame_rate : float
        Hz.
    force_noise, marker_noise : Noise
    lab : LabConditions
        What of the rest is not as told.
    """

    body: TrueBody
    plans: tuple[PressPlan, ...]
    repeats: int
    grid: FaceMarkers | None
    rate: float
    frame_rate: float
    force_noise: Noise
    marker_noise: Noise
    lab: LabConditions = field(default_factory=LabConditions)

    @property
    def scale(self) -> SessionScale:
        """Sizes by which effects choose theirs."""
        depths = [plan.depth for plan in self.plans]
        deep = max(depths)
        force = float(self.body.force(np.array([deep]))[0])
        speed = max(plan.speed for plan in self.plans)
        return SessionScale(min(depths), deep, force, speed, self.body.specimen.tool_radius)

    def motion(self, plan: PressPlan, delay: float = 0.0) -> ReportedMotion:
        """The nominal motion of a condition."""
        return motion(plan, self.rate, self.frame_rate, delay=delay)

    def mean(self, plan: PressPlan, effects: Sequence[Hidden], delay: float = 0.0, deeper: float = 0.0) -> Signals:
        """A condition's mean trial.

        With `delay` the specimen follows its reported depth that much later, s; with `deeper` it is touched that much
        before the reported zero, m.
        """
        moved = self.motion(plan, delay)
        moved = replace(moved, depth=moved.depth + deeper) if deeper else moved
        return simulate(self.body, self.grid, moved, effects)

    def with_body(self, body: TrueBody) -> Scene:
        """The same session with another body."""
        return replace(self, body=body)


@dataclass(frozen=True, eq=False)
class Whitened:
    """A condition's signal in units of its noise: force (n,), x and y (f, markers) or None."""

    force: Array
    x: Array | None
    y: Array | None

    def stacked(self) -> Array:
        """All in one vector."""
        parts = [self.force, *(part.ravel() for part in (self.x, self.y) if part is not None)]
        return np.concatenate(parts)


def whiten(scene: Scene, signals: Signals) -> Whitened:
    """Divide the correlation and the size of the noise out of a signal."""
    x = None if signals.x is None else _white(signals.x, scene.marker_noise)
    y = None if signals.y is None else _white(signals.y, scene.marker_noise)
    return Whitened(_white(signals.force, scene.force_noise), x, y)


def _white(signal: Array, noise: Noise) -> Array:
    """First-order autoregressive whitening along the first axis."""
    rest = np.sqrt(1.0 - noise.memory**2)
    out: Array = (signal - noise.memory * np.concatenate([signal[:1], signal[:-1]])) / rest
    out[0] = signal[0]
    out /= noise.std
    return out


def frame_phases(moved: ReportedMotion) -> dict[str, Flags]:
    """The phases of a motion at its frames."""
    of_samples = phases(moved.time, moved.depth)
    nearest = np.clip(np.searchsorted(moved.time, moved.frames), 0, moved.time.size - 1)
    return {name: rows[nearest] for name, rows in of_samples.items()}
