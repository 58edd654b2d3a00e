"""The wave of a sheet over a hole for a scenario."""

from __future__ import annotations

import numpy as np

from benchmark.files import Scenario
from benchmark.models.model_result import UncoveredError, WaveChoices
from benchmark.models.scenario_effects import relaxation_warnings, wave_physics
from benchmark.models.solver_layers import wave_layers
from benchmark.models.wave_parts import PreparedWave, law_warnings, refuse_fibres, wave_relaxation, wave_tool
from wavemodel import PlateSettings, PlateWave, Prony, WaveError

FIRST_REACH = 0.1
"""Of the hole's radius: how deep equilibria are looked for before the peak force says how deep they must go."""


def plate_wave(scenario: Scenario) -> PreparedWave:
    """Set up the sheet, with equilibria up to the scenario's peak.

    Raises
    ------
    UncoveredError
        The sheet has no equilibrium under the peak; or fibres under the plate theory or in one direction.
    wavemodel.WaveError
        A value that the model does not take.
    """
    hole, load, options = scenario.support.hole_radius, scenario.load, scenario.wave
    by_depth = load.control == "depth"
    explicit = options.model == "plate"
    series, warnings = sheet_series(scenario)
    wave = PlateWave(
        wave_layers(scenario.tissue.layers),
        wave_tool(scenario),
        scenario.support.kind,
        hole,
        PlateSettings(
            modes=options.modes if explicit else None,
            reach=FIRST_REACH * hole if hole is not None else None,
            tension="local" if explicit else None,
        ),
        pretension=sheet_pretension(scenario),
        relaxation=series,
        physics=wave_physics(scenario),
        clamp=scenario.support.clamp,
    )
    layered = wave.tension == "layered"
    refuse_fibres(scenario, finite=layered)
    peak = np.array([abs(load.peak)])
    try:
        _ = wave.force_of_depth(peak) if by_depth else wave.depth_of_force(peak)
    except WaveError as error:
        raise UncoveredError(str(error)) from None
    return PreparedWave(
        follow=lambda drive: wave.run(drive.control, drive.time, drive.value),
        unknowns=wave.unknowns,
        choices=WaveChoices(None, wave.window, wave.modes, not layered and scenario.tool.contact == "rigid_bonded"),
        warnings=(*warnings, *(() if layered else law_warnings(scenario)), *_tense(scenario), *_ignored(scenario)),
    )


def sheet_pretension(scenario: Scenario) -> float:
    """The tension at rest in N/m: the stress that the scenario states times the whole thickness; 0 without one."""
    return (scenario.physics.pretension or 0.0) * scenario.tissue.thickness


def _tense(scenario: Scenario) -> tuple[str, ...]:
    """Say how far a sheet under tension was off the finite elements."""
    stress = scenario.physics.pretension or 0.0
    if stress <= 0.0:
        return ()
    moduli = [layer.youngs_modulus * layer.thickness for layer in scenario.tissue.layers]
    share = stress * scenario.tissue.thickness / sum(moduli)
    return (
        f"over a hole the wave has its pretension, {100.0 * share:.2g} % of the sheet's modulus, by the plate theory: "
        "on sheets of 0.05 to 0.12 of the hole's radius its force was 0.6 to 2 % below the finite elements' with 3 % "
        "of the modulus, 1.5 to 7 % with 10 % (more the deeper, to a quarter of the radius) and 17 to 22 % with 30 %",
    )


def sheet_series(scenario: Scenario) -> tuple[Prony | None, tuple[str, ...]]:
    """The relaxation that all layers share, or a warning that layers which differ are elastic."""
    series = wave_relaxation(scenario)
    if series is None:
        return None, ()
    if all(one == series[0] for one in series):
        return series[0], ()
    return None, relaxation_warnings(scenario)


def _ignored(scenario: Scenario) -> tuple[str, ...]:
    """Options of the other wave that were given and have no meaning here."""
    options = scenario.wave
    given = [] if options.window is None else ["window"]
    if options.modes is not None and options.model != "plate":
        given.append("modes")
    reason = "over a hole the wave is that of the sheet, whose window is the hole"
    return tuple(f"wave.{name} is left out: {reason}" for name in given)
