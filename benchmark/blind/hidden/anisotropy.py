"""A lower face that moves more along one axis than along the other, and unevenly so with depth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class Anisotropy(Hidden):
    """`sign` +1: x moves more."""

    slug = "anisotropy"
    only_markers = True
    largest = 3.0
    sign: int

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Either axis."""
        return cls(scale=scale, sign=int(rng.choice([-1, 1])))

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """More along one, less along the other."""
        share = (np.clip(depth, 0.0, None) / self.scale.deep) ** 0.3
        more = 0.3 * self.sign * self.amplitude * np.outer(share, np.ones(x.size))
        return 1.0 + more, 1.0 - 0.8 * more
