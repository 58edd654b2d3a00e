"""What a measured process does with the product: gated values of a case, and timed pieces that a user waits for.

Both are told by a job, names and absolute paths. A timed piece is set up from it and returns the work that is then
called again and again; set-up is not timed. What only one of them needs it imports itself, since another revision may
not have it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.files import Scenario, load_scenario, load_session
from benchmark.gate.measuring.references import Work
from benchmark.models import ModelResult, PreparedModel, prepare, scenario_drive

if TYPE_CHECKING:
    import fem

MM = 1e3
FAR = 2.0
"""Where the surface is gated besides the axis, in tool radii."""
Job = Mapping[str, Any]
VERTICES = 81
REACH = 4.0
"""A frame is a square of 81 x 81 vertices, four tool radii to each side of the axis."""
FIT_TRIALS = 2


def model_of(job: Mapping[str, Any], scenario: Scenario) -> PreparedModel:
    """Set up the job's `model` ("fem" or "wave") for a scenario; `own` is a user's file or None."""
    if job["own"] is None:
        return prepare(job["model"], scenario)
    from benchmark.models import read_user_file

    return prepare(job["model"], scenario, own=read_user_file(Path(job["own"])))


@dataclass(frozen=True)
class GatedValue:
    """A gated number: name within its case, value, unit, and why there is none where `value` is None."""

    name: str
    value: float | None
    unit: str
    reason: str | None = None
    # no time: begin
    curve: Mapping[str, float | None] | None = None  # the value at each load step, by the words for it
    # no time: end

    def to_dict(self) -> dict[str, Any]:
        """As plain types."""
        return asdict(self)


class SilentListener:
    """A listener that tells nobody."""

    def say(self, text: str) -> None:
        """Say nothing."""

    @contextmanager
    def progress(self, title: str) -> Iterator[Callable[[str, int, int, str], None]]:
        """Yield an `advance` that does nothing."""
        del title
        yield lambda *_: None


def first_of(*places: str) -> Any:
    """What the first of these places has, each `module:name`: another revision may keep it elsewhere.

    Raises
    ------
    ImportError
        None of them has it.
    """
    for place in places:
        module, _, name = place.partition(":")
        try:
            return getattr(import_module(module), name)
        except (ImportError, AttributeError):
            continue
    raise ImportError(f"this revision has none of {', '.join(places)}")


def press_values(case: Mapping[str, Any]) -> list[GatedValue]:
    """Largest deflection of each layer, the surface at two tool radii, and the peak force under depth control."""
    scenario = load_scenario(Path(case["scenario"]), case["set"])
    result = model_of(case, scenario).run(scenario_drive(scenario))
    reason = None if result.failure is None else f"stopped early at {result.failure}"
    values = [
        _value(f"max_deformation_mm.{layer}", MM * deflection, "mm", reason)
        for layer, deflection in zip(result.layers, result.max_deformation(), strict=True)
    ]
    if np.isfinite(result.profile).any():
        values.append(_value("surface_at_2_radii_mm", MM * _far(result, scenario.tool.radius), "mm", reason))
    if scenario.load.control == "depth":
        peak = float(result.force[result.peak_step]) if result.force.size else np.nan
        values.append(_value("peak_force_N", peak, "N", reason))
    # no time: begin
    if reason is None:
        curves = _curves(result, scenario)
        values = [GatedValue(each.name, each.value, each.unit, each.reason, curves.get(each.name)) for each in values]
    # no time: end
    return values


# no time: begin
MOST_STEPS = 200
"""Of longer load histories that many steps are kept in a curve, evenly spaced, the peak's among them."""


def _curves(result: ModelResult, scenario: Scenario) -> dict[str, dict[str, float | None]]:
    """The deflection of each layer over the load steps, under depth control the force as well, by gated value.

    A step is called by its number from 1 and its load; None stands where a curve has no finite number.
    """
    drive = scenario_drive(scenario)
    size, unit = (1.0, "N") if drive.control == "force" else (MM, "mm")
    kept = np.linspace(0, drive.time.size - 1, min(drive.time.size, MOST_STEPS)).round().astype(int)
    kept = np.unique(np.append(kept, result.peak_step))
    words = [f"step {k + 1} ({size * drive.value[k] + 0.0:.6g} {unit})" for k in kept]

    def curve(values: Any) -> dict[str, float | None]:
        return {
            word: float(value) if np.isfinite(value) else None for word, value in zip(words, values[kept], strict=True)
        }

    deflections = zip(result.layers, MM * result.top_deflection.T, strict=True)
    found = {f"max_deformation_mm.{layer}": curve(values) for layer, values in deflections}
    return found if drive.control == "force" else {**found, "peak_force_N": curve(result.force)}


# no time: end
def _far(result: ModelResult, radius: float) -> float:
    return float(np.interp(FAR * radius, result.profile_radii, result.profile[0]))


def fit_values(case: Mapping[str, Any]) -> list[GatedValue]:
    """Pooled stiffness factor, and the medians of contact onset and force zero over the trials of a session."""
    fit_trials = first_of("benchmark.runs.fitted_session:fit_trials", "benchmark.runs.session_run:fit_trials")
    fit = fit_trials(Path(case["session"]), None, {}, SilentListener(), films=False).fit
    return [
        _value("stiffness_factor", fit.stiffness_factor, "", None),
        _value("contact_onset_mm", MM * float(np.median([trial.onset for trial in fit.trials])), "mm", None),
        _value("zero_N", float(np.median([trial.zero for trial in fit.trials])), "N", None),
    ]


def tracking_values(case: Mapping[str, Any]) -> list[GatedValue]:
    """Frames, share of markers missed, and the farthest mean motion of the markers, over the films tracked now."""
    session_films = first_of("benchmark.runs.trials.filming:session_films", "benchmark.runs.films:session_films")
    films = session_films(load_session(Path(case["session"])), SilentListener())
    tracked = [(one, films.films[key]) for one in films.tracked for key in films.films if key[1] == one.trial]
    farthest = [float(np.nanmax(np.nanmean(_moved(film.places), axis=1))) for _, film in tracked]
    missing = None if tracked else "no film of this session is tracked: its markers come as tables"
    return [
        _value("frames", float(sum(one.frames for one, _ in tracked)), "", missing),
        _value("missing_percent", max((one.missing_percent for one, _ in tracked), default=0.0), "", missing),
        _value("farthest_mean_motion_mm", MM * max(farthest, default=0.0), "mm", missing),
    ]


def _moved(places: Any) -> Any:
    """(f, m) m from where markers (f, m, 2) are in the first frame."""
    return np.linalg.norm(places - places[0], axis=2)


def discovery_values(case: Mapping[str, Any]) -> list[GatedValue]:
    """Whether the expected effect is named, how many others are, and the share of the force gap that they close."""
    with_markers = first_of("benchmark.runs.trials.filming:with_markers", "benchmark.runs.films:with_markers")
    discover, settings = (first_of(f"benchmark.discovery:{name}") for name in ("discover", "Settings"))
    session, _ = with_markers(load_session(Path(case["session"])), SilentListener())
    found = discover(session, settings=settings(workers=1))
    said = [effect.slug for effect in found.effects]
    known = case["expected"] in said
    closed = {gap.channel: gap.closed for gap in found.gap}.get("force_z") or 0.0
    return [
        _value("expected_named", float(known), "", None),
        _value("others_named", float(len(said) - known), "", None),
        _value("force_gap_closed", closed, "", None),
    ]


def _value(name: str, value: float, unit: str, reason: str | None) -> GatedValue:
    """A value; none where a run stopped early, since a part of a history is another problem."""
    if reason is None and not np.isfinite(value):
        reason = "it is not a finite number"
    return GatedValue(name, None if reason else float(value), unit, reason)


CASES: Mapping[str, Callable[[Mapping[str, Any]], list[GatedValue]]] = MappingProxyType(
    {
        "fem": press_values,
        "wave": press_values,
        "fit": fit_values,
        "track": tracking_values,
        "discover": discovery_values,
    }
)
"""How the values of a case are found, by its model."""


def run_history(job: Job) -> Work:
    """Follow the scenario's load history with the FEM or the wave model (`model`): all its load steps."""
    scenario = load_scenario(Path(job["scenario"]), job["set"])
    prepared, drive = model_of(job, scenario), scenario_drive(scenario)
    # no time: begin
    if job["own"] is not None:  # in the fingerprint by OWN_ALONE (benchmark.gate.plan)
        from itertools import count

        # Reading the results takes ten times as long as a model of some microseconds, and would hide one twice as slow.
        # Each call has a little more load (other numbers as float32, too): a model that keeps its answers has none.
        loads = (drive.times(1.0 + 2.5e-7 * call) for call in count())
        return lambda: prepared.follow(next(loads))
    # no time: end
    return lambda: prepared.run(drive)


def wave_frame(job: Job) -> Work:
    """One frame of every layer's deflected face for each step of the scenario's load history."""
    import wavemodel

    scenario = load_scenario(Path(job["scenario"]), job["set"])
    layers = [
        wavemodel.WaveLayer(layer.name, layer.thickness, layer.density, layer.youngs_modulus, layer.poisson_ratio)
        for layer in scenario.tissue.layers
    ]
    tool, options = scenario.tool, scenario.wave
    choices: dict[str, Any] = {"window": options.window, "modes": options.modes}
    if hasattr(wavemodel, "WaveDiscretisation"):  # earlier revisions take them one by one
        choices = {"discretisation": wavemodel.WaveDiscretisation(**choices)}
    choices["large_press"] = "linear"  # what earlier revisions are without being told
    wave = wavemodel.LayeredWave(layers, wavemodel.DiscTool(tool.radius, tool.contact), **choices)
    positions = np.linspace(-REACH * tool.radius, REACH * tool.radius, VERTICES)
    surface, drive = wave.surface(positions, positions), scenario_drive(scenario)
    solution = wave.run(drive.control, drive.time, drive.value)
    faces: Any = getattr(solution, "faces", solution)  # in earlier revisions the solution is its own faces
    states = [faces.snapshot(step) for step in range(drive.time.size)]

    def work() -> None:
        for state in states:
            surface.frame(state)

    return work


def fem_assembly(job: Job) -> Work:
    """Residual and tangent of the finite elements, assembled once under a tenth of the scenario's peak load."""
    import fem

    scenario = load_scenario(Path(job["scenario"]), job["set"])
    model = fem.prepare(_problem(scenario))
    system = model.equilibrium.system
    unknowns, pressure = system.rest()
    rest = system.evaluate(unknowns, pressure)
    if rest is None:
        raise ArithmeticError(f"scenario {scenario.name}: the mesh has an element without volume")
    model.equilibrium.factorise(rest)
    loaded = 0.1 * scenario.load.peak * model.equilibrium.solver.solve(model.equilibrium.unit_load[:, None])[:, 0]

    def work() -> None:
        state = system.evaluate(loaded, pressure)
        if state is None:
            raise ArithmeticError(f"scenario {scenario.name}: a tenth of the load turns an element inside out")
        system.tangent(state)

    return work


def _problem(scenario: Scenario) -> fem.Problem:
    """A finite-strain press with neo-Hookean layers, in the solver's terms."""
    import fem

    return fem.Problem(
        layers=tuple(
            fem.Layer(each.name, each.thickness, each.density, fem.NeoHookean(each.youngs_modulus, each.poisson_ratio))
            for each in scenario.tissue.layers
        ),
        tool=fem.Tool(scenario.tool.radius, scenario.tool.contact),
        support=fem.Support(scenario.support.kind),
        kinematics="finite",
        discretisation=fem.Discretisation(scenario.fem.mesh, scenario.fem.radius),
    )


def fit(job: Job) -> Work:
    """Fit two trials of a session with a curve that is given: no finite elements in it."""
    force_curve = first_of("benchmark.response:ForceCurve", "benchmark.fitting:ForceCurve")
    trial_data = first_of("benchmark.identification:TrialData", "benchmark.fitting:TrialData")
    fit_session = first_of("benchmark.identification:fit_session", "benchmark.fitting:fit_session")
    session = load_session(Path(job["session"]))
    depth = np.linspace(0.0, 12e-3, 41)[1:]
    curve = force_curve(depth, 260.0 * depth * (1.0 + (depth / 8e-3) ** 1.5))
    trials = [
        trial_data(trial.name, trial.condition, trial.table.time, trial.table.depth, trial.table.force, curve)
        for trial in session.trials[:FIT_TRIALS]
    ]
    layers = session.specimen.layers
    return lambda: fit_session(trials, layers)


WORKLOADS: Mapping[str, Callable[[Job], Work]] = MappingProxyType(
    {"history": run_history, "wave_frame": wave_frame, "fem_assembly": fem_assembly, "fit": fit}
)
"""The workloads by the names that a gate file calls them."""
