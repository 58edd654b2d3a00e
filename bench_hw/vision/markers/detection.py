"""The grid of markers in a picture about which nothing is known yet."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.markers.blobs import LOWEST_CONTRAST, contrast_of, find_blobs
from bench_hw.vision.markers.lattice import arrange, neighbour_distance
from bench_hw.vision.markers.model import PAPER_LAYOUT, Blobs, FloatArray, Grid, IntArray, Layout, Picture

Straighten = Callable[[FloatArray], FloatArray]
"""Turns pixels (n, 2) into undistorted pixels; NaN where there are none."""

_BLOCK_SHARES = (1 / 24, 1 / 12, 1 / 6, 1 / 3)
_SAME_SIZE = 2.2
_GROUPS = 3
_LISTED = 4


class GridError(InputError):
    """A picture without the whole grid; the text says what was found in its place.

    Parameters
    ----------
    problem : str
        What was found, and what is allowed.
    found : int
        Number of spots that lie in a grid.
    """

    def __init__(self, problem: str, found: int = 0) -> None:
        super().__init__(problem)
        self.found = found


def detect_grid(grey: Picture, layout: Layout | None = None, straight: Straighten | None = None) -> Grid:
    """Find the grid of markers in a picture.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture.
    layout : Layout, optional
        The grid as it lies in the picture; without it, the paper's 18 markers in any rows and columns.
    straight : callable, optional
        Takes the distortion off before the grid is looked for.

    Raises
    ------
    GridError
        No contrast, too few or too many markers, or a hole in the grid.
    """
    contrast = contrast_of(grey)
    if contrast < LOWEST_CONTRAST:
        raise GridError(
            f"no markers: the contrast is {contrast:.0f} grey levels; "
            f"allowed: dark markers on a light sheet, at least {LOWEST_CONTRAST:.0f}"
        )
    problem = GridError(f"no markers: no dark round spots; allowed: {_allowed(layout)}")
    for blobs in _candidates(grey, contrast):
        try:
            return _grid(blobs, layout, straight)
        except GridError as error:
            problem = error if error.found > problem.found else problem
    raise problem


def _candidates(grey: Picture, contrast: float) -> Iterator[Blobs]:
    """Spots of one size, by ever wider thresholds; the most numerous group first."""
    for share in _BLOCK_SHARES:
        blobs = find_blobs(grey, round(share * min(grey.shape)), contrast)
        for _ in range(_GROUPS):
            if len(blobs) < 2:
                break
            area = np.sort(blobs.area)
            members = np.searchsorted(area, area * _SAME_SIZE, side="right") - np.arange(len(area))
            low = area[len(area) - 1 - int(np.argmax(members[::-1]))]
            same = np.flatnonzero((blobs.area >= low) & (blobs.area <= low * _SAME_SIZE))
            yield blobs.subset(same)
            blobs = blobs.subset(np.delete(np.arange(len(blobs)), same))


def _grid(blobs: Blobs, layout: Layout | None, straight: Straighten | None) -> Grid:
    points = blobs.centres if straight is None else straight(blobs.centres)
    known = np.asarray(np.isfinite(points).all(axis=1))
    index = arrange(points[known])
    member = index[:, 0] >= 0
    index, blobs = index[member], blobs.subset(known).subset(member)
    rows, columns = (int(n) for n in index.max(axis=0, initial=-1) + 1)
    wanted = PAPER_LAYOUT.count if layout is None else layout.count
    fits = (rows, columns) == (layout.rows, layout.columns) if layout else rows * columns == wanted
    if len(blobs) != wanted or not fits:
        raise GridError(_refusal(index, rows, columns, layout, int((~known).sum())), len(blobs))
    order = np.lexsort((index[:, 1], index[:, 0]))
    return Grid(
        layout=Layout(rows, columns),
        centres=blobs.centres[order],
        radius=float(np.sqrt(np.median(blobs.area) / np.pi)),
        spacing=neighbour_distance(blobs.centres),
        strays=int((~member).sum()),
    )


def _refusal(index: IntArray, rows: int, columns: int, layout: Layout | None, outside: int) -> str:
    text = f"{len(index)} markers in {rows} rows and {columns} columns"
    places = set(map(tuple, index.tolist()))
    holes = [(i, j) for i in range(rows) for j in range(columns) if (i, j) not in places]
    if holes and len(holes) <= _LISTED:
        text += ", none at row and column " + ", ".join(f"{i + 1}, {j + 1}" for i, j in holes)
    if outside:
        text += f", and {outside} spots where the camera's distortion has no inverse"
    return f"{text}; allowed: {_allowed(layout)}"


def _allowed(layout: Layout | None) -> str:
    if layout is None:
        return f"the {PAPER_LAYOUT.count} markers of a full grid such as {PAPER_LAYOUT} (`--grid` for another)"
    return f"{layout.count} markers, {layout}"
