"""What a hidden effect can do to a trial: hooks along the way from the motor to the recorded sample.

A hook that an effect does not override leaves what it gets as it is. With amplitude zero every effect is nothing. Small
mathematics that several effects share stands at the end.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from benchmark.blind.motion import Array

AMPLITUDE_SCATTER = 0.05


@dataclass(frozen=True)
class SessionScale:
    """Sizes of a session, by which effects choose theirs.

    Attributes
    ----------
    shallow, deep : float
        Peak depth of the shallowest and of the deepest condition, m.
    force : float
        Elastic force at `deep`, N.
    speed : float
        Of the fastest condition, m/s.
    tool_radius : float
        m.
    """

    shallow: float
    deep: float
    force: float
    speed: float
    tool_radius: float


@dataclass(frozen=True, kw_only=True)
class Hidden:
    """A hidden effect: its size, its shape, and what it does.

    Attributes
    ----------
    scale : SessionScale
    amplitude : float
        0 is nothing, 1 is so large that nobody could miss it.
    stiffens : bool
        Whether its push is the tissue's own stiffness, which a stiffer specimen has more of.
    """

    slug: ClassVar[str]
    only_markers: ClassVar[bool] = False
    gives_way: ClassVar[bool] = False
    stiffens: ClassVar[bool] = False
    largest: ClassVar[float] = 30.0

    scale: SessionScale
    amplitude: float = 0.1

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """An effect of a random shape."""
        return cls(scale=scale)

    def of_size(self, amplitude: float) -> Self:
        """The same effect with another amplitude."""
        return replace(self, amplitude=amplitude)

    def under_tool(self, radius: float) -> Self:
        """The same effect of the same specimen under a tool of another radius, m."""
        return replace(self, scale=replace(self.scale, tool_radius=radius))

    def in_trial(self, rng: np.random.Generator) -> Self:
        """How it shows in one trial: its size scatters a little."""
        return self.of_size(self.amplitude * float(np.exp(rng.normal(0.0, AMPLITUDE_SCATTER))))

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth (n,) m that the tool truly makes, from the reported one and the force (n,) N."""
        return depth

    def indent(self, time: Array, depth: Array) -> Array:
        """Depth (n,) m by which the specimen is strained, from the tool's."""
        return depth

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """Depth (n,) m that the lower face follows, from what it would follow without the effect."""
        return strained

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Force (n,) N added while the tool touches."""
        return np.zeros_like(elastic)

    def pull(self, time: Array, depth: Array) -> Array:
        """Force (n,) N added also where the tool has lifted off."""
        return np.zeros_like(depth)

    def centre(self) -> tuple[float, float]:
        """Where the tool's axis is, m from the middle of the markers."""
        return 0.0, 0.0

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """Factors (f, markers) on the lower face's motion along x and y, from the depth (f,) m that it follows."""
        one = np.ones((depth.size, x.size))
        return one, one

    def instants(self, frames: Array) -> Array:
        """When frames (f,) s were truly taken."""
        return frames

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Where the camera sees markers that are at x, y and have sunk by `sinking`, all (f, markers) m."""
        return x, y

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force (n,) N that the sensor reports."""
        return force


def touching(depth: Array, width: float) -> Array:
    """How much the tool touches: 0 in air, rising to 1 over a depth of about `width`."""
    return 1.0 - np.exp(-np.clip(depth, 0.0, None) / width)


def lost_memory(time: Array, force: Array, rates: Array) -> Array:
    """What each mode has forgotten of a force history.

    Parameters
    ----------
    time, force : (n,)
        s and N.
    rates : (n, m) or (m,) 1/s
        Of forgetting, which may change with time.

    Returns
    -------
    (n, m) N
        Force minus what each mode still remembers of it.
    """
    rates = np.broadcast_to(rates, (time.size, np.shape(rates)[-1]))
    kept = np.zeros(rates.shape)
    state = np.zeros(rates.shape[1])
    decay = np.exp(-np.diff(time)[:, None] * rates[1:])
    inflow = np.sqrt(decay) * np.diff(force)[:, None]
    for row in range(time.size - 1):
        state = decay[row] * state + inflow[row]
        kept[row + 1] = state
    out: Array = force[:, None] - kept
    return out


def play(path: Array, width: float, start: float) -> Array:
    """Output (n,) of a play of `width` that follows `path`, beginning at `start` within half a width of it."""
    out = np.empty(path.size)
    now, half = start, 0.5 * width
    for row, value in enumerate(path.tolist()):
        now = min(max(now, value - half), value + half)
        out[row] = now
    return out


def smooth_excess(value: Array, threshold: float, width: float) -> Array:
    """By how much a value is over a threshold, rounded over `width`."""
    return width * np.logaddexp(0.0, (value - threshold) / width)
