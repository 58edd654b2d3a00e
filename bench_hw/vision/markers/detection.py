"""The grid of markers in a picture about which nothing is known yet: dark spots, their rows and columns, their numbers.

Spots come from an adaptive threshold: coarse, fast, and proof against uneven light; they are good to a twentieth of a
pixel, and `radial` begins there. Rows and columns are followed from neighbour to neighbour, so that the grid may be
bent or turned.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from bench_hw.errors import InputError
from bench_hw.vision.markers.grid import PAPER_LAYOUT, Blobs, DetectedGrid, FloatArray, IntArray, Layout, Picture

SMALLEST_AREA = 20.0
"""Square pixels: below a radius of 2.5 pixels there is no edge to measure."""
LOWEST_CONTRAST = 20.0
"""Grey levels between paper and ink; less is no marker but noise or shade."""
_THRESHOLD_SHARE = 0.2
_LEAST_OFFSET = 6.0
_FILL = (0.55, 0.95)
_LONGEST_SIDES = 1.8
_NEAR = (0.7, 1.3)
_CATCH = 0.35
_SIDES = ((0, 1), (0, -1), (1, 0), (-1, 0))
Straighten = Callable[[FloatArray], FloatArray]
"""Turns pixels (n, 2) into undistorted pixels; NaN where there are none."""
_BLOCK_SHARES = (1 / 24, 1 / 12, 1 / 6, 1 / 3)
_SAME_SIZE = 2.2
_GROUPS = 3
_LISTED = 4


def contrast_of(grey: Picture) -> float:
    """Give how far the darkest spots lie below the bright part of a picture, grey levels."""
    dark, bright = np.percentile(grey[::2, ::2], (0.5, 90.0))
    return float(bright - dark)


def find_blobs(grey: Picture, block: int, contrast: float, areas: tuple[float, float] | None = None) -> Blobs:
    """Find dark spots about as wide as high that do not touch the picture's border.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture.
    block : int
        Side of the square whose mean a pixel is compared with, pixels; at least three marker radii.
    contrast : float
        Between paper and ink, grey levels: a pixel counts as dark a fifth of it below the mean.
    areas : tuple of 2 floats, optional
        Least and greatest area, square pixels.

    Returns
    -------
    Blobs
        In the order of their labels (by their uppermost pixel).
    """
    smooth = cv2.GaussianBlur(grey, (5, 5), 0)
    offset = max(_LEAST_OFFSET, _THRESHOLD_SHARE * contrast)
    mode, kind = cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV
    dark = cv2.adaptiveThreshold(smooth, 255, mode, kind, block | 1, offset)
    _, _, stats, centroids = cv2.connectedComponentsWithStats(dark, connectivity=4)
    box, area = stats[1:, :4].astype(np.float64), stats[1:, cv2.CC_STAT_AREA].astype(np.float64)
    low, high = areas or (SMALLEST_AREA, grey.size / 16.0)
    good = (area >= low) & (area <= high) & _compact(box, area) & _inside(box, grey.shape)
    return Blobs(np.asarray(centroids[1:][good], dtype=np.float64), area[good])


def _compact(box: FloatArray, area: FloatArray) -> NDArray[np.bool_]:
    """Neither long nor ragged nor hollow: a disc fills 0.785 of its box."""
    width, height = box[:, 2], box[:, 3]
    fill = area / (width * height)
    sides = np.maximum(width, height) / np.minimum(width, height)
    return (fill > _FILL[0]) & (fill < _FILL[1]) & (sides < _LONGEST_SIDES)


def _inside(box: FloatArray, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    left, top, width, height = box.T
    return np.asarray((left > 0) & (top > 0) & (left + width < shape[1]) & (top + height < shape[0]))


def neighbour_distance(points: FloatArray) -> float:
    """Give the median distance of points (n, 2) from their nearest neighbours; infinite for a single one."""
    if len(points) < 2:
        return float("inf")
    distance, _ = cKDTree(points).query(points, k=2)
    return float(np.median(distance[:, 1]))


def arrange(points: FloatArray) -> IntArray:
    """Give each point its row and column in the largest grid they form.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        In pixels, undistorted best.

    Returns
    -------
    ndarray of int, shape (n, 2)
        Row (downwards) and column (to the right), from 0; -1 for points outside the grid.
    """
    index = np.full((len(points), 2), -1, dtype=np.int64)
    axes = _axes(points)
    if axes is None:
        return index
    largest: dict[int, tuple[int, int]] = {}
    from_middle = np.argsort(np.hypot(*(points - np.median(points, axis=0)).T)).tolist()
    tree, left = cKDTree(points), dict.fromkeys(from_middle)
    while len(left) > len(largest):
        found = _grow(points, tree, axes, next(iter(left)))
        left = {point: None for point in left if point not in found}
        largest = max(largest, found, key=len)
    members = np.array(sorted(largest), dtype=np.int64)
    places = np.array([largest[member] for member in members.tolist()], dtype=np.int64)
    index[members] = places - places.min(axis=0)
    return index


def _axes(points: FloatArray) -> FloatArray | None:
    """The usual steps down a row and along a column, shape (2, 2) by row; None where there is no grid."""
    spacing = neighbour_distance(points)
    if not np.isfinite(spacing) or spacing <= 0.0:
        return None
    pairs = cKDTree(points).query_pairs(_NEAR[1] * spacing, output_type="ndarray")
    steps = points[pairs[:, 1]] - points[pairs[:, 0]]
    steps = steps[np.hypot(steps[:, 0], steps[:, 1]) > _NEAR[0] * spacing]
    if len(steps) < 2:
        return None
    turn = np.angle(np.exp(4j * np.arctan2(steps[:, 1], steps[:, 0])).sum()) / 4.0
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([-along[1], along[0]])
    return np.stack([_usual(steps, across, spacing), _usual(steps, along, spacing)])


def _usual(steps: FloatArray, direction: FloatArray, spacing: float) -> FloatArray:
    """The median of the steps that go more or less in a direction, either way."""
    share = steps @ direction
    chosen: NDArray[np.bool_] = np.abs(share) > 0.85 * np.hypot(steps[:, 0], steps[:, 1])
    if not chosen.any():
        return direction * spacing
    return np.asarray(np.median(steps[chosen] * np.sign(share[chosen])[:, None], axis=0))


def _grow(points: FloatArray, tree: cKDTree, axes: FloatArray, seed: int) -> dict[int, tuple[int, int]]:
    """From a point to its neighbours and on; the step there is the one that led here, where there is one."""
    reach = _CATCH * float(np.hypot(*axes.T).min())
    found, taken = {seed: (0, 0)}, {(0, 0)}
    queue = deque([(seed, axes)])
    while queue:
        at, steps = queue.popleft()
        for side in _SIDES:
            place = (found[at][0] + side[0], found[at][1] + side[1])
            distance, near = tree.query(points[at] + np.array(side) @ steps)
            if place in taken or near in found or distance > reach:
                continue
            found[int(near)] = place
            taken.add(place)
            kind = 0 if side[0] else 1
            new = steps.copy()
            new[kind] = 0.5 * (steps[kind] + (points[near] - points[at]) * sum(side))
            queue.append((int(near), new))
    return found


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


def detect_grid(grey: Picture, layout: Layout | None = None, straight: Straighten | None = None) -> DetectedGrid:
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


def _grid(blobs: Blobs, layout: Layout | None, straight: Straighten | None) -> DetectedGrid:
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
    return DetectedGrid(
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
