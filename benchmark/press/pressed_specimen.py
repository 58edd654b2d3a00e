"""One tool on one tissue made ready to be pressed by hand: the wave's table, its memory, the finite elements' ramp.

What a model file switches on stands beside the model as it was: another law of force and another memory on the same
faces, as `benchmark.response.model_with_effects` has them on top of the elastic answer.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import nnls

import fem
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.model_file import RepairedModel
from benchmark.models import UncoveredError
from benchmark.models.fem_model import FemModel
from benchmark.models.model_result import Array
from benchmark.models.scenario_effects import refuse_solid
from benchmark.models.solver_layers import wave_layers
from benchmark.models.wave_parts import law_warnings, refuse_fibres, wave_relaxation, wave_tool
from benchmark.models.wave_plate import sheet_pretension, sheet_series
from benchmark.press.radial_table import RadialTable, table_of_body, table_of_levels
from benchmark.response.model_with_effects import SwitchedOn, on_its_base, switched_on
from wavemodel import LayeredWave, NotCoveredError, PlateSettings, PlateWave, Prony, WaveError
from wavemodel.control import Grid, layered_body, sheet_body
from wavemodel.control.pressed_body import radii_of
from wavemodel.integrators.quasi_static import LayerwiseBody
from wavemodel.integrators.viscoelastic import ELASTIC
from wavemodel.physics import Physics, QuasiStaticPress

PATCH = Grid(50e-3, 50e-3, 1e-3)
"""Vertices that a body is prepared for; a table knows none."""
LEVELS = 24
"""Depths that the finite elements follow."""
BEYOND_PEAK = 1.3
"""How much deeper than the scenario's own peak a hand may press, where the model goes so deep."""
SMALL_STRAIN_REACH = 0.4
"""Of the stack's height: how deep a wave of small strain may be pressed."""
UNSTABLE = "from there on the press is not stable, the tissue would fold or wrinkle"
SHEET_REACH = 0.5
"""Of the hole's radius, likewise; what the sheet was compared with finite elements to."""
SMALLEST_TERM = 1e-6
TERMS, SAMPLES, SPREAD = 24, 240, 1.3
"""Of a relaxation that several layers share."""
CARRIED = ("stiffening", "pretension", "floor", "relaxation", "damping")
"""Options of a body that a page follows; the others remember more than a series does."""


@dataclass(frozen=True)
class Memory:
    """Relaxation of the force on a held tool: (J,) shares and times in s, and a retardation time, s."""

    series: Prony = ELASTIC
    retardation: float = 0.0

    def to_dict(self) -> dict[str, object]:
        """As the page holds it."""
        return {
            "strength": list(self.series.strength),
            "time_s": list(self.series.time),
            "retardation_s": self.retardation,
        }


@dataclass(frozen=True, eq=False)
class FemRamp:
    """The finite elements' answer at `LEVELS` depths, and what it took: wall and CPU s, with the set-up apart."""

    table: RadialTable
    unknowns: int
    levels: int
    setup_seconds: float
    wall_seconds: float
    cpu_seconds: float


@dataclass(frozen=True, eq=False)
class PressedSpecimen:
    """What a page needs of one tool on one tissue.

    Attributes
    ----------
    scenario
        The press.
    wave, memory
        The model as it stands.
    fem
        The finite elements' elastic answer; None where they have none.
    after, after_memory, effects
        With the effects of a model file; None and empty without one.
    remarks
        What a reader must know, one sentence each.
    """

    scenario: Scenario
    wave: RadialTable
    memory: Memory
    fem: FemRamp | None
    after: RadialTable | None = None
    after_memory: Memory = Memory()
    effects: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()


def pressed_specimen(scenario: Scenario, repair: RepairedModel | None = None) -> PressedSpecimen:
    """Set both models up and tabulate them.

    Raises
    ------
    InputError
        The wave model has no answer to this scenario that a hand could press.
    """
    if repair is not None:
        scenario = on_its_base(repair, scenario)
    try:
        refuse_solid(scenario)
        wave, memory, remarks = _wave(scenario)
    except (UncoveredError, NotCoveredError, WaveError) as error:
        raise InputError(f"{scenario.name} cannot be pressed by hand: {error}") from None
    ramp, reason = _fem_ramp(scenario, wave)
    plain = PressedSpecimen(scenario, wave, memory, ramp, remarks=(*remarks, *_left_out(scenario), *reason))
    return plain if repair is None else _repaired(plain, repair)


def _wave(scenario: Scenario) -> tuple[RadialTable, Memory, tuple[str, ...]]:
    """The wave's table, memory and remarks; raises `WaveError` or `UncoveredError`."""
    if scenario.support.kind == "half_space":
        raise UncoveredError("the layered wave needs a base at a finite depth, a half_space has none")
    if scenario.support.cylinder:
        raise UncoveredError("a cylinder between plates has no surface to press by hand")
    if scenario.support.kind == "hole":
        return _sheet(scenario)
    wave, remarks = _layered(scenario)
    body = layered_body(wave, PATCH)
    most = min(body.deepest, SMALL_STRAIN_REACH * wave.press.stack.height if wave.law.large is None else np.inf)
    peak = scenario.load.peak
    depth = abs(peak) if scenario.load.control == "depth" else body.depth(min(abs(peak), body.elastic(most)))
    memory = Memory(_series(wave), wave.damping.stiffness_time)
    return table_of_body(body, min(most, BEYOND_PEAK * depth)), memory, remarks


def _layered(scenario: Scenario) -> tuple[LayeredWave, tuple[str, ...]]:
    """The wave at finite strain where the finite elements are and the wave covers it, else of small strain."""

    def wave(large_press: str) -> LayeredWave:
        return LayeredWave(
            wave_layers(scenario.tissue.layers),
            wave_tool(scenario),
            relaxation=wave_relaxation(scenario),
            relaxing="shape",
            pretension=scenario.physics.pretension,
            large_press=large_press,
        )

    wanted = scenario.wave.large_press
    if wanted == "linear" or (wanted == "auto" and scenario.fem.kinematics == "linear"):
        refuse_fibres(scenario, finite=False)
        return wave("linear"), ()
    refuse_fibres(scenario)
    try:
        return wave("corrected"), ()
    except WaveError as error:
        refuse_fibres(scenario, finite=False)
        return wave("linear"), (f"The wave is that of small strain: {error}",)


def _sheet(scenario: Scenario) -> tuple[RadialTable, Memory, tuple[str, ...]]:
    hole = scenario.support.hole_radius
    if hole is None:
        raise UncoveredError("the sheet needs a hole")
    wave = PlateWave(
        wave_layers(scenario.tissue.layers),
        wave_tool(scenario),
        "hole",
        hole,
        PlateSettings(reach=0.1 * hole),
        pretension=sheet_pretension(scenario),
        clamp=scenario.support.clamp,
    )
    layered = wave.tension == "layered"
    refuse_fibres(scenario, finite=layered)
    peak = abs(scenario.load.peak)
    depth = peak if scenario.load.control == "depth" else float(wave.depth_of_force(np.array([peak]))[0])
    table = table_of_body(sheet_body(wave, PATCH, deepest := min(BEYOND_PEAK * depth, SHEET_REACH * hole)), deepest)
    series, left_out = sheet_series(scenario)
    laws = () if layered else law_warnings(scenario)
    patch = "The sheet's patch is as wide as its hole and moves along with the tool."
    return table, Memory(series or ELASTIC), (patch, *map(_sentence, (*left_out, *laws)))


def _sentence(warning: str) -> str:
    return f"{warning[:1].upper()}{warning[1:]}."


def _series(wave: LayeredWave) -> Prony:
    """How the force on a held tool relaxes, as one series; layers that differ give that of the whole stack."""
    body = wave.body
    return relaxation_of(body) if isinstance(body, LayerwiseBody) else wave.relaxation[0]


def relaxation_of(body: LayerwiseBody) -> Prony:
    """A Prony series of the force at a held depth, from the creep of the depth under a held force.

    d = c_0 F + sum c_m y_m with y_m' = r_m (F - y_m): at constant depth the lags obey a linear system whose
    eigenvalues give the force's relaxation exactly (interconversion; R. S. Lakes, Viscoelastic Materials, chapter 2).
    `TERMS` times carry it from there by least squares with positive shares, to about 1e-4.

    Parameters
    ----------
    body
        Its first field answers at once (no Kelvin-Voigt damping).
    """
    first, rest, rate = body.depth[0], body.depth[1:], body.rate
    values, shapes = np.linalg.eig(-np.diag(rate) - np.outer(rate, rest) / first)
    shares = (rest @ shapes) * np.linalg.solve(shapes, rate / first) / -values
    slowest, fastest = -1.0 / values.real.max(), -1.0 / values.real.min()
    seconds = np.geomspace(0.01 * fastest, 20.0 * slowest, SAMPLES)
    lost = np.real((1.0 - np.exp(np.outer(seconds, values))) @ shares)
    times = np.geomspace(fastest / SPREAD, slowest * SPREAD, TERMS)
    share, _ = nnls(-np.expm1(-np.divide.outer(seconds, times)), lost)
    kept = share > SMALLEST_TERM
    return Prony(tuple(share[kept].tolist()), tuple(times[kept].tolist()))


def _left_out(scenario: Scenario) -> tuple[str, ...]:
    """Options of the body that the scenario states and a hand does not feel."""
    given = [name for name, value in dict(scenario.physics).items() if value is not None]
    return tuple(
        f"physics.{name} is left out by the wave here."
        for name in given
        if name not in ("pretension", "friction_coefficient")
    )


def _fem_ramp(scenario: Scenario, wave: RadialTable) -> tuple[FemRamp | None, tuple[str, ...]]:
    """The finite elements pressed to the wave's depth, or None and why."""
    elastic = [layer.model_copy(update={"relaxation": ()}) for layer in scenario.tissue.layers]
    tissue = scenario.tissue.model_copy(update={"layers": tuple(elastic)})
    try:
        return _ramp(scenario.model_copy(update={"tissue": tissue}), wave)
    except (UncoveredError, InputError) as error:
        return None, (f"The finite elements have no answer to compare with: {error}",)


def _ramp(scenario: Scenario, wave: RadialTable) -> tuple[FemRamp, tuple[str, ...]]:
    start = time.perf_counter()
    model = FemModel(scenario, beyond_limits=False).prepared
    ready, busy = time.perf_counter(), time.process_time()
    depth = wave.deepest * np.arange(1, LEVELS + 1) / LEVELS
    solution = model.run(fem.Load("depth", np.arange(1.0, LEVELS + 1), depth))
    seconds = ready - start, time.perf_counter() - ready, time.process_time() - busy
    levels = stable = solution.force.size
    remarks: tuple[str, ...] = ()
    if solution.unstable_from is not None:
        stable = int(np.searchsorted(depth[:levels], solution.unstable_from))
        remarks = (f"The finite elements end at {1e3 * solution.unstable_from:.3g} mm: {UNSTABLE}.",)
    if stable < 3:
        raise UncoveredError("they stop at the first steps of the press")
    radii = radii_of(wave.reach)
    profile = np.nan_to_num(np.stack([solution.profile(step, radii) for step in range(stable)]))
    table = table_of_levels(depth[:stable], profile, solution.force[:stable], wave.reach, wave.tool_radius)
    return FemRamp(table, model.unknowns, levels, *seconds), remarks


def _repaired(plain: PressedSpecimen, repair: RepairedModel) -> PressedSpecimen:
    """The same with the effects of a model file beside it, those that a page follows."""
    switched = switched_on(repair, plain.scenario, "wave")
    followed, remarks = _followed(switched)
    physics = followed.physics
    law = _law(plain.wave, physics)
    series = physics.relaxation or plain.memory.series
    eta = plain.memory.retardation if physics.damping is None else physics.damping.retardation
    return replace(
        plain,
        after=plain.wave.with_force(law),
        after_memory=Memory(series, eta),
        effects=followed.on,
        remarks=(*plain.remarks, *remarks),
    )


def _followed(switched: SwitchedOn) -> tuple[SwitchedOn, Sequence[str]]:
    """The effects that a page can follow, and a sentence for each of the others."""
    kept, remarks = [], [_sentence(warning) for warning in switched.warnings]
    for added in switched.effects:
        options = replace(switched, effects=(added,)).physics
        foreign = [name for name, value in vars(options).items() if value is not None and name not in CARRIED]
        if foreign:
            remarks.append(f"The effect {added[0].slug} is not followed on this page, only by the command run.")
        else:
            kept.append(added)
    return replace(switched, effects=tuple(kept)), remarks


def _law(wave: RadialTable, physics: Physics) -> Array:
    """(N,) elastic force with the options that change it."""
    elastic = Physics(stiffening=physics.stiffening, pretension=physics.pretension, floor=physics.floor)
    press = QuasiStaticPress(lambda depth: np.interp(depth, wave.depth, wave.force), elastic)
    seconds = np.arange(1.0, wave.depth.size + 1.0)
    return press.trace(seconds, wave.depth).elastic
