"""How an effect enters a model: what it may know, and the four places where it may act.

The way of a trial is drive (what the rig imposes) -> body (tissue, layers, contact) -> markers -> observation. An
effect is plain functions for the places where it acts; any number compose, in the order of the catalogue.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmark.physics.description import EffectDescription

if TYPE_CHECKING:
    from fem import Problem
    from wavemodel import WaveLayer

KEPT = 8
"""Delays whose means a record keeps: a fit asks for the same ones over and over."""

Array: TypeAlias = NDArray[np.float64]
Values: TypeAlias = Mapping[str, float]


@dataclass(frozen=True, eq=False)
class TrialContext:
    """What an effect may know of a condition, SI.

    Attributes
    ----------
    tool_radius, thickness, spacing : float
        Of tool and specimen, m; the marker spacing is 0 without markers.
    peak_depth, peak_force : float
        Largest depth that was driven, m, and the base model's force there, N.
    duration : float
        Of the longest trial, s.
    markers : (m, 2) array or None
        Resting positions of the markers by the nominal grid, m.
    hole_radius : float
        Of the support, m; infinite without a hole.
    layers : tuple of wavemodel.WaveLayer
        The specimen from the surface down; empty where it is taken as one layer of `thickness`.
    contact : str
        Of the tool, as in a scenario.
    edge_radius : float
        Of the tool's rounded edge, m: 0 is a sharp flat face, the tool's radius a ball.
    control : str
        What is given, "force" up to `peak_force` or "depth" up to `peak_depth`.
    """

    tool_radius: float
    thickness: float
    peak_depth: float
    peak_force: float
    duration: float
    spacing: float = 0.0
    markers: Array | None = None
    hole_radius: float = math.inf
    layers: tuple[WaveLayer, ...] = ()
    contact: str = "rigid_bonded"
    edge_radius: float = 0.0
    control: Literal["force", "depth"] = "depth"


@dataclass(frozen=True, eq=False)
class DepthRecord:
    """The depths (m,) in m at times (m,) in s of which rows are means, between the times (n + 1,) in s.

    Of the means themselves no depth between them is known, and no slope in them. The first `earlier` rows, and as many
    depths, are of what the record has before the trial.
    """

    time: Array
    depth: Array
    borders: Array
    earlier: int = 0
    _kept: dict[float, Array] = field(default_factory=dict, init=False, repr=False)

    @cached_property
    def interval(self) -> float:
        """Between the times, s, in the median."""
        return float(np.median(np.diff(self.time[self.earlier :])))

    @cached_property
    def own(self) -> DepthRecord:
        """Of the trial itself alone."""
        first = self.earlier
        return DepthRecord(self.time[first:], self.depth[first:], self.borders[first:])

    @cached_property
    def _integral(self) -> Array:
        """(m,) of the depth over time from the first on, m s."""
        steps = 0.5 * (self.depth[1:] + self.depth[:-1]) * np.diff(self.time)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def _until(self, time: Array) -> Array:
        """The integral up to times, of straight lines between the depths; beyond the ends as the last line goes on."""
        at = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, self.time.size - 2)
        slope = (self.depth[at + 1] - self.depth[at]) / (self.time[at + 1] - self.time[at])
        on = time - self.time[at]
        return np.asarray(self._integral[at] + on * (self.depth[at] + 0.5 * slope * on))

    def _means(self, first: Array, last: Array) -> Array:
        """Of the depth between times, m; where they are one, over an interval around it."""
        half = np.where(last <= first, 0.5 * self.interval, 0.0)
        first, last = first - half, last + half
        return np.asarray((self._until(last) - self._until(first)) / (last - first))

    def means(self, late: float) -> Array:
        """(n,) of the depth so many seconds before the rows, m; to be read only."""
        if late not in self._kept:
            if len(self._kept) >= KEPT:
                self._kept.pop(next(iter(self._kept)))
            self._kept[late] = self._means(self.borders[:-1] - late, self.borders[1:] - late)
        return self._kept[late]

    @cached_property
    def given(self) -> Array:
        """(n,) means without delay, m."""
        return self.means(0.0)

    def speeds(self, late: float) -> Array:
        """(n,) of the tool so many seconds before the rows, m/s: from the depths around the borders."""
        first, last = self.borders[:-1] - late, self.borders[1:] - late
        first, last = np.minimum(first, last - self.interval), np.maximum(last, first + self.interval)
        before, after = (self._means(each - self.interval, each + self.interval) for each in (first, last))
        return np.asarray((after - before) / (last - first))


@dataclass(frozen=True, eq=False)
class Motion:
    """What the rig reports: time (n,) s, depth (n,) m, and the acceleration (n,) m/s2 of the tool.

    Where the rows are means, `record` has what they are means of, and the depth is that `late` seconds before them.
    Rows of what happened before the trial come first, and are not read.
    """

    time: Array
    depth: Array
    acceleration: Array
    record: DepthRecord | None = None
    late: float = 0.0

    def before(self, seconds: float) -> Motion:
        """The same so many seconds earlier."""
        late = self.late + seconds
        if self.record is None:
            return replace(self, depth=np.interp(self.time - seconds, self.time, self.depth), late=late)
        change = self.record.means(late) - (self.record.means(self.late) if self.late else self.record.given)
        return replace(self, depth=self.depth + change, late=late)

    @property
    def earlier(self) -> int:
        """Number of rows before the trial."""
        return self.record.earlier if self.record is not None else 0

    @property
    def read(self) -> Motion:
        """The rows of the trial itself."""
        if self.record is None or not self.earlier:
            return self
        rows = slice(self.earlier, None)
        return Motion(self.time[rows], self.depth[rows], self.acceleration[rows], self.record.own, self.late)

    @property
    def speed(self) -> Array:
        """(n,) m/s."""
        if self.record is None:
            return np.gradient(self.depth, self.time)
        return self.record.speeds(self.late)


class BodyResponse(Protocol):
    """The body as a drive effect sees it."""

    def elastic(self, depth: Array) -> Array:
        """(n,) elastic force in N at depths (n,) in m, without memory."""
        ...

    def force(self, depth: Array) -> Array:
        """(n,) force in N of the body with its effects, pressed through depths (n,) in m."""
        ...


@dataclass(frozen=True, eq=False)
class PressHistory:
    """A press worked out: (n,) depth of the tool and of the tissue under it, m, force and elastic force, N."""

    time: Array
    depth: Array
    surface: Array
    force: Array
    elastic: Array
    touching: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class LowerFaceMotion:
    """How the press moves the lower face.

    Attributes
    ----------
    depth : (n,) array
        Of the tissue under the tool, m, which the face follows.
    passed : (n,) array
        Share of the in-plane motion that reaches the markers.
    centre : (x, y)
        Of the tool axis from the grid's nominal centre, m.
    ratio : float
        Tension along x over tension along y.
    dent : ((n,) array, float) or None
        A dent that falls with the logarithm of the radius from an inner radius on: its outward motion times the
        radius, m^2, and that inner radius, m.
    """

    depth: Array
    passed: Array
    centre: tuple[float, float] = (0.0, 0.0)
    ratio: float = 1.0
    dent: tuple[Array, float] | None = None


@dataclass(frozen=True, eq=False)
class Readings:
    """What sensor and camera report.

    Attributes
    ----------
    force : (n,) array
        N.
    markers : (n, m, 2) array or None
        Positions, m.
    sink : (n, m) array or None
        How far the lower face at the markers moved along the press, m.
    """

    force: Array
    markers: Array | None = None
    sink: Array | None = None


class NotInFemError(Exception):
    """The FEM has no such term for this problem; the reason is the message."""


@dataclass(frozen=True)
class Together:
    """What some trials tell of several parameters of an effect, and of none by itself.

    Attributes
    ----------
    words : str
        What it is.
    unit : str
        SI.
    of : (values, context) -> float
        From the parameters and the deepest condition.
    apart : str
        What tells the parameters apart.
    """

    words: str
    unit: str
    of: Callable[[Values, TrialContext], float]
    apart: str


@dataclass(frozen=True)
class FemTerm:
    """How the FEM carries an effect by itself.

    Attributes
    ----------
    names : tuple of str
        The parameters and options that it carries.
    change : (values of those that are given, problem, context) -> problem with the effect, remark
        The remark is what a reader must know of it, "" without. Raises `NotInFemError`.
    elastic : bool
        Whether the press has no memory of it, so that quasi-linear effects may act on top.
    """

    names: tuple[str, ...]
    change: Callable[[Values, Problem, TrialContext], tuple[Problem, str]]
    elastic: bool = True


@dataclass(frozen=True)
class TableTerm:
    """How the finite elements' table of a set-up carries an effect, in place of `body` and `lower_face`.

    Attributes
    ----------
    key : str
        Of the table's `added`.
    amount : str
        The parameter that is the amount of it, SI.
    part : str
        The parameter that is the part of it that the lower face shows.
    """

    key: str
    amount: str
    part: str


@dataclass(frozen=True)
class Effect:
    """An entry of the catalogue; every place is optional.

    Attributes
    ----------
    description : EffectDescription
        What people read of it.
    amplitude : str
        The parameter by which the effect grows from nothing, where a fit scales its start.
    amplitudes : tuple of str
        Further ones that are scaled with it.
    form : tuple of str
        Parameters of the form alone that the plain one does not have: how open they are says nothing of how strong the
        effect is.
    drive : (values, motion, response) -> (n,) depth that the tissue is given, m
    body : (values, context) -> options of `wavemodel.physics.Physics` by their names
    lower_face : (values, face, press, context) -> LowerFaceMotion
    observe : (values, readings, motion, context) -> Readings
    starts : (context) -> starts of a fit, each a value for every parameter
        In place of the starts of the description, where a start goes with the press.
    needs_markers : bool
        Whether it shows in the markers alone.
    remembers : bool
        Whether the way back may be another than the way in, though a fit may find them alike.
    like_delay : bool
        Whether a force that is late by a moment looks like it.
    acts_within : (values, context) -> s
        The time that rows must resolve.
    in_depth : str
        The parameter that is a depth which the record of the depth must resolve.
    seen_by : str
        The parameter by which it shows in markers too, where there are some: what they do not show is another effect.
    together : Together or None
        What trials tell of its parameters where they tell none of them by itself.
    richer : Effect or None
        The same effect with one more term, tried where this one is accepted.
    further_terms_of : str
        Slug of the effect whose further terms it may be where the data do not tell the two apart.
    origin : str or None
        File of an own effect.
    fem : FemTerm or None
        How the FEM carries it by itself.
    in_table : TableTerm or None
        How a table of the finite elements carries it, where that is known.
    native_in_wave : tuple of str
        Parameters and options that the wave of a scenario has in its own equations, not on top of its elastic law.
    """

    description: EffectDescription
    amplitude: str
    drive: Callable[[Values, Motion, BodyResponse], Array] | None = None
    body: Callable[[Values, TrialContext], Mapping[str, Any]] | None = None
    lower_face: Callable[[Values, LowerFaceMotion, PressHistory, TrialContext], LowerFaceMotion] | None = None
    observe: Callable[[Values, Readings, Motion, TrialContext], Readings] | None = None
    starts: Callable[[TrialContext], tuple[dict[str, float], ...]] | None = None
    needs_markers: bool = False
    remembers: bool = False
    like_delay: bool = False
    acts_within: Callable[[Values, TrialContext], float] | None = None
    in_depth: str = ""
    seen_by: str = ""
    together: Together | None = None
    richer: Effect | None = None
    further_terms_of: str = ""
    origin: str | None = None
    amplitudes: tuple[str, ...] = ()
    form: tuple[str, ...] = ()
    fem: FemTerm | None = None
    native_in_wave: tuple[str, ...] = ()
    in_table: TableTerm | None = None

    @property
    def slug(self) -> str:
        """Name in the catalogue."""
        return self.description.slug

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(parameter.name for parameter in self.description.parameters)

    @property
    def forms(self) -> tuple[Effect, ...]:
        """Itself and its richer forms, one term more each."""
        return (self, *(self.richer.forms if self.richer is not None else ()))

    def from_origin(self, path: str) -> Effect:
        """Copy with the file that it came from."""
        return replace(self, origin=path)

    def first_values(self, context: TrialContext) -> tuple[dict[str, float], ...]:
        """Starts of a fit, within the bounds of the description."""
        if self.starts is not None:
            given = self.starts(context)
        else:
            longest = max(len(parameter.start) for parameter in self.description.parameters)
            given = tuple(
                {p.name: p.start[min(turn, len(p.start) - 1)] for p in self.description.parameters}
                for turn in range(longest)
            )
        bounds = {parameter.name: (parameter.low, parameter.high) for parameter in self.description.parameters}
        return tuple({name: float(np.clip(value, *bounds[name])) for name, value in each.items()} for each in given)
