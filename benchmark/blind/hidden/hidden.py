"""What a hidden effect can do to a trial: hooks along the way from the motor to the recorded sample.

A hook that an effect does not override leaves what it gets as it is. With amplitude zero every effect is nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from benchmark.blind.arrays import Array

AMPLITUDE_SCATTER = 0.05


@dataclass(frozen=True)
class Scale:
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
    scale : Scale
    amplitude : float
        0 is nothing, 1 is so large that nobody could miss it.
    """

    slug: ClassVar[str]
    only_markers: ClassVar[bool] = False
    gives_way: ClassVar[bool] = False
    largest: ClassVar[float] = 30.0

    scale: Scale
    amplitude: float = 0.1

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """An effect of a random shape."""
        return cls(scale=scale)

    def of_size(self, amplitude: float) -> Self:
        """The same effect with another amplitude."""
        return replace(self, amplitude=amplitude)

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
