"""A face inside the stack, or its clamp, from the shear that it carries to what is left when it slides freely."""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layers.compliance import every_face
from wavemodel.layers.laminate import Laminate
from wavemodel.layers.stacking import inverse


def shear_on(laminate: Laminate, blocks: FloatArray, load: FloatArray, node: int) -> FloatArray:
    """(n,) amplitude of the shear traction that the body above a face passes on to what is below.

    Parameters
    ----------
    laminate
        A stack on a bonded base.
    blocks
        (n, S, 4, 4) stiffness of its sub-layers between their faces.
    load
        (n, 2) on the surface, along U and W.
    node
        Face: 1 to S - 1 below so many sub-layers, S for the lowest, which is clamped.
    """
    moved = np.einsum("nsij,nj->nsi", every_face(laminate, blocks), load)
    upper, lower = moved[:, node - 1], moved[:, node]
    held = blocks[:, node - 1, 2:, :2] @ upper[..., None] + blocks[:, node - 1, 2:, 2:] @ lower[..., None]
    return np.asarray(-held[:, 0, 0])


def sliding_surface(laminate: Laminate, blocks: FloatArray, node: int) -> FloatArray:
    """(n, 2, 2) compliance of the surface, m/Pa, when one face passes on no shear; see `shear_on`."""
    top, across, bottom = blocks[..., :2, :2], blocks[..., 2:, :2], blocks[..., 2:, 2:]
    last = laminate.sublayers - 1
    schur = top[:, last]
    if node == laminate.sublayers:
        row = across[:, last, 0]
        schur = schur - row[:, :, None] * row[:, None, :] / bottom[:, last, 0, 0, None, None]
    for s in range(last - 1, -1, -1):
        if node == s + 1:
            schur = _without_shear(schur)
        carry = -inverse(bottom[:, s] + schur) @ across[:, s]
        schur = top[:, s] + np.swapaxes(across[:, s], -1, -2) @ carry
    return inverse(schur)


def _without_shear(stiffness: FloatArray) -> FloatArray:
    """Stiffness (n, 2, 2) of what moves along U as it likes."""
    out = np.zeros_like(stiffness)
    out[:, 1, 1] = stiffness[:, 1, 1] - stiffness[:, 0, 1] ** 2 / stiffness[:, 0, 0]
    return out
