"""The sheet's equilibrium from rest to a load: Newton's method along a path whose steps halve where it fails."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.load_history import Load
from wavemodel.sheet.faces import Faces, Indentation, indentation
from wavemodel.sheet.sheet import Sheet
from wavemodel.sheet.sheet_runs import PlateHistory
from wavemodel.specimen import DiscTool, WaveLayer

CORRECTIONS = 14
TOLERANCE = 1e-9
"""Of the sheet's thickness: largest correction of a coefficient that counts as none."""
FINEST_STEP = 1.0 / 256.0


@dataclass(frozen=True)
class Equilibrium:
    """One state at rest.

    Attributes
    ----------
    load
        What is prescribed: depth of a rigid tool (m), or force of a pressure (N).
    state
        Unknowns of the sheet.
    """

    load: float
    state: FloatArray


def follow(sheet: Sheet, start: tuple[Equilibrium, ...], loads: FloatArray) -> tuple[Equilibrium, ...]:
    """Equilibria at rising loads, from the last ones of a path on; stops early where none is found.

    Parameters
    ----------
    sheet
        The sheet.
    start
        What is known, at least the state at rest.
    loads
        (n,) above the last of `start`.
    """
    found = list(start)
    for target in loads.tolist():
        step = target - found[-1].load
        finest = FINEST_STEP * step
        trail = found[-2:]
        while trail[-1].load < target:
            load = min(target, trail[-1].load + step)
            state = _solve(sheet, load, _predict(trail, load))
            if state is not None:
                trail = [trail[-1], Equilibrium(load, state)]
            elif step <= finest:
                return tuple(found)
            else:
                step *= 0.5
        found.append(trail[-1])
    return tuple(found)


def _predict(trail: list[Equilibrium], load: float) -> FloatArray:
    """Straight on through the last two states."""
    last = trail[-1]
    if len(trail) == 1 or trail[0].load == last.load:
        return last.state
    share = (load - last.load) / (last.load - trail[0].load)
    return last.state + share * (last.state - trail[0].state)


def _solve(sheet: Sheet, load: float, state: FloatArray) -> FloatArray | None:
    """Newton's method; None where it does not converge."""
    depth, force = (load, 0.0) if sheet.tool is not None else (0.0, load)
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


INVERSIONS = 6


@dataclass(frozen=True)
class Curve:
    """Cubic splines through m equilibria, the first at rest.

    A pull is answered like a press turned round.

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
    def _force(self) -> CubicSpline:
        return CubicSpline(self.depth, self.force)

    @cached_property
    def _slope(self) -> CubicSpline:
        return self._force.derivative()

    @cached_property
    def _axis(self) -> CubicSpline:
        return CubicSpline(self.depth, self.axis)

    @cached_property
    def _state(self) -> CubicSpline:
        return CubicSpline(self.depth, self.state)

    def force_at(self, depth: FloatArray) -> FloatArray:
        """(n,) in N at depths (n,) in m."""
        return np.asarray(np.sign(depth) * self._force(np.abs(depth)))

    def depth_at(self, force: FloatArray) -> FloatArray:
        """(n,) in m at forces (n,) in N: the inverse of `force_at`."""
        size = np.abs(force)
        depth = np.interp(size, self.force, self.depth)
        for _ in range(INVERSIONS):
            depth = depth - (self._force(depth) - size) / self._slope(depth)
        return np.asarray(np.sign(force) * depth)

    def axis_at(self, depth: FloatArray) -> FloatArray:
        """(n, L) deflection of the layers' top faces on the axis, m, at depths (n,) in m."""
        return np.asarray(np.sign(depth)[:, None] * self._axis(np.abs(depth)))

    def state_at(self, depth: float) -> FloatArray:
        """(N,) at a depth in m, not negative."""
        return np.asarray(self._state(depth))


STEPS = 20
CROWDING = 1.5
"""Equilibria over the depth or force that is asked for; the splines between them are right to 1e-4.
They crowd at small loads, where the tension sets in."""


@dataclass(frozen=True)
class PlateLaw:
    """Statics of a sheet.

    Attributes
    ----------
    sheet
        The sheet and its tool.
    faces
        Synthesis of the faces' displacement.
    dent
        What a pressure adds at the surface; None under a rigid tool.
    path
        The equilibria found, from rest on.
    """

    sheet: Sheet
    faces: Faces
    dent: Indentation | None
    path: tuple[Equilibrium, ...]

    def extended(self, load: float) -> "PlateLaw":
        """The same with equilibria up to a load: depth of a rigid tool (m), or force of a pressure (N).

        Raises
        ------
        WaveError
            If the sheet has no equilibrium up to there.
        """
        last = self.path[-1].load
        if load <= last:
            return self
        count = max(2, int(np.ceil(STEPS * (load - last) / load)))
        share = np.linspace(last / load, 1.0, count + 1)[1:]
        if last == 0.0:
            share = share**CROWDING
        found = follow(self.sheet, self.path, share * load)
        if found[-1].load < load:
            unit, scale = ("mm", 1e3) if self.sheet.tool is not None else ("N", 1.0)
            raise WaveError(
                f"load = {load * scale:.4g} {unit} is not allowed: this sheet's equilibrium was followed up to "
                f"{found[-1].load * scale:.4g} {unit}"
            )
        return replace(self, path=found)

    def curve(self) -> Curve:
        """Splines through the equilibria."""
        state = np.stack([point.state for point in self.path])
        load = np.array([point.load for point in self.path])
        rigid = self.sheet.tool is not None
        prescribed = [(point.load, 0.0) if rigid else (0.0, point.load) for point in self.path]
        axis = np.stack(
            [
                self.displacement(point.state, *given, np.zeros(1))[1, :, 0]
                for point, given in zip(self.path, prescribed, strict=True)
            ]
        )
        depth, force = (load, -state[:, -1]) if rigid else (axis[:, 0], load)
        return Curve(depth, force, state, axis[:, :-1])

    def displacement(self, state: FloatArray, depth: float, force: float, radius: FloatArray) -> FloatArray:
        """(2, L + 1, R): outwards and downwards, m, of the faces at radii up to the hole's edge."""
        out = self.faces.displacement(state, depth, radius)
        if self.dent is not None:
            out[1] += force * (self._axis_dent if not radius.any() else self.dent.deflection(radius))
        return out

    @cached_property
    def _axis_dent(self) -> FloatArray:
        return np.zeros((1, 1)) if self.dent is None else self.dent.deflection(np.zeros(1))


def plate_law(layers: Sequence[WaveLayer], tool: DiscTool, sheet: Sheet) -> PlateLaw:
    """The law at rest; `extended` finds equilibria."""
    faces = Faces(sheet)
    dent = None if tool.rigid else indentation(layers, sheet.section, faces.bulge, tool.radius)
    return PlateLaw(sheet, faces, dent, (Equilibrium(0.0, np.zeros(sheet.unknowns)),))


MARGIN, LARGEST_GROWTH = 1.05, 6.0
"""Of what is prescribed, where it is not what is wanted."""
ROUNDING = 1e-9
"""So little beyond the last equilibrium the curve goes on by itself."""


class PreparedLaw:
    """Statics of a sheet under a press.

    Parameters
    ----------
    law
        At rest.
    reach
        Depth up to which equilibria are found now, m.

    Raises
    ------
    WaveError
        If the sheet has no equilibrium up to there.
    """

    def __init__(self, law: PlateLaw, reach: float) -> None:
        across, self._rigid = law.sheet.section, law.sheet.tool is not None
        # Under a pressure the force is prescribed: begin with about one thickness of depth, by the plate's theory.
        linear = 16.0 * np.pi * across.bending * across.thickness / law.sheet.functions.outer**2
        self._law = law.extended(reach if self._rigid else linear)
        self._curve: Curve = self._law.curve()
        self._extend("depth", reach)

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force (n,) in N and depth (n,) in m where one of them, "force" or "depth", is given."""
        self._extend(control, float(np.abs(value).max(initial=0.0)))
        if control == "depth":
            return self._curve.force_at(value), value
        return value, self._curve.depth_at(value)

    def run(self, load: Load) -> PlateHistory:
        """Equilibria at the instants of a load history."""
        force, depth = self.rest(load.control, load.value)
        return PlateHistory(
            force, depth, self._curve.axis_at(depth), None, lambda step, radii: self.field(float(depth[step]), radii)
        )

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """(2, L + 1, m): outward and downward displacement of the faces at radii (m,), m."""
        deep = abs(depth)
        self._extend("depth", deep)
        force = float(self._curve.force_at(np.array([deep]))[0])
        moved = self._law.displacement(self._curve.state_at(deep), deep, force, radii)
        return np.asarray(np.sign(depth) * moved)

    def _extend(self, control: str, wanted: float) -> None:
        """Find equilibria up to a depth (m) or force (N) that is wanted."""
        while self._curve.reach[control == "force"] < (1.0 - ROUNDING) * wanted:
            given = self._rigid == (control == "depth")
            self._law = self._law.extended(wanted if given else self._beyond(control, wanted))
            self._curve = self._law.curve()

    def _beyond(self, control: str, wanted: float) -> float:
        """What to prescribe so that the other quantity gets to what is wanted: on by the last power law."""
        depth, force = np.diff(np.log(self._curve.depth[-2:])), np.diff(np.log(self._curve.force[-2:]))
        power = float((depth / force if control == "force" else force / depth)[0])
        growth = (MARGIN * wanted / self._curve.reach[control == "force"]) ** power
        return self._law.path[-1].load * min(float(growth), LARGEST_GROWTH)
