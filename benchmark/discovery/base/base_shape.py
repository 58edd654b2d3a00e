"""How an elastic table may be wrong in shape: nuisances of the base, and the table bent by them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from benchmark.physics import LowerFaceMotion
from benchmark.response.elastic_table import ElasticTable, SeparableField
from benchmark.response.force_curve import Array

THICKNESS = ".thickness"
"""End of the key of a layer's thickness."""


@dataclass(frozen=True)
class Shape:
    """How the base deviates from its table; all zero for the table itself.

    Attributes
    ----------
    modulus : float
        Natural logarithm of the common factor on the moduli.
    setup : mapping of str to float
        Relative changes of set-up parameters by their keys, as in `--set`.
    added : mapping of str to (float, float)
        Amounts of what the table's `added` has by their keys, SI, and the part of each that the lower face shows.
    exponent : float
        Change of the force's exponent.
    bend, turn : float
        Amounts of the second and third shifted Legendre polynomial over depth in the force.
    width, marker_exponent, marker_size : float
        Relative width of the marker field, change of its exponent over depth, relative size.
    grid_scale : float
        Relative size of the printed marker grid.
    tilt_x, tilt_y : float
        Slopes of the lower face against the camera's plane: what sinks by w moves by slope times w in the picture.
    lens : float
        What the camera's radial distortion leaves, relative at the outermost marker (k1 times its radius squared).
    centre_x, centre_y : float
        Where the tool's axis meets the grid, from its centre, relative to the outermost marker's distance.
    """

    modulus: float = 0.0
    setup: Mapping[str, float] = field(default_factory=dict)
    added: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    exponent: float = 0.0
    bend: float = 0.0
    turn: float = 0.0
    width: float = 0.0
    marker_exponent: float = 0.0
    marker_size: float = 0.0
    grid_scale: float = 0.0
    tilt_x: float = 0.0
    tilt_y: float = 0.0
    lens: float = 0.0
    centre_x: float = 0.0
    centre_y: float = 0.0


@dataclass(frozen=True, eq=False)
class ShapedTable:
    """A table with a shape, worked out once for all trials of a condition.

    Attributes
    ----------
    table : ElasticTable
    shape : Shape
    deep : float
        Largest depth of the condition, m, on which bends and exponents rest.
    """

    table: ElasticTable
    shape: Shape
    deep: float

    @cached_property
    def forces(self) -> Array:
        """(k,) N over the table's depths."""
        shape = self.shape
        x = np.clip(self.table.depth / self.deep, 0.0, None)
        inside = np.minimum(x, 1.0)
        second, third = 6 * inside**2 - 6 * inside + 1, 20 * inside**3 - 30 * inside**2 + 12 * inside - 1
        force = self.table.force_with(shape.setup)
        bent = force * (1.0 + shape.bend * second + shape.turn * third) * np.maximum(x, 1e-4) ** shape.exponent
        return np.asarray(np.exp(shape.modulus) * (np.maximum(bent, 0.0) + self._more))

    def thicker(self, share: float) -> ShapedTable:
        """Of a specimen whose layers are all thicker by a share."""
        if not share:
            return self
        own = {key: self.shape.setup.get(key, 0.0) + share for key in self.table.by if key.endswith(THICKNESS)}
        return replace(self, shape=replace(self.shape, setup={**self.shape.setup, **own}))

    @cached_property
    def slope(self) -> float:
        """N/m beyond the table."""
        depth = self.table.depth
        return float((self.forces[-1] - self.forces[-20]) / (depth[-1] - depth[-20]))

    def force(self, depth: Array) -> Array:
        """(n,) N at depths (n,) of 0 and more, m; straight on beyond the table."""
        known = self.table.depth
        force = np.interp(depth, known, self.forces)
        return np.asarray(force + self.slope * np.maximum(depth - known[-1], 0.0))

    @cached_property
    def outward(self) -> SeparableField | None:
        """The outward motion of the lower face with this set-up."""
        return self.table.outward_with(self.shape.setup, self._amounts, self._shown)

    @cached_property
    def sink(self) -> SeparableField | None:
        """Its sinking with this set-up."""
        return self.table.sink_with(self.shape.setup, self._amounts, self._shown)

    @property
    def _more(self) -> Array:
        """(k,) N that what the set-up as told has none of adds, over the factor on the moduli."""
        return self.table.force_added(self._amounts, self.shape.setup)

    @property
    def _amounts(self) -> dict[str, float]:
        """Of that in the table's specimen: a stress does and moves the less, the stiffer the specimen."""
        shape = self.shape
        return {key: amount * float(np.exp(-shape.modulus)) for key, (amount, _) in shape.added.items()}

    @property
    def _shown(self) -> dict[str, float]:
        """The part of each that the fields show."""
        return {key: part for key, (_, part) in self.shape.added.items()}

    def lower_face(self, spread: LowerFaceMotion, rest: Array) -> tuple[Array, Array]:
        """Positions (n, m, 2) and sinking (n, m) of markers at rest positions (m, 2), m."""
        rows, count = spread.depth.size, len(rest)
        if self.outward is None or self.sink is None:
            return np.broadcast_to(rest, (rows, count, 2)).copy(), np.zeros((rows, count))
        x, y = (rest - np.asarray(spread.centre) - self._centre(rest)).T
        root = np.sqrt(spread.ratio)
        radius = np.sqrt(x**2 / root + y**2 * root)
        read = radius / (1.0 + self.shape.width)
        safe = np.maximum(radius, 1e-12)
        along = np.column_stack([x / root / safe, y * root / safe])
        over_depth = self._over_depth(spread.depth)
        out = self._over_radius(self.outward, read, over_depth)
        moved = (1.0 + self.shape.marker_size) * spread.passed[:, None] * out
        if spread.dent is not None:
            moved = moved + spread.dent[0][:, None] / np.maximum(radius, spread.dent[1])
        sunk = self._over_radius(self.sink, read, over_depth)
        return self._in_picture(rest, [rest[:, k] + moved * along[:, k] for k in (0, 1)], sunk), sunk

    def _centre(self, rest: Array) -> Array:
        """(2,) m at which the axis lies from the centre of markers at rest positions (m, 2)."""
        size = float(np.sqrt(np.sum(rest**2, axis=1).max()))
        return size * np.array([self.shape.centre_x, self.shape.centre_y])

    def _in_picture(self, rest: Array, there: list[Array], sunk: Array) -> Array:
        """Positions (n, m, 2) of markers at x and y (n, m) that sank (n, m), by a camera that is not quite told.

        Markers are followed from where they rest in the picture, which holds what the camera does to the grid.
        """
        shape = self.shape
        if shape.tilt_x or shape.tilt_y:
            there = [each + slope * sunk for each, slope in zip(there, (shape.tilt_x, shape.tilt_y), strict=True)]
        if shape.lens:
            x, y = there
            near, far = np.sum(rest**2, axis=1), x**2 + y**2
            size = shape.lens / max(float(near.max()), 1e-12)
            there = [each + size * (each * far - rest[:, k] * near) for k, each in enumerate(there)]
        return np.stack(there, axis=-1)

    def _over_depth(self, depth: Array) -> tuple[NDArray[np.int64], Array, Array]:
        """Where depths (n,), mirrored above the surface, lie in the table: a row, its weight, the next one's."""
        known, size = self.table.depth, np.abs(depth)
        growth = np.maximum(size / self.deep, 1e-4) ** self.shape.marker_exponent * np.sign(depth)
        at = np.clip(size / known[1], 0.0, known.size - 1.000001)
        low = at.astype(np.int64)
        share = at - low
        return low, (1.0 - share) * growth, share * growth

    def _over_radius(
        self, field: SeparableField, radius: Array, over_depth: tuple[NDArray[np.int64], Array, Array]
    ) -> Array:
        """(n, m) m of a field at depths (n,) and radii (m,), m; the field at those radii is kept for the next trial."""
        key = (field is self.sink, radius.tobytes())
        if key not in self._kept:
            shapes = np.array([np.interp(radius, self.table.radius, row, right=0.0) for row in field.shapes])
            self._kept[key] = field.amplitudes.T @ shapes
        known, (low, before, after) = self._kept[key], over_depth
        return np.asarray(known[low] * before[:, None] + known[low + 1] * after[:, None])

    @cached_property
    def _kept(self) -> dict[tuple[bool, bytes], Array]:
        """Fields (k, m) over the table's depths at radii that were asked for; whether it is the sinking."""
        return {}
