"""Graded lines: where to put the grid lines of one direction.

The wanted element size is given by features (a point with a size that grows linearly away from it) and a
largest size. Each interval between breaks gets as many elements as its integral of 1/size asks for, placed
at equal shares of that integral, so that a density of 2 halves every element.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray

OUTWARD = 0.45
"""Growth of the element size per length that is enough where nothing is singular."""


@dataclass(frozen=True)
class Feature:
    """A point that attracts grid lines.

    Attributes
    ----------
    position
        Where it is, in m.
    size
        Element size at the point, in m.
    growth
        Growth of the size per metre of distance from it.
    far
        Distance in m from which on the size grows by 1 per metre, as is enough where only a decaying far
        field is left.
    near
        Distance in m up to which it grows so; from there on by `OUTWARD`, if that is more.
    """

    position: float
    size: float
    growth: float
    far: float = math.inf
    near: float = math.inf

    def size_at(self, x: FloatArray) -> FloatArray:
        """Wanted size (m) at the positions x (n,)."""
        distance = np.abs(x - self.position)
        near = min(self.near, self.far)
        middle = np.maximum(np.minimum(distance, self.far) - near, 0.0)
        beyond = np.maximum(distance - self.far, 0.0)
        grown = self.growth * np.minimum(distance, near) + max(self.growth, OUTWARD) * middle
        out: FloatArray = self.size + grown + max(self.growth, 1.0) * beyond
        return out


@dataclass(frozen=True)
class Sizing:
    """Wanted element size along a line.

    Attributes
    ----------
    features
        Points with their sizes; the smallest size counts.
    largest
        Bounds (end, size): up to the position `end` no element is wanted larger than `size` (m).
    """

    features: tuple[Feature, ...]
    largest: tuple[tuple[float, float], ...] = ()

    def size(self, x: FloatArray) -> FloatArray:
        """Wanted size (m) at the positions x (n,)."""
        sizes = [feature.size_at(x) for feature in self.features]
        sizes += [np.where(x <= end, size, np.inf) for end, size in self.largest]
        out: FloatArray = np.min(sizes, axis=0)
        return out


def graded_line(breaks: tuple[float, ...], sizing: Sizing, density: float = 1.0) -> FloatArray:
    """Grid lines through all breaks.

    Parameters
    ----------
    breaks
        Increasing positions in m that must be grid lines, first and last included.
    sizing
        Wanted element size.
    density
        Factor on the number of elements.

    Returns
    -------
    ndarray
        Positions (n,) in m, increasing.
    """
    pieces = [np.array(breaks[:1])]
    for start, end in itertools.pairwise(breaks):
        x = _samples(start, end, sizing)
        rate = 1.0 / sizing.size(x)
        total = np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(x))))
        count = max(1, round(np.ceil(total[-1] - 1e-6) * density))
        inner = np.interp(np.linspace(0.0, total[-1], count + 1)[1:-1], total, x)
        pieces.append(np.append(inner, end))
    return np.concatenate(pieces)


def every_second(lines: FloatArray, breaks: tuple[float, ...], sharp: tuple[float, ...] = ()) -> FloatArray:
    """Half the elements: every second grid line is left out, counted from both ends of each interval between breaks.

    Parameters
    ----------
    lines
        Positions (n,) in m, increasing.
    breaks
        Positions among them that stay. Of an odd number of elements the middle one stays whole.
    sharp
        Positions among the breaks whose neighbours stay as well.
    """
    ends = np.searchsorted(lines, np.array(breaks))
    kept = [ends[:1]]
    for start, end in itertools.pairwise(ends):
        half = (end - start) // 4
        left = start + 2 * np.arange(1, half + 1)
        right = end - 2 * np.arange((end - start + 1) // 2 - half)[::-1]
        kept.append(np.unique(np.concatenate((left, right))))
    places = np.searchsorted(lines, np.array(sharp, dtype=np.float64))
    beside = np.concatenate((places - 1, places + 1))
    kept.append(beside[(beside >= 0) & (beside < len(lines))])
    out: FloatArray = lines[np.unique(np.concatenate(kept))]
    return out


def _samples(start: float, end: float, sizing: Sizing) -> FloatArray:
    """Points dense near the features, on which 1/size is integrated."""
    length = end - start
    offsets = np.concatenate(([0.0], np.geomspace(1e-7 * length, length, 600)))
    anchors = [start, end, *(f.position for f in sizing.features), *(at for at, _ in sizing.largest)]
    x = np.concatenate([at + sign * offsets for at in anchors for sign in (-1.0, 1.0)])
    inside: FloatArray = np.unique(np.concatenate((x[(x > start) & (x < end)], [start, end])))
    return inside
