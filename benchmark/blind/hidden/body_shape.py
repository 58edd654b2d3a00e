"""Hidden effects of the body that follow its present depth: stiffening, a floor, pretension, adhesion, lower face.

The lower face of a pretensioned sheet moves more near the tool and less farther out: finite elements of the three
sheets under a tension of 1 kPa show a change of 0.45 - r / 28 mm (within 0.03 from 3 to 16 mm) times the tension's
share of the force.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, play, smooth_excess
from benchmark.blind.motion import Array

AT_AXIS, FALL = 0.45, 28e-3


@dataclass(frozen=True, kw_only=True)
class HiddenStrainStiffening(Hidden):
    """Extra force e^(k s) - 1 - k s over the share s of the deepest press."""

    slug = "strain_stiffening"
    stiffens = True
    steepness: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Steepness 2.5 to 5."""
        return cls(scale=scale, steepness=float(rng.uniform(2.5, 5.0)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force."""
        k, share = self.steepness, np.clip(depth, 0.0, None) / self.scale.deep
        more: Array = (np.expm1(k * share) - k * share) / (np.expm1(k) - k)
        return 0.5 * self.amplitude * self.scale.force * more


@dataclass(frozen=True, kw_only=True)
class HiddenBottomingOut(Hidden):
    """`floor` as a share of the shallow press; beyond it force grows with the power 1.5."""

    slug = "bottoming_out"
    floor: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Floors at 0.6 to 0.8."""
        return cls(scale=scale, floor=float(rng.uniform(0.6, 0.8)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force beyond the floor."""
        beyond = np.clip(depth - self.floor * self.scale.shallow, 0.0, None) / self.scale.deep
        return 3.0 * self.amplitude * self.scale.force * beyond**1.5


class HiddenPretension(Hidden):
    """Force of a tense membrane over the slope at the tool's edge, and what it changes in the lower face's field."""

    slug = "pretension"

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force."""
        slope = np.clip(depth, 0.0, None) / (2.0 * self.scale.tool_radius)
        steepest = self.scale.deep / (2.0 * self.scale.tool_radius)
        tense: Array = np.sin(np.arctan(slope)) / np.sin(np.arctan(steepest))
        return 0.5 * self.amplitude * self.scale.force * tense

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """More motion near the tool, less farther out (m), by the membrane's share of the force."""
        share = 0.5 * self.amplitude / (1.0 + 0.5 * self.amplitude)
        factor = np.outer(np.ones(depth.size), 1.0 + share * (AT_AXIS - np.hypot(x, y) / FALL))
        return factor, factor


@dataclass(frozen=True, kw_only=True)
class HiddenAdhesion(Hidden):
    """The bond pulls up to `reach` m above the surface and is gone beyond, until the next touch."""

    slug = "adhesion"
    reach: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Reaches of 0.3 to 0.8 mm."""
        return cls(scale=scale, reach=float(rng.uniform(0.3e-3, 0.8e-3)))

    def pull(self, time: Array, depth: Array) -> Array:
        """Negative force while the bond holds."""
        share = np.clip(-depth, 0.0, None) / self.reach
        size = -np.expm1(-share / 0.15) * np.cos(0.5 * np.pi * np.clip(share, 0.0, 1.0)) ** 0.5
        return -0.3 * self.amplitude * self.scale.force * np.where(self._held(depth), size, 0.0)

    def _held(self, depth: Array) -> Array:
        """Whether (n,) the bond holds: from a touch until it is torn."""
        out, holds = np.zeros(depth.size), False
        for row, value in enumerate(depth.tolist()):
            holds = value > 0.0 or (holds and value > -self.reach)
            out[row] = holds
        return out.astype(bool)


@dataclass(frozen=True, kw_only=True)
class HiddenAnisotropy(Hidden):
    """`sign` +1: x moves more."""

    slug = "anisotropy"
    only_markers = True
    largest = 3.0
    sign: int

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either axis."""
        return cls(scale=scale, sign=int(rng.choice([-1, 1])))

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """More along one, less along the other."""
        share = (np.clip(depth, 0.0, None) / self.scale.deep) ** 0.3
        more = 0.3 * self.sign * self.amplitude * np.outer(share, np.ones(x.size))
        return 1.0 + more, 1.0 - 0.8 * more


@dataclass(frozen=True, kw_only=True)
class HiddenInterfaceSlip(Hidden):
    """`threshold` of the shallow press; `sticky`: it slides back only past as much on the other side."""

    slug = "interface_slip"
    only_markers = True
    largest = 1.5
    threshold: float
    sticky: bool
    felt: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Sticky or not, felt in the force or not."""
        return cls(
            scale=scale,
            threshold=float(rng.uniform(0.3, 0.6)),
            sticky=bool(rng.random() < 0.5),
            felt=float(rng.choice([0.0, 0.1])),
        )

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """The lower face follows only part of what is over the threshold."""
        return strained - 0.6 * self.amplitude * self._slid(strained)

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Sliding layers are a little softer."""
        slid = np.clip(self._slid(depth), 0.0, None) / self.scale.deep
        return -self.felt * self.amplitude * slid * elastic

    def _slid(self, depth: Array) -> Array:
        """(n,) m of depth that is over the threshold."""
        pressed, limit = np.clip(depth, 0.0, None), self.threshold * self.scale.shallow
        if self.sticky:
            return play(pressed, 2.0 * limit, 0.0)
        return np.where(depth > 0.0, smooth_excess(pressed, limit, 0.1 * limit), 0.0)
