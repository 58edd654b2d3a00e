"""Layers put on top of each other: the stiffness between the outer faces of two that share one."""

from itertools import pairwise

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layers.laminate import Laminate


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
