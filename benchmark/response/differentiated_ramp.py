"""A ramp of depth of one set-up with its first derivatives by set-up parameters.

`differentiated_ramp` is the one door: identification asks it for the sensitivity of a press, discovery for how a base
may be wrong. A change of kind (another clamp, contact or law) is no derivative: it has a ramp of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.errors import InputError
from benchmark.files import Scenario, Session, Setup, Support, Tissue, Tool
from benchmark.models import Drive, RunFailure, UncoveredError, prepare
from benchmark.models.model_result import LowerFace
from benchmark.response.force_curve import Array
from benchmark.response.ramp import Ramp, depth_ramp, setup_scenario
from benchmark.response.setup_change import changed_setup, natural_change
from fem.errors import NotDifferentiableError

if TYPE_CHECKING:
    from benchmark.models.fem_derivatives import PressDerivative, ScenarioChange

STEPS = 24
"""Load steps of a ramp."""
DIFFERENCE = 0.06
"""Step of a central difference of the finite elements, in natural changes: large, for each ramp has its own mesh."""
WAVE_DIFFERENCE = 0.01
"""The same of the wave, whose answers are smooth: the square of the step times the third derivative is left."""

SMALL = 3e-5
"""Step by which the solver's equations are differentiated, in natural changes: its square, and round-off over it, are
below 1e-6 of a first derivative up to a Poisson ratio of 0.499."""

PHYSICS = "physics."
"""Begin of the keys of what a session states of physical effects."""


@dataclass(frozen=True, eq=False)
class RampDerivative:
    """First derivatives of a ramp by one parameter at fixed depths and radii.

    By its relative change (p d/dp), or by its amount in SI units (d/dp) where `setup_change.is_absolute`.

    Attributes
    ----------
    force : (k,) array
        N, or N over the parameter's unit.
    outward, sunk : (k, q) array or None
        Of the lower face, m (over the parameter's unit).
    second : RampDerivative or None
        Second derivatives (p^2 d2/dp2, or d2/dp2), where asked for and known.
    """

    force: Array
    outward: Array | None = None
    sunk: Array | None = None
    second: RampDerivative | None = None


@dataclass(frozen=True, eq=False)
class DifferentiatedRamp:
    """A press in equal steps of depth, as far as the model followed it.

    Attributes
    ----------
    depth, force : (k,) array
        m and N, from 0 up.
    face : LowerFace or None
        Outward and sunk, (k, q) m over depth (k,) and radius (q,); None on a rigid base.
    by : mapping of key to RampDerivative
        Keys as in `--set` and `benchmark.response.setup_change`.
    failure : RunFailure or None
        Where the model stopped before the depth asked for.
    mesh_error : float or None
        Estimated error of the largest depth's force, a share of it; None where it was not asked for or has no estimate.
    at_edge : (k,) array or None
        The part of that error that goes with the depth, shares of the force; None: none does.
    """

    depth: Array
    force: Array
    face: LowerFace | None = None
    by: Mapping[str, RampDerivative] = field(default_factory=lambda: MappingProxyType({}))
    failure: RunFailure | None = None
    mesh_error: float | None = None
    at_edge: Array | None = None

    @property
    def ramp(self) -> Ramp:
        """The press alone."""
        return Ramp(self.depth, self.force, np.zeros((self.depth.size, 0)), self.face, self.failure)


def differentiated_ramp(
    session: Session,
    tissue: Tissue,
    tool: Tool,
    support: Support,
    depth: float,
    keys: Sequence[str],
    model: Literal["fem", "wave"] = "fem",
    steps: int = STEPS,
    *,
    second: bool = False,
    judge_mesh: bool = False,
) -> DifferentiatedRamp:
    """Press a set-up to a depth and differentiate the press; the layers' relaxation is left out.

    Parameters
    ----------
    session : Session
        Its settings (mesh, physics) hold.
    tissue, tool, support
        The set-up.
    depth : float
        m.
    keys : sequence of str
        Parameters: `LAYER.youngs_modulus`, `LAYER.poisson_ratio`, `LAYER.thickness`, `LAYER.stiffness`,
        `LAYER.hyperelastic.NAME`, `LAYER.fibre.NAME`, `thickness` (all layers), `tool.radius`, `tool.edge_radius`,
        `support.hole_radius`, and `physics.NAME` as the session states it (`physics.pretension`,
        `physics.friction_coefficient`...; by the finite elements' own derivatives only).
    model
        "fem", or "wave" (differences of explicit solutions; it has no failure).
    steps : int
        Load steps.
    second : bool
        Whether second derivatives are wanted.
    judge_mesh : bool
        Whether the error of the mesh is to be estimated (of the finite elements' own derivatives only).

    Raises
    ------
    InputError
        The model does not cover the set-up, or a key points to no number of it.
    """
    setup = (tissue, tool, support)
    if model == "wave":
        from benchmark.response.wave_table import wave_ramp

        levels = np.linspace(0.0, depth, steps + 1)
        return _by_differences(lambda other: wave_ramp(*other, levels), setup, keys, WAVE_DIFFERENCE)
    try:
        return _direct(session, setup, depth, keys, steps, second=second, judge_mesh=judge_mesh)
    except NotDifferentiableError:
        return _by_differences(lambda other: elastic_ramp(session, *other, depth, steps), setup, keys, DIFFERENCE)


def elastic_ramp(session: Session, tissue: Tissue, tool: Tool, support: Support, depth: float, steps: int) -> Ramp:
    """A ramp of the finite elements without the layers' relaxation, over a hole with the lower face.

    Raises
    ------
    InputError
        The finite elements do not cover it.
    """
    try:
        scenario = _elastic(session, (tissue, tool, support))
        model = prepare("fem", scenario, every_field=support.kind == "hole", beyond_limits=False)
        return depth_ramp(model, depth, steps, face=support.kind == "hole")
    except UncoveredError as error:
        raise InputError(f"the finite elements do not cover {session.name}: {error}") from None


def _elastic(session: Session, setup: Setup) -> Scenario:
    tissue, tool, support = setup
    layers = tuple(one.model_copy(update={"relaxation": ()}) for one in tissue.layers)
    return setup_scenario(session, (tissue.model_copy(update={"layers": layers}), tool, support))


def _direct(
    session: Session, setup: Setup, depth: float, keys: Sequence[str], steps: int, *, second: bool, judge_mesh: bool
) -> DifferentiatedRamp:
    """Derivatives by the solver's own, of each step of one ramp."""
    from benchmark.models.fem_derivatives import differentiated_press

    fractions = np.arange(1, steps + 1) / steps
    try:
        press = differentiated_press(
            _elastic(session, setup),
            Drive("depth", fractions, depth * fractions),
            {key: _change(session, setup, key) for key in keys},
            face=setup[2].kind == "hole",
            second=second,
            judge_mesh=judge_mesh,
        )
    except UncoveredError as error:
        raise InputError(f"the finite elements do not cover {session.name}: {error}") from None
    face, depths = press.face, np.append(0.0, press.depth)
    if face is not None:
        face = LowerFace(depths, face.radius, _from_rest(face.outward), _from_rest(face.sunk))
    by = {key: _ramp_derivative(each) for key, each in press.by.items()}
    force, at_edge = np.append(0.0, press.force), np.append(0.0, press.at_edge)
    return DifferentiatedRamp(depths, force, face, by, press.failure, press.mesh_error, at_edge)


def _ramp_derivative(press: PressDerivative) -> RampDerivative:
    """With the state at rest, which nothing changes."""
    second = None if press.second is None else _ramp_derivative(press.second)
    if press.outward is None or press.sunk is None:
        return RampDerivative(np.append(0.0, press.force), second=second)
    return RampDerivative(np.append(0.0, press.force), _from_rest(press.outward), _from_rest(press.sunk), second)


def _from_rest(rows: Array) -> Array:
    return np.vstack([np.zeros((1, rows.shape[1])), rows])


def _change(session: Session, setup: Setup, key: str) -> ScenarioChange:
    """The scenario with a parameter a little smaller and larger."""
    from benchmark.models.fem_derivatives import ScenarioChange

    if key.startswith(PHYSICS):
        told = _elastic(session, setup)
        less, more = (_with_physics(told, key, sign * SMALL) for sign in (-1.0, 1.0))
        return ScenarioChange(less, more, SMALL, SMALL)
    step = SMALL * natural_change(setup[0], key)
    less, more = (_elastic(session, changed_setup(*setup, key, sign * step)) for sign in (-1.0, 1.0))
    return ScenarioChange(less, more, step, step)


def _with_physics(scenario: Scenario, key: str, share: float) -> Scenario:
    """The scenario with what the session states of a physical effect times 1 + share."""
    name = key.removeprefix(PHYSICS)
    value = getattr(scenario.physics, name, None)
    if not isinstance(value, float) or value == 0.0:
        raise InputError(f"{key}: this session states no such number above zero to change")
    physics = scenario.physics.model_copy(update={name: value * (1.0 + share)})
    return scenario.model_copy(update={"physics": physics})


def _by_differences(
    ramp_of: Callable[[Setup], Ramp], setup: Setup, keys: Sequence[str], share: float
) -> DifferentiatedRamp:
    """Derivatives by central differences of two more ramps a parameter, to the depth that all of them reach."""
    told = ramp_of(setup)
    steps = {key: share * natural_change(setup[0], key) for key in keys}
    pairs = {
        key: tuple(ramp_of(changed_setup(*setup, key, sign * step)) for sign in (-1.0, 1.0))
        for key, step in steps.items()
    }
    ramps = [told, *(ramp for pair in pairs.values() for ramp in pair)]
    worst = min(ramps, key=lambda ramp: float(ramp.depth[-1]))
    reached = told.depth <= worst.depth[-1] * (1.0 + 1e-9)
    depth, face = told.depth[reached], told.face
    if face is not None:
        face = LowerFace(face.depth[reached], face.radius, face.outward[reached], face.sunk[reached])
    by = {key: _difference(pair[0], pair[1], depth, face, 2.0 * steps[key]) for key, pair in pairs.items()}
    return DifferentiatedRamp(depth, told.force[reached], face, by, worst.failure)


def _difference(less: Ramp, more: Ramp, depth: Array, face: LowerFace | None, width: float) -> RampDerivative:
    force = (CubicSpline(more.depth, more.force)(depth) - CubicSpline(less.depth, less.force)(depth)) / width
    if face is None or less.face is None or more.face is None:
        return RampDerivative(np.asarray(force))
    both = [(each, face.radius, depth) for each in (less.face, more.face)]
    outward = [at_places(one, one.outward, radius, levels) for one, radius, levels in both]
    sunk = [at_places(one, one.sunk, radius, levels) for one, radius, levels in both]
    return RampDerivative(np.asarray(force), (outward[1] - outward[0]) / width, (sunk[1] - sunk[0]) / width)


def at_places(face: LowerFace, table: Array, radius: Array, levels: Array) -> Array:
    """A table (k, m) of a lower face at other depths (levels,) and radii (q,), m."""
    over_depth = CubicSpline(face.depth, table)(levels)
    return np.asarray(CubicSpline(face.radius, over_depth, axis=1)(np.clip(radius, 0.0, face.radius[-1])))
