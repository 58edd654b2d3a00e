"""Static answer of the stack to tractions on its surface, one wavenumber at a time.

The stiffness of each sub-layer between its faces (the quadratic one with its middle node condensed, or the exact
one) is block tridiagonal when stacked; it is eliminated from the base up and solved back down, for all wavenumbers
at once. Layers that share a face are put on top of each other by eliminating it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.stack.sublayers import exact_stiffness, quadratic_stiffness

FaceStiffness: TypeAlias = Callable[[FloatArray, Laminate], FloatArray]
"""(n,) wavenumbers and a laminate to (n, S, 4, 4)."""
THIN = 0.005
"""Thickness of a slice times the wavenumber: the layer comes out to 1e-7, as good as rounding allows."""
BLOCK = 512
"""Wavenumbers taken at once: their matrices stay in the cache."""


def stacked(upper: FloatArray, lower: FloatArray) -> FloatArray:
    """Eliminate the shared face of two layers: (..., 4, 4) between U, W of top and bottom, each, to the same."""
    shared = inverse(upper[..., 2:, 2:] + lower[..., :2, :2])
    above, below = upper[..., 2:, :2], lower[..., :2, 2:]
    out = np.empty(np.broadcast_shapes(upper.shape, lower.shape))
    out[..., :2, :2] = upper[..., :2, :2] - np.swapaxes(above, -1, -2) @ shared @ above
    out[..., 2:, 2:] = lower[..., 2:, 2:] - np.swapaxes(below, -1, -2) @ shared @ below
    out[..., 2:, :2] = -np.swapaxes(below, -1, -2) @ shared @ above
    out[..., :2, 2:] = np.swapaxes(out[..., 2:, :2], -1, -2)
    return out


def layer_faces(laminate: Laminate, blocks: FloatArray) -> FloatArray:
    """Join the sub-layers (n, S, 4, 4) of each layer: (n, L, 4, 4)."""
    edges = [*laminate.top_of_layer.tolist(), laminate.sublayers]
    layers = []
    for first, last in pairwise(edges):
        whole = blocks[:, first]
        for s in range(first + 1, last):
            whole = stacked(whole, blocks[:, s])
        layers.append(whole)
    return np.stack(layers, axis=1)


def inverse(matrix: FloatArray) -> FloatArray:
    """Inverse of symmetric 2 x 2 matrices (..., 2, 2)."""
    a, b, d = matrix[..., 0, 0], matrix[..., 0, 1], matrix[..., 1, 1]
    out = np.empty_like(matrix)
    out[..., 0, 0] = d
    out[..., 1, 1] = a
    out[..., 0, 1] = out[..., 1, 0] = -b
    return out / (a * d - b * b)[..., None, None]


@dataclass(frozen=True)
class Compliance:
    """Displacement of faces per unit traction on the surface, for n wavenumbers.

    Attributes
    ----------
    wavenumber
        (n,) in rad/m.
    faces
        (n, L, 2, 2) in m/Pa: [.., l, i, j] is U (i = 0) or W (i = 1) of the top face of layer l under a unit
        traction on the surface along U (j = 0) or W (j = 1).
    """

    wavenumber: FloatArray
    faces: FloatArray

    def respond(self, load: FloatArray) -> FloatArray:
        """(n, L, 2) amplitudes (U, W) under surface loads (n, 2)."""
        answer: FloatArray = np.einsum("nlij,nj->nli", self.faces, load)
        return answer


def quadratic_faces(wavenumber: FloatArray, laminate: Laminate) -> FloatArray:
    """Quadratic sub-layers, their middle nodes condensed: (n, S, 4, 4) in Pa/m."""
    full = quadratic_stiffness(wavenumber, laminate)
    outer, to_mid, mid = full[..., :4, :4], full[..., :4, 4:], full[..., 4:, 4:]
    return outer - to_mid @ inverse(mid) @ np.swapaxes(to_mid, -1, -2)


def exact_faces(wavenumber: FloatArray, laminate: Laminate) -> FloatArray:
    """Exact static sub-layers: (n, S, 4, 4) in Pa/m."""
    if laminate.tension is not None:
        return doubled_faces(wavenumber, laminate)
    return exact_stiffness(wavenumber, laminate)


def doubled_faces(wavenumber: FloatArray, laminate: Laminate) -> FloatArray:
    """The same for any sub-layers: a slice thin against the wavelength, put on its like again and again."""
    out = np.empty((wavenumber.size, laminate.sublayers, 4, 4))
    for s in range(laminate.sublayers):
        times = np.maximum(np.ceil(np.log2(wavenumber * laminate.thickness[s] / THIN)), 0.0)
        for count in np.unique(times):
            chosen = np.flatnonzero(times == count)
            slice_ = _slice(laminate.at(chosen), s, 2.0**-count)
            whole = quadratic_faces(wavenumber[chosen], slice_)
            for _ in range(int(count)):
                whole = stacked(whole, whole)
            out[chosen, s] = whole[:, 0]
    return out


def _slice(laminate: Laminate, index: int, share: float) -> Laminate:
    """A share of one sub-layer's thickness."""
    only = slice(index, index + 1)
    return replace(
        laminate,
        thickness=share * laminate.thickness[only],
        shear_modulus=laminate.shear_modulus[only],
        lame_modulus=laminate.lame_modulus[only],
        density=laminate.density[only],
        tension=None if laminate.tension is None else laminate.tension[..., only],
    )


def compliance(wavenumber: FloatArray, laminate: Laminate, stiffness: FaceStiffness = quadratic_faces) -> Compliance:
    """Solve the stack for unit tractions on its surface.

    Parameters
    ----------
    wavenumber
        (n,) in rad/m, above zero.
    laminate
        The stack.
    stiffness
        `quadratic_faces` or `exact_faces`.
    """
    blocks = np.array_split(np.arange(wavenumber.size), max(1, wavenumber.size // BLOCK))
    faces = [
        every_face(laminate, stiffness(wavenumber[block], laminate.at(block)))[:, laminate.top_of_layer]
        for block in blocks
    ]
    return Compliance(wavenumber, np.concatenate(faces))


def every_face(laminate: Laminate, blocks: FloatArray) -> FloatArray:
    """Compliance of all S + 1 faces from the surface down, the lowest included.

    Parameters
    ----------
    laminate
        The stack.
    blocks
        (n, S, 4, 4) stiffness of its sub-layers between their faces.

    Returns
    -------
    ndarray (n, S + 1, 2, 2)
        In m/Pa.
    """
    top, across, bottom = blocks[..., :2, :2], blocks[..., 2:, :2], blocks[..., 2:, 2:]
    count = laminate.sublayers
    carry = np.zeros((count, blocks.shape[0], 2, 2))
    schur = top[:, -1]
    if laminate.base == "free":
        carry[-1] = -inverse(bottom[:, -1]) @ across[:, -1]
        schur = schur + np.swapaxes(across[:, -1], -1, -2) @ carry[-1]
    for s in range(count - 2, -1, -1):
        carry[s] = -inverse(bottom[:, s] + schur) @ across[:, s]
        schur = top[:, s] + np.swapaxes(across[:, s], -1, -2) @ carry[s]
    faces = np.empty((blocks.shape[0], count + 1, 2, 2))
    faces[:, 0] = inverse(schur)
    for s in range(count):
        faces[:, s + 1] = carry[s] @ faces[:, s]
    return faces
