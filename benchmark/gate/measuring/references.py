"""Reference work that the product has no part in: what a machine makes of NumPy, SciPy and Python right now.

A shared machine slows down unevenly: a neighbour that fills the caches costs a thousand small calls far more than one
matrix product. So a quantity is divided by references of its own texture, done in the same block a few milliseconds
apart, and each is fixed here once and for all: a change makes every baseline worthless.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

Work = Callable[[], Any]

SEED = 20


def dense() -> Work:
    """Gather modes and multiply dense matrices, as a frame of a surface does."""
    generator = np.random.default_rng(SEED)
    left, packed = generator.random((3, 81, 56)), generator.random((3, 1500))
    index = generator.integers(0, 1500, 56 * 56)
    modal, out = np.empty((3, 56 * 56)), np.empty((3, 81, 56))

    def work() -> None:
        for _ in range(40):
            np.take(packed, index, axis=1, out=modal, mode="clip")
            np.matmul(left, modal.reshape(3, 56, 56), out=out)

    return work


def elements() -> Work:
    """Contract small tensors over elements and factorise a sparse matrix, as a load step does."""
    from scipy.sparse import diags_array, eye_array, kron
    from scipy.sparse.linalg import splu

    generator = np.random.default_rng(SEED)
    tensor, vector = generator.random((9, 9, 200)), generator.random((9, 200))
    shapes, flat = generator.random((18, 54)), generator.random((54, 600))
    side = 24
    line = diags_array([-1.0, 4.1, -1.0], offsets=[-1, 0, 1], shape=(side, side))
    across = diags_array([-1.0, -1.0], offsets=[-1, 1], shape=(side, side))
    matrix = (kron(eye_array(side), line) + kron(across, eye_array(side))).tocsc()
    load = np.ones(side * side)

    def work() -> None:
        for _ in range(4):
            contracted = np.einsum("ijk,jk->ik", tensor, vector)
            np.concatenate(((tensor * vector[None]).reshape(-1, 200), contracted))
            np.matmul(shapes, flat)
            np.swapaxes(tensor, 0, 1)[[0, 1, 2], [1, 2, 3]]
        splu(matrix).solve(load)

    return work


def calls() -> Work:
    """Fit a curve by many small calls of NumPy and SciPy, as the fit of a trial does."""
    from scipy.interpolate import PchipInterpolator
    from scipy.optimize import least_squares

    generator = np.random.default_rng(SEED)
    knots = np.linspace(0.0, 1.0, 30)
    curve = PchipInterpolator(knots, knots + knots**2)
    depth = np.linspace(0.0, 0.7, 220)
    measured = 0.9 * curve(np.clip(depth - 0.03, 0.0, 0.9)) + 1e-3 * generator.normal(size=depth.size)

    def residual(guess: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        shifted = curve(np.clip(depth - guess[2], 0.0, 0.9))
        return np.asarray(guess[0] + guess[1] * shifted - measured)

    def work() -> None:
        least_squares(residual, [0.0, 1.2, 0.01], x_scale=[0.01, 1.0, 0.1], max_nfev=12)

    return work


def batched() -> Work:
    """Stream over arrays of a few hundred kilobytes, gather rows, contract and sum sparsely, as an assembly does."""
    from scipy.sparse import csr_array

    generator = np.random.default_rng(SEED)
    points, weight, packed = generator.random((5, 5, 9, 168)), generator.random((2, 2, 9, 168)), (171, 3, 168)
    few, rows = generator.random((18, 3, 168)), generator.integers(0, 18, (2, 171))
    table, pairs = generator.random((171, 135)), np.triu_indices(5)
    entries = 171 * 168
    total = csr_array((np.ones(entries), generator.permutation(entries), np.linspace(0, entries, 20001).astype(int)))

    def work() -> None:
        out = np.empty_like(points)
        for k in range(4):
            out[k] = points[k] * weight[0, k % 2] + points[k + 1] * weight[1, k % 2]
        out[4] = points[4] * weight[0, 0]
        moved = np.swapaxes(out, 0, 1)[pairs]
        moved += (weight[0, 0] * points[0])[pairs[0]] * points[1][pairs[1]]
        stiff = table @ moved.reshape(135, 168)
        stiff += np.einsum("pie,pie->pe", (few * weight[0, 0, 0])[rows[0]].reshape(packed), few[rows[1]])
        total @ stiff.ravel()

    return work


REFERENCES: Mapping[str, Callable[[], Work]] = MappingProxyType(
    {"dense": dense, "elements": elements, "calls": calls, "batched": batched}
)
"""The references by the names that a gate file calls them."""

CALLS = 3
"""Times that a reference runs in each block."""
