"""Which components of the deformation gradient a geometry has, and how they are packed.

A geometry stores F, P and the like as (components, *points) and the symmetric fourth-order tensors dP/dF as
their upper triangle (pairs, *points). Laws are written in these components and serve every geometry.
"""

from __future__ import annotations

import itertools
from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np

from fem.arrays import FloatArray, IntArray


class Components(ABC):
    """A list of tensor components (i, j) in the axes (r, theta, z) or (x, y, z), with their packing.

    Parameters
    ----------
    positions
        Component k stands at row and column `positions[k]` of the 3 x 3 tensor.
    blocks
        Consecutive components that belong to one displacement component each, as block lengths.
        The upper triangle is packed block by block, so that each block of a stiffness is contiguous.
    """

    def __init__(self, positions: tuple[tuple[int, int], ...], blocks: tuple[int, ...]) -> None:
        self.positions = positions
        self.blocks = blocks

    @cached_property
    def block_slices(self) -> tuple[slice, ...]:
        """The components of each displacement component."""
        ends = np.cumsum((0, *self.blocks))
        return tuple(slice(int(a), int(b)) for a, b in itertools.pairwise(ends))

    @cached_property
    def pairs(self) -> tuple[IntArray, IntArray]:
        """First and second component of each packed pair, (pairs,) each."""
        found: list[tuple[int, int]] = []
        for a, first in enumerate(self.block_slices):
            for second in self.block_slices[a:]:
                found += [
                    (k, m) for k in range(first.start, first.stop) for m in range(second.start, second.stop) if k <= m
                ]
        array = np.array(found, dtype=np.int64)
        return array[:, 0].copy(), array[:, 1].copy()

    @cached_property
    def diagonal(self) -> IntArray:
        """Packed positions of the pairs (k, k), in the order of k."""
        k, m = self.pairs
        found = np.flatnonzero(k == m)
        return found[np.argsort(k[found])]

    @cached_property
    def normal(self) -> IntArray:
        """Components on the tensor's diagonal."""
        return np.array([n for n, (i, j) in enumerate(self.positions) if i == j], dtype=np.int64)

    @cached_property
    def transposed(self) -> IntArray:
        """Component at the transposed position of each component."""
        return np.array([self.positions.index((j, i)) for i, j in self.positions], dtype=np.int64)

    @cached_property
    def identity(self) -> FloatArray:
        """The unit tensor (components,)."""
        return np.array([float(i == j) for i, j in self.positions])

    @cached_property
    def deviator(self) -> FloatArray:
        """Projection on symmetric deviatoric tensors, packed (pairs,)."""
        k, m = self.pairs
        same = (k == m).astype(np.float64)
        mirrored = (self.transposed[k] == m).astype(np.float64)
        out: FloatArray = 0.5 * (same + mirrored) - self.identity[k] * self.identity[m] / 3.0
        return out

    def unpack(self, packed: FloatArray) -> FloatArray:
        """Full symmetric array (components, components, *points) of a packed one (pairs, *points)."""
        k, m = self.pairs
        count = len(self.positions)
        full = np.empty((count, count, *packed.shape[1:]))
        full[k, m] = packed
        full[m, k] = packed
        return full

    def tensor(self, values: FloatArray) -> FloatArray:
        """3 x 3 tensors (*points, 3, 3) of component values (components, *points)."""
        full = np.zeros((*values.shape[1:], 3, 3))
        for k, (i, j) in enumerate(self.positions):
            full[..., i, j] = values[k]
        return full

    def add_products(self, packed: FloatArray, A: FloatArray, B: FloatArray) -> None:
        """Add A[k] B[m] (components, *points) to `packed` (pairs, *points), pair by pair, in place."""
        for n, (k, m) in enumerate(zip(*self.pairs, strict=True)):
            packed[n] += A[k] * B[m]

    @cached_property
    def row_pairs(self) -> tuple[IntArray, IntArray]:
        """Packed positions of the pairs (i j, i l) of one row, and the component (j, l) of each."""
        found = [
            (n, self.positions.index((self.positions[k][1], self.positions[m][1])))
            for n, (k, m) in enumerate(zip(*self.pairs, strict=True))
            if self.positions[k][0] == self.positions[m][0]
        ]
        return np.array([n for n, _ in found]), np.array([c for _, c in found])

    def product(self, A: FloatArray, B: FloatArray) -> FloatArray:
        """A B, (components, *points)."""
        at = {position: k for k, position in enumerate(self.positions)}
        out = np.zeros((len(self.positions), *np.broadcast_shapes(A.shape[1:], B.shape[1:])))
        for n, (i, j) in enumerate(self.positions):
            for k in range(3):
                if (i, k) in at and (k, j) in at:
                    out[n] += A[at[i, k]] * B[at[k, j]]
        return out

    def right_product(self, H: FloatArray) -> FloatArray:
        """H^T H, (components, *points)."""
        return self.product(H[self.transposed], H)

    def volume_change(self, H: FloatArray, cofactor_change: FloatArray) -> FloatArray:
        """J - 1, (*points), of H and cof F - I: det F by its second row, without the 1."""
        middle = self.positions.index((1, 1))
        out: FloatArray = H[middle] + cofactor_change[middle]
        for k, (i, _) in enumerate(self.positions):
            if i == 1:
                out += H[k] * cofactor_change[k]
        return out

    @property
    @abstractmethod
    def cofactor_pairs(self) -> IntArray:
        """Packed positions of the pairs that d(cof F)/dF has."""

    @abstractmethod
    def cofactor_change(self, H: FloatArray) -> FloatArray:
        """Cofactor dJ/dF less the unit tensor, (components, *points), of H = F - I."""

    @abstractmethod
    def cofactor_derivative(self, F: FloatArray) -> FloatArray:
        """Second derivative of J at the pairs of `cofactor_pairs`."""

    @abstractmethod
    def principal(self, strain: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Principal values (3, *points) and axes (3, 3, *points), axis by axis in columns, of symmetric tensors."""

    @abstractmethod
    def largest_principal(self, strain: FloatArray) -> FloatArray:
        """Largest principal value by amount, (*points), of symmetric tensors (components, *points)."""


class AxisymmetricComponents(Components):
    """Axial symmetry without torsion: rr, rz and theta-theta of u_r, zr and zz of u_z."""

    def __init__(self) -> None:
        super().__init__(((0, 0), (0, 2), (1, 1), (2, 0), (2, 2)), (3, 2))

    @cached_property
    def cofactor_pairs(self) -> IntArray:
        """Packed positions of the pairs that d(cof F)/dF has."""
        k, m = self.pairs
        listed = list(zip(k.tolist(), m.tolist(), strict=True))
        return np.array([listed.index(pair) for pair in ((0, 2), (0, 4), (1, 2), (1, 3), (2, 3), (2, 4))])

    def cofactor_change(self, H: FloatArray) -> FloatArray:
        """Cofactor dJ/dF less the unit tensor, (components, *points), of H = F - I."""
        rr, rz, tt, zr, zz = H
        out = np.empty_like(H)
        out[0], out[1] = zz + tt + zz * tt, -zr - zr * tt
        out[3], out[4] = -rz - rz * tt, rr + tt + rr * tt
        out[2] = rr + zz + rr * zz - rz * zr
        return out

    def cofactor_derivative(self, F: FloatArray) -> FloatArray:
        """Second derivative of J at the pairs of `cofactor_pairs`, (6, *points)."""
        rr, rz, tt, zr, zz = F
        return np.stack((zz, tt, -zr, -tt, -rz, rr))

    def principal(self, strain: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Principal values (3, *points), the second one hoop, and axes (3, 3, *points) of tensors (5, *points)."""
        rr, rz, tt, _, zz = strain
        half, mean = 0.5 * (rr - zz), 0.5 * (rr + zz)
        size, angle = np.hypot(half, rz), 0.5 * np.arctan2(rz, half)
        c, s, none = np.cos(angle), np.sin(angle), np.zeros_like(angle)
        axes = np.stack((np.stack((c, none, -s)), np.stack((none, none + 1.0, none)), np.stack((s, none, c))))
        return np.stack((mean + size, tt, mean - size)), axes

    def largest_principal(self, strain: FloatArray) -> FloatArray:
        """Largest principal value by amount, (*points), of symmetric tensors (5, *points)."""
        rr, rz, tt, _, zz = strain
        middle, radius = 0.5 * (rr + zz), np.hypot(0.5 * (rr - zz), rz)
        out: FloatArray = np.maximum(np.abs(middle) + radius, np.abs(tt))
        return out


class SolidComponents(Components):
    """All nine components in (x, y, z), row by row: the gradients of u_x, u_y and u_z."""

    def __init__(self) -> None:
        super().__init__(tuple((i, j) for i in range(3) for j in range(3)), (3, 3, 3))

    @cached_property
    def _curvature(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Pairs (i j, k l) with i != k and j != l: their packed place, the remaining component and its sign."""
        place, component, sign = [], [], []
        for n, (a, b) in enumerate(zip(*self.pairs, strict=True)):
            (i, j), (k, m) = self.positions[a], self.positions[b]
            if i != k and j != m:
                place.append(n)
                component.append(3 * (3 - i - k) + 3 - j - m)
                sign.append(1.0 if (k - i) % 3 == (m - j) % 3 else -1.0)
        return np.array(place), np.array(component), np.array(sign)

    @property
    def cofactor_pairs(self) -> IntArray:
        """Packed positions of the 18 pairs that d(cof F)/dF has."""
        return self._curvature[0]

    def cofactor_change(self, H: FloatArray) -> FloatArray:
        """Cofactor dJ/dF less the unit tensor, (9, *points), of H = F - I."""
        out = np.empty_like(H)
        trace = H[0] + H[4] + H[8]
        for n, (i, j) in enumerate(self.positions):
            a, b, c, d = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
            out[n] = H[3 * a + c] * H[3 * b + d] - H[3 * a + d] * H[3 * b + c] - H[3 * j + i]
            if i == j:
                out[n] += trace
        return out

    def cofactor_derivative(self, F: FloatArray) -> FloatArray:
        """Second derivative of J at the pairs of `cofactor_pairs`, (18, *points)."""
        _, component, sign = self._curvature
        out: FloatArray = F[component] * sign.reshape(-1, *(1,) * (F.ndim - 1))
        return out

    def principal(self, strain: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Principal values (3, *points) and axes (3, 3, *points) of symmetric tensors (9, *points)."""
        values, axes = np.linalg.eigh(self.tensor(strain))
        return np.moveaxis(values, -1, 0), np.moveaxis(axes, (-2, -1), (0, 1))

    def largest_principal(self, strain: FloatArray) -> FloatArray:
        """Largest principal value by amount, (*points), of symmetric tensors (9, *points)."""
        out: FloatArray = np.abs(np.linalg.eigvalsh(self.tensor(strain))).max(axis=-1)
        return out


AXISYMMETRIC = AxisymmetricComponents()
SOLID = SolidComponents()
