"""A user's model on a scenario: what its functions are given, and what they return, checked, as a result.

They get plain values in SI units; nothing of this program is needed to read them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from benchmark.files import Scenario
from benchmark.models.model_result import (
    Array,
    Drive,
    ModelResult,
    OnStep,
    Reading,
    StepProgress,
    UncoveredError,
    profile_radii,
    silent,
    slips,
)
from benchmark.models.user_file import UserCode, UserFile


@dataclass(frozen=True)
class UserLayer:
    """One layer.

    Attributes
    ----------
    name : str
    thickness : float
        m; infinite for the last layer of a half-space.
    density : float
        kg/m^3.
    youngs_modulus : float
        Initial Young's modulus, Pa.
    poisson_ratio : float
    relaxation : tuple of (g, tau)
        Fading fractions of the stiffness with their time constants in s; empty for an elastic layer.
    hyperelastic : mapping
        The law of finite strain as in a tissue file, `law` and its parameters in SI units; a neo-Hookean law without
        `c10` follows the moduli.
    """

    name: str
    thickness: float
    density: float
    youngs_modulus: float
    poisson_ratio: float
    relaxation: tuple[tuple[float, float], ...]
    hyperelastic: Mapping[str, Any] = field(default_factory=lambda: {"law": "neo_hookean"})


@dataclass(frozen=True)
class UserTool:
    """A round flat tool: `radius` in m, `contact` as in a scenario, `edge_radius` in m or None for a sharp edge."""

    radius: float
    contact: str
    edge_radius: float | None


@dataclass(frozen=True)
class UserSupport:
    """What holds the lower face: `kind`, of a hole `hole_radius`, of a cylinder between plates its radius, in m.

    Kinds are bonded, hole, half_space, plates and grips; grips pull, and force and depth count the pull as positive.
    """

    kind: str
    hole_radius: float | None
    specimen_radius: float | None = None


FRICTION = "friction_coefficient"
"""Belongs to a rigid_frictional tool; the contact's name says that there is friction."""

Specimen = tuple[tuple[UserLayer, ...], UserTool, UserSupport]


def specimen_of(scenario: Scenario) -> Specimen:
    """Layers from the surface down, tool and support of a scenario.

    Raises
    ------
    UncoveredError
        The scenario has an option of the body, a tilted tool or fibres, which the functions are not told of.
    """
    options = [name for name, value in dict(scenario.physics).items() if value is not None and name != FRICTION]
    untold = [f"physics.{name}" for name in options]
    untold += ["tool.tilt"] if scenario.tool.tilt != 0.0 else []
    untold += [f"the fibres of {layer.name}" for layer in scenario.tissue.layers if layer.fibre is not None]
    if untold:
        raise UncoveredError(f"a user's model is not told of {', '.join(untold)}")
    layers = tuple(
        UserLayer(
            name=layer.name,
            thickness=layer.thickness,
            density=layer.density,
            youngs_modulus=layer.youngs_modulus,
            poisson_ratio=layer.poisson_ratio,
            relaxation=tuple((term.g, term.tau) for term in layer.relaxation),
            hyperelastic=layer.hyperelastic.model_dump(exclude_none=True),
        )
        for layer in scenario.tissue.layers
    )
    tool, support = scenario.tool, scenario.support
    hole = support.hole_radius if support.kind == "hole" else None
    return (
        layers,
        UserTool(tool.radius, tool.contact, tool.edge_radius),
        UserSupport(support.kind, hole, support.specimen_radius),
    )


DEFORM, SET_UP, PROFILE, PRESS = "deform", "set_up", "profile", "press"
UNITS = {DEFORM: "m", PROFILE: "m", PRESS: "N"}
"""Of what the functions return."""
SPECIMEN = ("layers", "tool", "support")
GIVEN = {
    SET_UP: SPECIMEN,
    DEFORM: (*SPECIMEN, "time", "force"),
    PROFILE: (*SPECIMEN, "time", "force", "radii"),
    PRESS: (*SPECIMEN, "time", "depth"),
}
"""What the functions are given, by place."""
OFF_THE_AXIS = 0.1
"""How far a profile at its centre may be from the deflection on the axis, of it; a slip of unit or load is more."""


class UserModel:
    """A user's file on a scenario.

    Raises
    ------
    UncoveredError
        The scenario has what the functions are not told of, is under depth control without a `press`, or the file
        raises `NotImplementedError`.
    InputError
        The file raises anything else, has no `deform`, names arguments in another order, or returns what cannot be
        used: file, line and what is wrong.
    """

    def __init__(self, scenario: Scenario, file: UserFile):
        self._scenario, self._file = scenario, file
        self._specimen = specimen_of(scenario)
        self._code = UserCode(file)
        if not self._code.has(DEFORM):
            raise self._code.fault(
                DEFORM, f"there is no such function; needed: {DEFORM}(layers, tool, support, time, force)"
            )
        self._check_arguments()
        if scenario.load.control == "depth" and not self._code.has(PRESS):
            raise UncoveredError(f"the load is a depth and {file.path} has no function {PRESS}")
        prepared = self._code.has(SET_UP)
        self._keywords = {"prepared": self._code.call(SET_UP, *self._specimen)} if prepared else {}

    def _check_arguments(self) -> None:
        """Refuse names of arguments at another one's place: `force, time` would be taken for times and forces."""
        known = {name for names in GIVEN.values() for name in names}
        for function, given in GIVEN.items():
            named = self._code.arguments(function)
            if any(name in known and name != place for name, place in zip(named, given, strict=False)):
                raise self._code.fault(
                    function, f"its arguments are {', '.join(named)}; they are given by place: {', '.join(given)}"
                )

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history and read everything off it."""
        return self.follow(drive, on_step)()

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Reading:
        """Follow a load history: what `deform`, and `press` under depth control, take."""
        steps, layers = drive.time.size, len(self._specimen[0])
        force = drive.value
        if drive.control == "depth":
            force = self._array(PRESS, (steps,), drive.time, drive.value)
        top = self._array(DEFORM, (steps, layers), drive.time, force)
        return lambda: self._result(drive, on_step, force, top)

    def _result(self, drive: Drive, on_step: OnStep, force: Array, top: Array) -> ModelResult:
        """What the functions returned in the harness's terms, with the profile."""
        steps, names = drive.time.size, self._scenario.tissue.layer_names
        depth = drive.value if drive.control == "depth" else top[:, 0]
        peak = int(np.abs(drive.value).argmax())
        radii = profile_radii(self._scenario.tool.radius)
        profile = self._profile(drive.time[: peak + 1], force[: peak + 1], radii)
        on_step(StepProgress(steps, steps, float(force[peak]), float(depth[peak])))
        return ModelResult(
            model="wave",
            layers=names,
            time=drive.time,
            force=force,
            depth=depth,
            top_deflection=top,
            profile_radii=radii,
            profile=profile,
            peak_step=peak,
            unknowns=None,
            notes={"model": f"the user's own, {self._file.path}", "SHA-256 of the file": self._file.fingerprint},
            warnings=(*self._warnings(force, top), *_not_its_own(profile[:, 0], top[peak], names)),
        )

    def _profile(self, time: Array, force: Array, radii: Array) -> Array:
        """(L, m) m; NaN without a function for it."""
        shape = (len(self._scenario.tissue.layers), radii.size)
        if not self._code.has(PROFILE):
            return np.full(shape, np.nan)
        return self._array(PROFILE, shape, time, force, radii, may_be_nan=True)

    def _array(self, function: str, shape: tuple[int, ...], *arguments: Array, may_be_nan: bool = False) -> Array:
        """What a function returns, checked: numbers of this shape, finite."""
        copies = [argument.copy() for argument in arguments]
        given = self._code.call(function, *self._specimen, *copies, **self._keywords)
        self._check_columns(function, given)
        found = _numbers(given)
        if found is None or found.shape != shape:
            what = _no_numbers(given) if found is None else f"an array of shape {found.shape}"
            axes = {1: "one number a step", 2: "one row a step and one column a layer"}[len(shape)]
            axes = "one row a layer and one column a radius" if function == PROFILE else axes
            raise self._code.fault(
                function, f"it returned {what}; allowed: real numbers of shape {shape}, {axes}, in {UNITS[function]}"
            )
        bad = np.isinf(found) if may_be_nan else ~np.isfinite(found)
        if bad.any():
            place = np.argwhere(bad)[0]
            index = ", ".join(str(each) for each in place)
            raise self._code.fault(
                function, f"it returned {found[tuple(place)]} at [{index}]; allowed: finite numbers in SI units"
            )
        return found

    def _check_columns(self, function: str, given: Any) -> None:
        """Refuse a data frame whose columns are the layers in another order; they are taken by their place."""
        columns = list(getattr(given, "columns", ()))
        if not columns or function != DEFORM:
            return
        names = self._scenario.tissue.layer_names
        if set(columns) == set(names) and columns != list(names):
            raise self._code.fault(
                function, f"its columns are {', '.join(columns)}; allowed: the layers downwards, {', '.join(names)}"
            )

    def _warnings(self, force: Array, top: Array) -> tuple[str, ...]:
        """What a reader must know, and what looks like a slip of sign or unit."""
        said = []
        if not self._code.has(PROFILE):
            said.append(f"no profile: {self._file.path} has no function {PROFILE}, those columns are empty")
        return (*said, *slips(force, top, self._scenario.tissue.thickness, "deflections are in m"))


def _not_its_own(centre: Array, top: Array, names: Sequence[str]) -> tuple[str, ...]:
    """That a profile at its centre (L,) m is not the deflection (L,) m on the axis at the same load."""
    apart = np.abs(centre - top) - OFF_THE_AXIS * np.abs(top)
    if not (apart > 0.0).any():
        return ()
    worst = int(np.nanargmax(apart))
    return (
        f"its {PROFILE} of {names[worst]} is {1e3 * centre[worst]:.4g} mm on the axis, where its {DEFORM} is "
        f"{1e3 * top[worst]:.4g} mm at the same load; both are in m, the profile at the end of the history it is given",
    )


def _no_numbers(given: Any) -> str:
    """What was returned that is no array of real numbers, in words."""
    try:
        if np.iscomplexobj(np.asarray(given)):
            return "complex numbers"
    except Exception as error:
        return f"a {type(given).__name__} that NumPy cannot read ({type(error).__name__}: {error})"
    return f"a {type(given).__name__} without numbers"


def _numbers(given: Any) -> Array | None:
    """What was returned as an array of doubles of its own, masked values as NaN; None where it is no real numbers.

    Arrays of other libraries, on a graphics card or with gradients, refuse by exceptions of their own.
    """
    try:
        array = np.asanyarray(given)
    except Exception:
        return None
    if array.dtype.kind not in "iuf":
        return None
    return np.array(np.ma.filled(array.astype(np.float64), np.nan))
