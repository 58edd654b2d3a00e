"""Force over depth of one tool on one sheet over a hole, whose tension is its own at every radius.

Equilibria are found by Newton's method along a path of rising loads, as far as a press goes; splines join them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError
from wavemodel.integrators.equilibrium_path import EquilibriumState, RisingCurve, follow, straight_on
from wavemodel.integrators.load_history import Load
from wavemodel.sheet.faces import Faces
from wavemodel.sheet.sheet_runs import SheetHistory

CORRECTIONS = 14
TOLERANCE = 1e-9
"""Of the sheet's thickness: largest correction of a coefficient that counts as none."""
FINEST_STEP = 1.0 / 256.0
CROWDING = 1.5
"""Equilibria crowd at small loads, where the tension sets in."""
CLOSE = 1e-15
"""Of the force, to which a depth is found."""
MARGIN, LARGEST_GROWTH = 1.05, 6.0
"""Of what is prescribed, where it is not what is wanted."""
ROUNDING = 1e-9
"""So little beyond the last equilibrium the curve goes on by itself."""


class SheetBody(Protocol):
    """A sheet whose equilibria are looked for, one load after the other."""

    @property
    def rigid(self) -> bool:
        """Whether the load is the depth of a rigid tool (m), not the force of a pressure (N)."""
        ...

    @property
    def unknowns(self) -> int:
        """Of a state."""
        ...

    @property
    def levels(self) -> int:
        """Equilibria over the depth or force that is asked for: enough for splines right to some 1e-4."""
        ...

    @property
    def first_load(self) -> float:
        """Force of a pressure to begin with, N."""
        ...

    def equilibrium(self, path: Sequence[EquilibriumState], load: float) -> FloatArray | None:
        """State at a load near the last one of a path; None where none is found."""
        ...

    def force(self, state: FloatArray, load: float) -> float:
        """Press in N."""
        ...

    def displacement(self, state: FloatArray, depth: float, radius: FloatArray, force: float) -> FloatArray:
        """(2, L + 1, R) of the faces at radii (R,), m, with the depth of a rigid tool or the force of a pressure."""
        ...


@dataclass(frozen=True)
class PlateBody:
    """The plate theory's sheet as a `SheetBody`.

    Attributes
    ----------
    faces
        Of the sheet at rest.
    """

    faces: Faces
    levels = 20

    @property
    def rigid(self) -> bool:
        """See `SheetBody`."""
        return self.faces.sheet.tool is not None

    @property
    def unknowns(self) -> int:
        """See `SheetBody`."""
        return self.faces.sheet.unknowns

    @property
    def first_load(self) -> float:
        """About one thickness of depth, by the plate's theory."""
        section = self.faces.sheet.section
        return 16.0 * np.pi * section.bending * section.thickness / self.faces.sheet.functions.outer**2

    def force(self, state: FloatArray, load: float) -> float:
        """See `SheetBody`."""
        return -float(state[-1]) if self.rigid else load

    def displacement(self, state: FloatArray, depth: float, radius: FloatArray, force: float) -> FloatArray:
        """See `SheetBody`."""
        return self.faces.displacement(state, depth, radius, force)

    def equilibrium(self, path: Sequence[EquilibriumState], load: float) -> FloatArray | None:
        """Newton's method from straight on; None where it does not converge."""
        sheet = self.faces.sheet
        state: FloatArray = straight_on(path, load)
        depth, force = (load, 0.0) if self.rigid else (0.0, load)
        small = TOLERANCE * sheet.section.thickness
        for _ in range(CORRECTIONS):
            with np.errstate(all="ignore"):
                residual, jacobian = sheet.residual(state, depth, force)
            if not np.isfinite(jacobian).all():
                return None
            scale = 1.0 / np.sqrt(np.abs(jacobian).max(axis=1))
            change = -scale * np.linalg.solve(jacobian * np.outer(scale, scale), residual * scale)
            state = state + change
            if np.abs(change[: sheet.functions.unknowns]).max() < small:
                return state
        return None


@dataclass(frozen=True)
class _ToLoad:
    """A sheet loaded to a target: depth of a rigid tool (m), or force of a pressure (N) (a `Loading`)."""

    body: SheetBody
    target: float

    def next_load(self, path: Sequence[EquilibriumState], step: float) -> float:
        return min(self.target, path[-1].load + step)

    def next_step(self, path: Sequence[EquilibriumState], step: float) -> float:  # noqa: ARG002
        return step

    def reached(self, path: Sequence[EquilibriumState]) -> bool:
        return path[-1].load >= self.target

    def advance(self, path: Sequence[EquilibriumState], load: float) -> EquilibriumState | None:
        state = self.body.equilibrium(path, load)
        return None if state is None else EquilibriumState(load, state)


def sheet_path(body: SheetBody, start: Sequence[EquilibriumState], loads: FloatArray) -> tuple[EquilibriumState, ...]:
    """Equilibria at rising loads (n,), from the last ones of a path on; stops early where none is found."""
    found = list(start)
    for target in loads.tolist():
        step = target - found[-1].load
        *_, last = follow(_ToLoad(body, target), found[-2:], step, FINEST_STEP * step)
        if last.load < target:
            break
        found.append(last)
    return tuple(found)


@dataclass(frozen=True)
class EquilibriumCurve:
    """Cubic splines through m equilibria, the first at rest; a pull is answered like a press turned round.

    Attributes
    ----------
    depth, force
        (m,) in m and N, rising from zero.
    state
        (m, N) unknowns of the sheet.
    axis
        (m, L) deflection of each layer's top face on the axis, m.
    """

    depth: FloatArray
    force: FloatArray
    state: FloatArray
    axis: FloatArray

    @property
    def reach(self) -> tuple[float, float]:
        """Largest depth (m) and force (N)."""
        return float(self.depth[-1]), float(self.force[-1])

    @cached_property
    def _rising(self) -> RisingCurve:
        force = CubicSpline(self.depth, self.force)
        return RisingCurve(self.depth, self.force, force, force.derivative())

    @cached_property
    def _axis(self) -> CubicSpline:
        return CubicSpline(self.depth, self.axis)

    @cached_property
    def _state(self) -> CubicSpline:
        return CubicSpline(self.depth, self.state)

    def force_at(self, depth: FloatArray) -> FloatArray:
        """(n,) in N at depths (n,) in m."""
        return np.asarray(np.sign(depth) * self._rising.value(np.abs(depth)))

    def depth_at(self, force: FloatArray) -> FloatArray:
        """(n,) in m at forces (n,) in N: the inverse of `force_at`."""
        size = np.abs(force)
        return np.asarray(np.sign(force) * self._rising.inverse(size, CLOSE * size))

    def axis_at(self, depth: FloatArray) -> FloatArray:
        """(n, L) deflection of the layers' top faces on the axis, m, at depths (n,) in m."""
        return np.asarray(np.sign(depth)[:, None] * self._axis(np.abs(depth)))

    def state_at(self, depth: float) -> FloatArray:
        """(N,) at a depth in m, not negative."""
        return np.asarray(self._state(depth))


class LocalTension:
    """Statics of a sheet: ready up to a depth, and further where more is wanted.

    Parameters
    ----------
    body
        The sheet, by the plate's theory or in layers.
    reach
        Depth up to which equilibria are found now, m.
    name
        Of the sheet, for messages.

    Raises
    ------
    NotCoveredError
        If the sheet has no equilibrium up to there.
    """

    def __init__(self, body: SheetBody, reach: float, name: str = "this sheet") -> None:
        self._body, self._rigid, self._name = body, body.rigid, name
        self._path: tuple[EquilibriumState, ...] = (EquilibriumState(0.0, np.zeros(body.unknowns)),)
        self._curve = self._loaded(reach if self._rigid else body.first_load)
        self._extend("depth", reach)

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """See `Statics.rest`."""
        self._extend(control, float(np.abs(value).max(initial=0.0)))
        if control == "depth":
            return self._curve.force_at(value), value
        return value, self._curve.depth_at(value)

    def run(self, load: Load) -> SheetHistory:
        """See `Statics.run`."""
        force, depth = self.rest(load.control, load.value)
        return SheetHistory(
            force, depth, self._curve.axis_at(depth), None, lambda step, radii: self.field(float(depth[step]), radii)
        )

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """See `Statics.field`."""
        deep = abs(depth)
        self._extend("depth", deep)
        force = float(self._curve.force_at(np.array([deep]))[0])
        return np.asarray(np.sign(depth) * self._body.displacement(self._curve.state_at(deep), deep, radii, force))

    def _extend(self, control: str, wanted: float) -> None:
        """Find equilibria up to a depth (m) or force (N) that is wanted."""
        while self._curve.reach[control == "force"] < (1.0 - ROUNDING) * wanted:
            given = self._rigid == (control == "depth")
            self._curve = self._loaded(wanted if given else self._beyond(control, wanted))

    def _beyond(self, control: str, wanted: float) -> float:
        """What to prescribe so that the other quantity gets to what is wanted: on by the last power law."""
        depth, force = np.diff(np.log(self._curve.depth[-2:])), np.diff(np.log(self._curve.force[-2:]))
        power = float((depth / force if control == "force" else force / depth)[0])
        growth = (MARGIN * wanted / self._curve.reach[control == "force"]) ** power
        return self._path[-1].load * min(float(growth), LARGEST_GROWTH)

    def _loaded(self, load: float) -> EquilibriumCurve:
        """The curve with equilibria up to a load: depth of a rigid tool (m), or force of a pressure (N).

        Raises
        ------
        NotCoveredError
            If the sheet has no equilibrium up to there.
        """
        last = self._path[-1].load
        if load <= last:
            return self._curve
        count = max(2, int(np.ceil(self._body.levels * (load - last) / load)))
        share = np.linspace(last / load, 1.0, count + 1)[1:]
        if last == 0.0:
            share = share**CROWDING
        path = sheet_path(self._body, self._path, share * load)
        if path[-1].load < load:
            unit, scale, what = ("mm", 1e3, "depth") if self._rigid else ("N", 1.0, "force")
            raise NotCoveredError(
                f"{self._name}: its equilibrium was followed up to a {what} of {path[-1].load * scale:.4g} {unit}, and "
                f"{load * scale:.4g} {unit} are needed"
            )
        self._path = path
        return self._splines()

    def _splines(self) -> EquilibriumCurve:
        state, load = np.stack([one.state for one in self._path]), np.array([one.load for one in self._path])
        given = [(one.load, 0.0) if self._rigid else (0.0, one.load) for one in self._path]
        press = np.array([self._body.force(one.state, one.load) for one in self._path])
        axis = np.stack(
            [
                self._body.displacement(one.state, depth, np.zeros(1), force)[1, :, 0]
                for one, (depth, force) in zip(self._path, given, strict=True)
            ]
        )
        return EquilibriumCurve(load if self._rigid else axis[:, 0], press, state, axis[:, :-1])
