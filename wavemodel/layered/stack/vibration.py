"""Free vibration of the stack at each wavenumber: K(k) phi = w^2 M phi.

The problem is solved for 1 / w^2 with shapes of unit strain energy, so that the slow modes, and with them the static
answer, come out to full precision although the rates of a stack span eight decades.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness


@dataclass(frozen=True)
class Vibration:
    """d modes at each of n wavenumbers.

    Attributes
    ----------
    frequency
        (n, d) angular, rad/s, falling.
    surface
        (n, d, 2) U and W of the surface in each shape (of unit strain energy: phi' K phi = 1).
    deflection
        (n, L, d) W of each layer's top face in each shape.
    outward
        (n, L + 1, d) U of each layer's top face and of the lowest one.
    """

    frequency: FloatArray
    surface: FloatArray
    deflection: FloatArray
    outward: FloatArray


def assemble(blocks: FloatArray, base: str) -> FloatArray:
    """Stack sub-layer matrices (..., S, 6, 6) to (..., d, d): per sub-layer top U, W and middle U, W."""
    count = blocks.shape[-3]
    size = 4 * count + 2
    out = np.zeros((*blocks.shape[:-3], size, size))
    for s in range(count):
        unknowns = np.array([0, 1, 4, 5, 2, 3]) + 4 * s
        out[..., unknowns[:, None], unknowns] += blocks[..., s, :, :]
    kept = size if base == "free" else size - 2
    return out[..., :kept, :kept]


def vibration(wavenumber: FloatArray, laminate: Laminate) -> Vibration:
    """Modes of the stack at wavenumbers (n,), rad/m."""
    stiffness = assemble(quadratic_stiffness(wavenumber, laminate), laminate.base)
    mass = assemble(consistent_mass(laminate), laminate.base)
    root = np.linalg.cholesky(stiffness)
    half = np.linalg.solve(root, np.broadcast_to(mass, stiffness.shape))
    scaled = np.linalg.solve(root, np.swapaxes(half, -1, -2))
    square, vectors = np.linalg.eigh(0.5 * (scaled + np.swapaxes(scaled, -1, -2)))
    floor = np.finfo(np.float64).tiny
    shapes = np.linalg.solve(np.swapaxes(root, -1, -2), vectors)
    return Vibration(
        frequency=1.0 / np.sqrt(np.maximum(square, floor)),
        surface=np.swapaxes(shapes[:, :2], -1, -2),
        deflection=shapes[:, 4 * laminate.top_of_layer + 1],
        outward=_outward(shapes, laminate),
    )


def _outward(shapes: FloatArray, laminate: Laminate) -> FloatArray:
    """(n, L + 1, d) of shapes (n, unknowns, d); the lowest face of a bonded stack does not move."""
    tops = shapes[:, 4 * laminate.top_of_layer]
    lowest = np.zeros_like(shapes[:, :1]) if laminate.base == "bonded" else shapes[:, 4 * laminate.sublayers :][:, :1]
    return np.concatenate([tops, lowest], axis=1)
