"""The marker grid and the combinations of markers in which effects show themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array
from benchmark.files import Camera

RINGS = 3
PLACED = ("x", "y", "tangential")
"""Combinations that tell where the camera stands, which has a zero of its own in each trial."""
CENTRAL = 0.2
"""Markers nearer to the axis than this share of the spacing have no direction."""
LEAST_OWN = 0.1
"""Of its norm, which a combination must have beside the others to be one of its own: first choice. On 3 x 6 markers it
is 0.54 and 0.62, on 3 x 3 0.32, where all radii are one it is none."""


@dataclass(frozen=True, eq=False)
class Layout:
    """The marker grid and the combinations of markers that are compared.

    Attributes
    ----------
    rest : (m, 2)
        Resting positions, m.
    weights : (signals, m, 2)
    names, channels : tuple of str
        The combinations, and where each is reported.
    zeros : tuple of str
        Combinations with a zero of their own in each trial.
    origin : (2,)
        Where the camera sees the grid's centre, m.
    scale_error : float
        Standard error of the grid's scale; 0 where the grid is trusted.
    lens, lens_error : float
        Radial distortion that the grid shows at rest, relative at the outermost marker, and its standard error.
    centre_error : float
        Standard error of the grid's centre along each axis, relative to the outermost marker's distance from it.
    """

    rest: Array
    weights: Array
    names: tuple[str, ...]
    channels: tuple[str, ...]
    zeros: tuple[str, ...]
    origin: Array
    scale_error: float = 0.0
    lens: float = 0.0
    lens_error: float = np.inf
    centre_error: float = 0.0

    @cached_property
    def scale_pattern(self) -> Array:
        """(signals,) m by which a grid of twice the size differs."""
        return np.asarray(np.tensordot(self.rest, self.weights, axes=([0, 1], [1, 2])))

    @cached_property
    def zero_columns(self) -> list[int]:
        """Numbers of the combinations with a zero of their own."""
        return [self.names.index(name) for name in self.zeros]

    def lens_within(self, usual: float) -> tuple[float, float]:
        """Mean and standard deviation of the lens's distortion, which is `usual` where no grid shows it."""
        weight = usual**2 / (usual**2 + self.lens_error**2)
        return weight * self.lens, usual * max(float(np.sqrt(1.0 - weight)), criteria.LENS_FORM)

    def seen_scale(self, printed: float, lens: float) -> float:
        """Relative scale of the grid in the picture: as it is printed, and as radial distortion widens it.

        Markers are followed from where they rest, so that of a distortion `lens` (relative at the outermost marker) the
        scale alone is left at rest; a grid that is trusted shows none.
        """
        square = np.sum(self.rest**2, axis=1)
        if self.scale_error == 0.0 or not square.any():
            return printed
        return printed + lens * float(np.sum(square**2) / (square.max() * np.sum(square)))

    def signals(self, positions: Array) -> Array:
        """(..., signals) combinations of positions (..., m, 2), m, less their resting places."""
        moved = (positions - self.rest).reshape(*positions.shape[:-2], -1)
        return np.asarray(moved @ self._by_coordinate)

    @cached_property
    def _by_coordinate(self) -> Array:
        """(2 m, signals) weights of the markers' x and y, one marker after the other."""
        return np.ascontiguousarray(self.weights.reshape(len(self.weights), -1).T)


def grid(camera: Camera) -> Array:
    """(rows * columns, 2) nominal positions in m, row by row, round the grid's centre."""
    columns = (np.arange(camera.marker_columns) - 0.5 * (camera.marker_columns - 1)) * camera.marker_spacing
    rows = (np.arange(camera.marker_rows) - 0.5 * (camera.marker_rows - 1)) * camera.marker_spacing
    y, x = np.meshgrid(rows, columns, indexing="ij")
    return np.column_stack([x.ravel(), y.ravel()])


def layout(rest: Array, spacing: float) -> Layout:
    """Combinations for markers at rest positions (m, 2).

    Radial by ring and tangential, translations, the radial part along x and along y (an axis beside the centre), cos 2
    theta radially and sin 2 theta tangentially (unlike axes), free of what rings and translations already hold. The
    radial parts count once more by the square of the radius: a camera that looks down askew moves markers along x and y
    as an axis beside the centre does, but otherwise farther out.
    """
    radius = np.hypot(rest[:, 0], rest[:, 1])
    outside = radius > CENTRAL * spacing
    unit = np.divide(rest, radius[:, None], out=np.zeros_like(rest), where=outside[:, None])
    around = np.column_stack([-unit[:, 1], unit[:, 0]])
    angle = 2.0 * np.arctan2(rest[:, 1], rest[:, 0])
    rings = [unit * ring[:, None] / ring.sum() for ring in _rings(radius, outside)]
    shifts = [np.tile(axis, (len(rest), 1)) / len(rest) for axis in np.eye(2)]
    rows = [(f"radial_{number}", "marker_radial", ring) for number, ring in enumerate(rings, start=1)]
    rows.append(("tangential", "marker_tangential", around / outside.sum()))
    rows += [(name, f"marker_{name}", shift) for name, shift in zip("xy", shifts, strict=True)]
    plain = [*rings, *shifts]
    others = [(f"radial_{name}", "marker_radial", unit * unit[:, k, None]) for k, name in enumerate("xy")]
    halves = [pattern for _, _, pattern in others]
    outer = [(f"outer_{name}", _farther(halves[k], radius, plain + halves)) for k, name in enumerate("xy")]
    others.append(("cos_2", "marker_radial", unit * np.cos(angle)[:, None]))
    others.append(("sin_2", "marker_tangential", around * np.sin(angle)[:, None]))
    rows += [(name, channel, _free_of(plain, pattern)) for name, channel, pattern in others]
    rows += [(name, "marker_radial", pattern) for name, pattern in outer if pattern.any()]
    names, channels, weights = zip(*rows, strict=True)
    return Layout(rest, np.array(weights), tuple(names), tuple(channels), PLACED, np.zeros(2))


def _rings(radius: Array, outside: np.ndarray) -> Sequence[Array]:
    """Masks (m,) of up to three rings with about equally many markers."""
    levels = np.unique(np.round(radius[outside], 6))
    groups = np.array_split(levels, min(RINGS, levels.size))
    return [(outside & (radius >= g[0] - 1e-6) & (radius <= g[-1] + 1e-6)).astype(float) for g in groups]


def _farther(pattern: Array, radius: Array, others: Sequence[Array]) -> Array:
    """A pattern (m, 2) by the square of the radius (m,), free of others; none where the grid has too few radii."""
    weighted = pattern * (radius[:, None] / radius.max()) ** 2
    own = _free_of(others, weighted)
    return own if np.linalg.norm(own) * len(own) > LEAST_OWN * np.linalg.norm(weighted) else np.zeros_like(own)


def _free_of(others: Sequence[Array], pattern: Array) -> Array:
    """Pattern (m, 2) without its part in the span of others, on the scale of a mean."""
    basis = np.array([other.ravel() for other in others]).T
    rest = pattern.ravel() - basis @ np.linalg.lstsq(basis, pattern.ravel(), rcond=None)[0]
    return np.asarray(rest.reshape(pattern.shape) / len(pattern))
