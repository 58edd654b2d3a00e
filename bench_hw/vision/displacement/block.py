"""The nine inner markers around the tool, and the ring of eight among them (the article's Fig. 8)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.vision.displacement.tracks import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Block:
    """A 3 x 3 block of a grid.

    Parameters
    ----------
    centre : int
        Number of its middle marker, the article's star.
    nine : ndarray of int, shape (9,)
        Row by row.
    ring : ndarray of int, shape (8,)
        Without the middle one.
    """

    centre: int
    nine: NDArray[np.int64]
    ring: NDArray[np.int64]


def inner_nine(rest: FloatArray, rows: int, columns: int, centre: int | None = None) -> Block:
    """Choose the 3 x 3 block whose middle is nearest the tool axis, which is the origin; ties towards -x.

    Parameters
    ----------
    rest : ndarray, shape (rows * columns, 2)
        Where the markers rest, m, numbered row by row.
    rows, columns : int
        The grid's layout, at least 3 each.
    centre : int, optional
        Number of the middle marker instead.

    Raises
    ------
    InputError
        No 3 x 3 block fits the grid or lies around that marker, or no marker that could be one was seen.
    """
    if rest.shape != (rows * columns, 2) or min(rows, columns) < 3:
        raise InputError(f"{len(rest)} markers as {rows} x {columns}: allowed is a full grid of at least 3 x 3")
    number = np.arange(rows * columns).reshape(rows, columns)
    inner = number[1:-1, 1:-1].ravel()
    if centre is None:
        centre = _nearest(rest, inner)
    elif centre not in inner:
        raise InputError(f"centre marker {centre}: allowed are those with neighbours all round, {inner.tolist()}")
    row, column = divmod(centre, columns)
    nine = number[row - 1 : row + 2, column - 1 : column + 2].ravel()
    return Block(centre, nine, nine[nine != centre])


def _nearest(rest: FloatArray, inner: NDArray[np.int64]) -> int:
    distance = np.hypot(rest[inner, 0], rest[inner, 1])
    if not np.isfinite(distance).any():
        raise InputError("none of the inner markers was ever seen; allowed: at least one")
    nearest = float(np.nanmin(distance))
    tied = inner[distance <= nearest * 1.02 + 1e-12]
    return int(tied[np.argmin(rest[tied, 0])])
