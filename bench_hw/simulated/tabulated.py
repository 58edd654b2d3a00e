"""`TabulatedSpecimen`: a sheet whose answer was computed elsewhere, on a grid of depths, and is interpolated here.

Force and lower face follow the depth at once; relaxation lowers the force, not the face: a sheet of one material that
creeps in all its parts alike keeps its shape while the depth is held. Everything is synthetic.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from bench_hw.errors import InputError
from bench_hw.simulated.specimen import FloatArray, MarkerGrid, Response
from bench_hw.storage.atomic import write_text

SCHEMA = 1
_GRID = MarkerGrid()
_ARRAYS = ("depth", "force", "radius", "outward", "sunk")


@dataclass(frozen=True, eq=False, slots=True)
class SheetTable:
    """What a sheet over a hole does at rest at each depth; SI.

    Parameters
    ----------
    depth : ndarray, shape (k,)
        Increasing from 0, m.
    force : ndarray, shape (k,)
        Press, N.
    radius : ndarray, shape (m,)
        Distance from the tool axis before the press, increasing from 0, m.
    outward, sunk : ndarray, shape (k, m)
        Displacement of the lower face away from the axis, and downwards, m.
    hole_radius, tool_radius : float
        m.
    source : str
        Who computed it.
    tissue : str
        The shipped tissue that it is of, whose stiffness need not be the sheet's; "" where none is known.
    """

    depth: FloatArray
    force: FloatArray
    radius: FloatArray
    outward: FloatArray
    sunk: FloatArray
    hole_radius: float
    tool_radius: float
    source: str
    tissue: str = ""


@dataclass(frozen=True, slots=True)
class Scatter:
    """What differs from press to press of one sheet on a bench: standard deviations, assumed.

    The sheet stays clamped where it is, so the tool comes down on the same point of it unless `axis` says otherwise.

    Parameters
    ----------
    gain : float
        Of the logarithm of the stiffness.
    contact, axis : float
        Of the place where the tool meets the sheet, and of the tool axis in x and in y, m.
    """

    gain: float = 0.02
    contact: float = 5e-5
    axis: float = 0.0


@dataclass(slots=True)
class _Memory:
    """What is not worked out twice: where the relaxation of the newest row stands, and the face at the markers."""

    time: float = -1.0
    elastic: float = 0.0
    lags: tuple[float, ...] = ()
    face: Callable[[FloatArray], FloatArray] | None = None
    force: Callable[[FloatArray], FloatArray] | None = None


@dataclass(frozen=True, eq=False, slots=True)
class TabulatedSpecimen:
    """A sheet by its table, as a `Specimen`.

    Parameters
    ----------
    table : SheetTable
        Of the fresh sheet.
    relaxation : tuple of (float, float)
        Shares and times (s) of a Prony series of the force: g, tau.
    gain : float
        Stiffness over the table's.
    axis : tuple of 2 floats
        Where the tool axis meets the marker grid, from the grid's centre, m.
    grid : MarkerGrid
        Where the markers are at rest.
    scatter : Scatter or None
        What is drawn anew for every press; None for the same sheet in the same place each time.
    """

    table: SheetTable
    relaxation: tuple[tuple[float, float], ...] = ()
    gain: float = 1.0
    axis: tuple[float, float] = (0.0, 0.0)
    grid: MarkerGrid = _GRID
    scatter: Scatter | None = None
    _memory: _Memory = field(default_factory=_Memory)

    def __call__(self, time: FloatArray, depth: FloatArray, start: int) -> Response:
        """Answer a history of depth; the rows must be equally spaced in time, as those of the bench are.

        Raises
        ------
        ValueError
            A depth beyond the table.
        """
        pressed = np.maximum(depth, 0.0)
        deepest = float(pressed[start:].max(initial=0.0))
        if deepest > self.table.depth[-1]:
            limit = 1e3 * self.table.depth[-1]
            raise ValueError(f"depth {1e3 * deepest:g} mm: the table of the specimen ends at {limit:g} mm")
        force = np.zeros((len(depth) - start, 3))
        force[:, 2] = np.maximum(self._press(time, pressed, start), 0.0) * (pressed[start:] > 0.0)
        return Response(force, self._markers(pressed[start:]))

    def laid_anew(self, rng: np.random.Generator) -> tuple[TabulatedSpecimen, float]:
        """The sheet as it lies for one more press, and how far that is above or below its usual place, m."""
        if self.scatter is None:
            return self, 0.0
        gain, contact, *axis = rng.standard_normal(4)
        x, y = (middle + self.scatter.axis * off for middle, off in zip(self.axis, axis, strict=True))
        drawn = self.gain * float(np.exp(self.scatter.gain * gain))
        return TabulatedSpecimen(self.table, self.relaxation, drawn, (x, y), self.grid), self.scatter.contact * contact

    def session_keys(self) -> dict[str, object]:
        """What a session file says of this specimen: tissue where it is known, tool, support and markers."""
        return ({"specimen": self.table.tissue} if self.table.tissue else {}) | {
            "tool": {"radius": f"{self.table.tool_radius * 1e3:g} mm", "contact": "rigid_bonded"},
            "support": {"kind": "hole", "hole_radius": f"{self.table.hole_radius * 1e3:g} mm"},
            "camera": {
                "marker_rows": self.grid.rows,
                "marker_columns": self.grid.columns,
                "marker_spacing": f"{self.grid.spacing * 1e3:g} mm",
            },
        }

    def _press(self, time: FloatArray, pressed: FloatArray, start: int) -> FloatArray:
        goes_on = start > 0 and self._memory.time == time[start - 1]
        known, first = (self._memory, start) if goes_on else (_Memory(), 0)
        elastic = self.gain * self._elastic(pressed[first:])
        total, ends = elastic, []
        step = float(time[1] - time[0]) if len(time) > 1 else 1e-3
        rises = np.diff(elastic, prepend=known.elastic)
        for (share, tau), lag in zip(self.relaxation, known.lags or (0.0,) * len(self.relaxation), strict=True):
            keep = np.exp(-step / tau)
            gone, _ = lfilter([share * tau / step * (1.0 - keep)], [1.0, -keep], rises, zi=[keep * lag])
            total = total - share * elastic + gone
            ends.append(float(gone[-1]) if len(gone) else lag)
        if len(elastic) and (time[-1] > self._memory.time or time[start] == 0.0):  # not one of the past
            self._memory.time, self._memory.elastic = float(time[-1]), float(elastic[-1])
            self._memory.lags = tuple(ends)
        return np.asarray(total[start - first :])

    def _elastic(self, pressed: FloatArray) -> FloatArray:
        """Force of the fresh sheet at depths (n,) by a cubic spline, as its face: a chord lies above the curve."""
        if self._memory.force is None:
            self._memory.force = CubicSpline(self.table.depth, self.table.force)
        return np.asarray(self._memory.force(pressed))

    def _markers(self, pressed: FloatArray) -> FloatArray:
        rest = self.grid.positions()
        arm = rest - np.array(self.axis)
        outward, sunk = self._face(pressed, np.hypot(*arm.T))
        moved = rest + arm * (outward / np.maximum(np.hypot(*arm.T), 1e-12))[..., None]
        return np.concatenate([moved, sunk[..., None]], axis=-1)

    def _face(self, pressed: FloatArray, radius: FloatArray) -> FloatArray:
        """Outward and sunk at depths (n,) and the markers' radii (m,) by cubic splines: (2, n, m)."""
        if self._memory.face is None:
            table = self.table
            fields = np.stack([table.outward, table.sunk], axis=1)
            at_markers = CubicSpline(table.radius, fields, axis=2)(np.minimum(radius, table.radius[-1]))
            self._memory.face = CubicSpline(table.depth, at_markers)
        return np.asarray(np.moveaxis(self._memory.face(pressed), 0, 1))


def write_sheet(path: Path, table: SheetTable) -> Path:
    """Write a table as JSON, SI units, whole or not at all.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    content = {
        "schema": SCHEMA,
        "synthetic": True,
        "source": table.source,
        "tissue": table.tissue,
        "units": "SI",
        "hole_radius": table.hole_radius,
        "tool_radius": table.tool_radius,
        **{name: np.asarray(getattr(table, name)).tolist() for name in _ARRAYS},
    }
    return write_text(path, json.dumps(content) + "\n")


def read_sheet(name_or_path: str | Path) -> SheetTable:
    """Read a table: a path, or the name of a shipped one (`phantom`).

    Raises
    ------
    InputError
        No such file, or no such table.
    """
    path = Path(name_or_path)
    shipped = Path(str(files("bench_hw.simulated") / "library" / f"{name_or_path}.json"))
    if not path.is_file():
        path = shipped
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        arrays = {name: np.asarray(content[name], dtype=np.float64) for name in _ARRAYS}
        table = SheetTable(
            hole_radius=float(content["hole_radius"]),
            tool_radius=float(content["tool_radius"]),
            source=str(content["source"]),
            tissue=str(content.get("tissue", "")),
            **arrays,
        )
    except OSError:
        known = ", ".join(sorted(each.stem for each in shipped.parent.glob("*.json")))
        problem = f"no such file, and none of that name is shipped; allowed: a path, or {known}"
        raise InputError(f"specimen {str(name_or_path)!r}: {problem}") from None
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: this is no table of a sheet ({error})") from None
    _check(path, table)
    return table


def _check(path: Path, table: SheetTable) -> None:
    shape = (table.depth.size, table.radius.size)
    good = table.depth.ndim == table.radius.ndim == 1 and table.force.shape == table.depth.shape
    good = good and table.outward.shape == table.sunk.shape == shape and min(shape) >= 4
    if not good:
        raise InputError(f"{path}: depth (k,), force (k,), radius (m,), outward and sunk (k, m) do not fit each other")
    finite = all(np.isfinite(getattr(table, name)).all() for name in _ARRAYS)
    if not (finite and (np.diff(table.depth) > 0.0).all() and (np.diff(table.radius) > 0.0).all()):
        raise InputError(f"{path}: values must be finite, depth and radius must increase")
