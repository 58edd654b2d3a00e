"""What the actuator reports in one trial of a blind session, the phases of that motion, and the array types."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.intp]
Flags = NDArray[np.bool_]


SMOOTHING = 0.08
PHASES = ("approach", "load", "hold", "unload_high", "unload_low", "after_lift_off")


@dataclass(frozen=True)
class PressPlan:
    """A press, a hold, a lift just off the surface, a second press, a rest in air.

    Attributes
    ----------
    name : str
        The condition.
    depth : float
        Of both presses, m.
    speed : float
        m/s.
    hold, rest : float
        At the first peak, and in air at the end, s.
    air : float
        How far above the surface the trial begins and ends, m.
    second : float
        Depth of the second press, of the first.
    unloading : bool
        Whether the trial goes on after the hold.
    """

    name: str
    depth: float
    speed: float
    hold: float = 5.0
    rest: float = 5.0
    air: float = 1e-3
    second: float = 1.0
    unloading: bool = True


@dataclass(frozen=True, eq=False)
class ReportedMotion:
    """Reported motion: s and m (n,), equally spaced in time; frames (f,) s."""

    time: Array
    depth: Array
    frames: Array

    @property
    def step(self) -> float:
        """Time between samples, s."""
        return float(self.time[1] - self.time[0])

    @property
    def speed(self) -> Array:
        """Of the tool, (n,) m/s."""
        return np.gradient(self.depth, self.time)


def motion(
    plan: PressPlan, rate: float, frame_rate: float, *, depth_factor: float = 1.0, delay: float = 0.0
) -> ReportedMotion:
    """The motion of one trial, rounded at its corners as an actuator rounds them.

    Parameters
    ----------
    plan : PressPlan
    rate, frame_rate : float
        Of force and camera, Hz.
    depth_factor : float
        How deep this trial goes against its plan.
    delay : float
        By how much the reported motion is late, s.
    """
    return rounded(*_corners(plan, depth_factor), rate, frame_rate, delay=delay)


def rounded(times: Array, depths: Array, rate: float, frame_rate: float, *, delay: float = 0.0) -> ReportedMotion:
    """The motion between depths (k,) m at times (k,) s, rounded at its corners; the rest as `motion`."""
    time = np.arange(0.0, times[-1], 1.0 / rate)
    width = np.linspace(-0.5, 0.5, 17)
    weight = np.cos(np.pi * width) ** 2
    moved = np.interp(time[:, None] - delay + SMOOTHING * width, times, depths)
    depth = moved @ (weight / weight.sum())
    return ReportedMotion(time, depth, np.arange(0.5 / frame_rate, time[-1], 1.0 / frame_rate))


def _corners(plan: PressPlan, depth_factor: float) -> tuple[Array, Array]:
    """Times and depths between which the tool moves evenly."""
    peak = depth_factor * plan.depth
    lift = -0.2 * plan.air
    stops = [(-plan.air, 1.0), (peak, plan.hold)]
    if plan.unloading:
        stops += [(lift, 0.1), (plan.second * peak, 0.1), (-plan.air, plan.rest)]
    times, depths = [0.0], [-plan.air]
    for depth, pause in stops:
        arrival = times[-1] + abs(depth - depths[-1]) / plan.speed
        times += [arrival, arrival + pause]
        depths += [depth, depth]
    return np.array(times), np.array(depths)


def phases(time: Array, depth: Array) -> dict[str, Flags]:
    """Which samples (n,) belong to which phase of a reported motion."""
    pressed = depth > 0.0
    first, last = np.flatnonzero(pressed)[[0, -1]]
    index = np.arange(depth.size)
    speed = np.gradient(depth, time)
    still = np.abs(speed) < 0.02 * np.abs(speed).max()
    peak = depth.max()
    down, up = pressed & (speed > 0) & ~still, pressed & (speed < 0) & ~still
    return {
        "approach": index < first,
        "load": down,
        "hold": pressed & still & (depth > 0.5 * peak),
        "unload_high": up & (depth >= 0.5 * peak),
        "unload_low": up & (depth < 0.5 * peak),
        "after_lift_off": (index > last) | (~pressed & (index > first)),
    }
