"""Second forms of effects that follow the present depth: locking, a floor, a taut membrane, a bond that snaps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, play, smooth_excess
from benchmark.blind.motion import Array

TURN = 8e-3


@dataclass(frozen=True, kw_only=True)
class LockingStiffening(Hidden):
    """Extra force s^3 / (1 - s / `limit`) over the share s of the deepest press: fibres that become straight."""

    slug = "strain_stiffening"
    stiffens = True
    limit: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Locking at 1.2 to 1.8 of the deepest press."""
        return cls(scale=scale, limit=float(rng.uniform(1.2, 1.8)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force."""
        share = np.clip(depth, 0.0, None) / self.scale.deep
        at_most = 1.0 / (1.0 - 1.0 / self.limit)
        more: Array = share**3 / np.clip(1.0 - share / self.limit, 0.05, None) / at_most
        return 0.5 * self.amplitude * self.scale.force * more


@dataclass(frozen=True, kw_only=True)
class LinearFloor(Hidden):
    """`floor` as a share of the shallow press; beyond it a linear spring, met over a tenth of a millimetre."""

    slug = "bottoming_out"
    floor: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Floors at 0.5 to 0.85."""
        return cls(scale=scale, floor=float(rng.uniform(0.5, 0.85)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force beyond the floor."""
        beyond = smooth_excess(depth, self.floor * self.scale.shallow, 0.03e-3)
        return 2.0 * self.amplitude * self.scale.force * beyond / self.scale.deep


class TautMembrane(Hidden):
    """A tension that stays what it is: force linear in depth, and a field that turns over like a cosine."""

    slug = "pretension"

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force."""
        return 0.5 * self.amplitude * self.scale.force * np.clip(depth, 0.0, None) / self.scale.deep

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """More motion near the tool, less farther out, by the tension's share of the force."""
        share = 0.5 * self.amplitude / (1.0 + 0.5 * self.amplitude)
        factor = np.outer(np.ones(depth.size), 1.0 + 0.45 * share * np.cos(np.hypot(x, y) / TURN))
        return factor, factor


@dataclass(frozen=True, kw_only=True)
class SnappingBond(Hidden):
    """The bond pulls in proportion to the distance, up to `reach` m, and lets go at once."""

    slug = "adhesion"
    reach: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Reaches of 0.25 to 0.7 mm."""
        return cls(scale=scale, reach=float(rng.uniform(0.25e-3, 0.7e-3)))

    def pull(self, time: Array, depth: Array) -> Array:
        """Negative force while the bond holds."""
        out, holds = np.zeros(depth.size), False
        for row, value in enumerate(depth.tolist()):
            holds = value > 0.0 or (holds and value > -self.reach)
            out[row] = max(-value, 0.0) / self.reach if holds else 0.0
        return -0.3 * self.amplitude * self.scale.force * out


@dataclass(frozen=True, kw_only=True)
class OneWayFibres(Hidden):
    """Fibres along one axis (`along_x` or y) let it move less, all the same at any depth."""

    slug = "anisotropy"
    only_markers = True
    largest = 3.0
    along_x: bool

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either axis."""
        return cls(scale=scale, along_x=bool(rng.random() < 0.5))

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """Less along the fibres, a trifle more across them."""
        one = np.ones((depth.size, x.size))
        less, more = one * (1.0 - 0.3 * self.amplitude), one * (1.0 + 0.06 * self.amplitude)
        return (less, more) if self.along_x else (more, less)


@dataclass(frozen=True, kw_only=True)
class PatchySlip(Hidden):
    """Three patches of the interface that slide after other distances; `threshold` of the shallow press on average."""

    slug = "interface_slip"
    only_markers = True
    largest = 1.5
    threshold: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Thresholds of 0.25 to 0.5."""
        return cls(scale=scale, threshold=float(rng.uniform(0.25, 0.5)))

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """The lower face follows only part of what the patches have slid."""
        pressed, slid = np.clip(strained, 0.0, None), np.zeros_like(strained)
        for share in (0.6, 1.0, 1.4):
            slid += play(pressed, 2.0 * share * self.threshold * self.scale.shallow, 0.0) / 3.0
        return strained - 0.6 * self.amplitude * slid
