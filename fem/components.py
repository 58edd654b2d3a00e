"""Which components of the deformation gradient a geometry has, and how they are packed.

A geometry stores F, P and the like as (components, *points) and the symmetric fourth-order tensors dP/dF as
their upper triangle (pairs, *points). Laws are written in these components and serve every geometry.
"""

from __future__ import annotations

import itertools
from functools import cached_property

import numpy as np

from fem.arrays import FloatArray, IntArray


class Components:
    """A list of tensor components (i, j) in the axes (r, theta, z), with their packing.

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


AXISYMMETRIC = AxisymmetricComponents()
