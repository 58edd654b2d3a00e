"""A body's nodes against a rigid surface that is held or shifted, without friction: forces by a penalty.

The pressure at a node is max(0, L + e g) with its penetration g, the penalty e and the multiplier L, which is zero
(penalty) or augmented to the pressure until that settles. Its force is the pressure on the share of the undeformed
surface that nodal quadrature gives it, along the rigid surface's normal (FEBio theory manual, section 7.1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.verification.constrained_body import ContactForces


class RigidSurface(Protocol):
    """A rigid surface on its way to where it is under the full load."""

    def gap(self, places: FloatArray, share: float) -> tuple[FloatArray, FloatArray, float]:
        """Penetrations (n,) of places (n, 3), -inf where it is not met; normals (n, 3); the slope -dg/d(n x)."""


@dataclass(frozen=True)
class RigidPlane:
    """FEBio's wall a x + b y + c z = d, pushed along its normal by an offset.

    FEBio takes the distance as (a x + b y + c z - d) |(a, b, c)|: in units of length only for a unit vector.
    """

    equation: FloatArray
    offset: float

    def gap(self, places: FloatArray, share: float) -> tuple[FloatArray, FloatArray, float]:
        """See :class:`RigidSurface`."""
        long = float(np.linalg.norm(self.equation[:3]))
        found: FloatArray = share * self.offset - long * (places @ self.equation[:3] - self.equation[3])
        return found, np.tile(self.equation[:3] / long, (len(places), 1)), long**2


@dataclass(frozen=True)
class RigidFacets:
    """Flat facets with corners counter-clockwise seen from outside, moved together.

    A node meets a facet if its foot is within it, enlarged by a part `margin`; of several the nearest one.
    """

    facets: tuple[FloatArray, ...]
    motion: FloatArray
    margin: float

    def gap(self, places: FloatArray, share: float) -> tuple[FloatArray, FloatArray, float]:
        """See :class:`RigidSurface`."""
        gap, normal = np.full(len(places), -np.inf), np.zeros((len(places), 3))
        for corners in self.facets:
            n, at = facet_normal(corners), places - share * self.motion
            depth = (corners[0] - at) @ n
            nearer = self._within(corners, n, at) & ~(np.abs(depth) >= np.abs(gap))
            gap[nearer], normal[nearer] = depth[nearer], n
        return gap, normal, 1.0

    def _within(self, corners: FloatArray, normal: FloatArray, places: FloatArray) -> BoolArray:
        middle = corners.mean(axis=0)
        larger = middle + (1.0 + self.margin * (3.0 if len(corners) == 3 else 1.0)) * (corners - middle)
        inward = np.cross(normal, np.roll(larger, -1, axis=0) - larger)
        out: BoolArray = (np.einsum("nkx,kx->nk", places[:, None] - larger, inward) >= 0.0).all(axis=1)
        return out


def facet_normal(corners: FloatArray) -> FloatArray:
    """Unit normal (3,) of a flat facet (k, 3)."""
    across = np.cross(corners[1] - corners[0], corners[-1] - corners[0])
    out: FloatArray = across / np.linalg.norm(across)
    return out


@dataclass(frozen=True)
class Augmentation:
    """When multipliers stay: their norm changes by no more than a part, after a least and at most some times."""

    tolerance: float
    least: int = 0
    most: int | None = None


@dataclass(frozen=True)
class RigidContact:
    """Nodes that may touch a rigid surface.

    Attributes
    ----------
    nodes
        Their numbers (n,) in the body.
    places
        Where they are at rest (n, 3).
    area
        What of the undeformed surface each stands for (n,).
    penalty
        Of each (n,), pressure by penetration.
    surface
        The rigid one.
    augmentation
        How the multipliers are augmented; None leaves them zero.
    """

    nodes: IntArray
    places: FloatArray
    area: FloatArray
    penalty: FloatArray
    surface: RigidSurface
    augmentation: Augmentation | None = None

    @property
    def count(self) -> int:
        """Nodes that can touch."""
        return len(self.nodes)

    @property
    def exact(self) -> RigidContact:
        """The same without penetration, to six digits of the pressures."""
        return replace(self, augmentation=Augmentation(1e-6))

    def touch(self, u: FloatArray, share: float, multiplier: FloatArray) -> ContactForces:
        """See :class:`fem.verification.constrained_body.Contact`."""
        gap, normal, slope = self.surface.gap(self.places + u[:, self.nodes].T, share)
        met = np.isfinite(gap)
        pressure = np.where(met, np.maximum(0.0, multiplier + self.penalty * np.where(met, gap, 0.0)), 0.0)
        rows = self.nodes[:, None] + u.shape[1] * np.arange(3)
        force = np.zeros(u.size)
        force[rows] = (self.area * pressure)[:, None] * normal
        blocks = ((pressure > 0.0) * self.area * self.penalty * slope)[:, None, None] * (
            normal[:, :, None] * normal[:, None, :]
        )
        row, column = np.broadcast_arrays(rows[:, :, None], rows[:, None, :])
        stiffness = sp.csr_array((blocks.ravel(), (row.ravel(), column.ravel())), shape=(u.size, u.size))
        return ContactForces(force, stiffness, pressure)

    def settled(self, multiplier: FloatArray, pressure: FloatArray, times: int) -> bool:
        """See :class:`fem.verification.constrained_body.Contact`."""
        rule = self.augmentation
        if rule is None or (rule.most is not None and times >= rule.most):
            return True
        before, now = float(np.linalg.norm(multiplier)), float(np.linalg.norm(pressure))
        return times >= rule.least and abs(now - before) <= rule.tolerance * (now or 1.0)


def nodal_area(corners: FloatArray) -> FloatArray:
    """What of a facet (k, 3) each corner stands for (k,): the area element at a quadrilateral's corner, or a third."""
    ahead, behind = np.roll(corners, -1, axis=0) - corners, np.roll(corners, 1, axis=0) - corners
    out: FloatArray = np.linalg.norm(np.cross(ahead, behind), axis=1) / (4.0 if len(corners) == 4 else 6.0)
    return out
