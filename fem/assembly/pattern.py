"""Entries of the matrix that no element has."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from fem.arrays import IntArray
from fem.assembly.scatter import Scatter


def widened(scatter: Scatter, count: int, rows: IntArray, columns: IntArray) -> tuple[Scatter, IntArray]:
    """A scatter whose pattern has more entries.

    Parameters
    ----------
    scatter
        Sums of the elements.
    count
        Number of unknowns.
    rows, columns
        Entries (k,) that are needed, each in any order and as often as wanted; every row must have its diagonal.

    Returns
    -------
    tuple
        The scatter, and the place (k,) of each entry among the entries of the upper triangle.
    """
    low, high = np.minimum(rows, columns), np.maximum(rows, columns)
    old = np.repeat(np.arange(count), np.diff(scatter.indptr)) * count + scatter.indices
    keys, place = np.unique(np.concatenate((old, low * count + high)), return_inverse=True)
    kept, added = place[: len(old)], place[len(old) :]
    lengths = np.zeros(len(keys), dtype=np.int64)
    lengths[kept] = np.diff(scatter.matrix_sum.indptr)
    matrix = sp.csr_array(
        (
            scatter.matrix_sum.data,
            scatter.matrix_sum.indices,
            np.concatenate(([0], np.cumsum(lengths))).astype(scatter.matrix_sum.indptr.dtype),
        ),
        shape=(len(keys), scatter.matrix_sum.shape[1]),
    )
    indptr = np.searchsorted(keys // count, np.arange(count + 1))
    return replace(scatter, matrix_sum=matrix, indptr=indptr, indices=keys % count), added
