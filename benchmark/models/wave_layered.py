"""The layered wave for a scenario: linear, or with its large-press correction where that covers the press."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from benchmark.files import Scenario
from benchmark.models.model_result import Drive, Picture, UncoveredError, WaveChoices
from benchmark.models.scenario_effects import wave_physics, wave_slip
from benchmark.models.solver_layers import wave_layers
from benchmark.models.wave_parts import PreparedWave, Solution, refuse_fibres, vertices, wave_relaxation, wave_tool
from wavemodel import LayeredWave, NotCoveredError, WaveDiscretisation, WaveError

MM = 1e3
NEAR = 2.0
"""Times the depth of a peak force by small strain to which finite strain is worked out first."""
FRICTION = (
    "friction acts as while the tool goes in: the way back, on which tissue slides the other way, is that of the way in"
)


def layered_wave(scenario: Scenario) -> PreparedWave:
    """Set up the layered wave.

    With `large_press = "auto"` it follows the finite strain of the layers where the finite elements do, deep where the
    press is, and falls back to small strain, with a warning, where the correction does not cover the tool or the press
    would go through the stack.

    Raises
    ------
    UncoveredError
        For an endless base, or fibres in small strain or in one direction.
    wavemodel.WaveError
        A value or, unless automatic, a press that the model does not take.
    """
    if scenario.support.kind == "half_space":
        raise UncoveredError("the layered wave needs a base at a finite depth, a half_space has none")
    wanted = scenario.wave.large_press
    linear = wanted == "linear" or (wanted == "auto" and scenario.fem.kinematics == "linear")
    refuse_fibres(scenario, finite=not linear)
    if wanted != "auto":
        return _prepared(scenario, wanted)
    if linear:
        return _prepared(scenario, "linear")
    try:
        return _falling_back(scenario, _to_peak(scenario))
    except WaveError as error:
        small = _small_strain(scenario)
        return replace(small, warnings=(*small.warnings, _fell_back(error)))


def _to_peak(scenario: Scenario) -> PreparedWave:
    """The corrected wave, as deep as the peak by small strain needs, as is usual, or deep, whichever first covers it.

    A soft thick block under a small tool takes minutes to its usual depth, and a second to a tenth of that.
    """
    try:
        return _prepared(scenario, "corrected", reach=_near(scenario))
    except NotCoveredError:
        raise
    except WaveError:
        pass
    try:
        return _prepared(scenario, "corrected", reach=np.inf)
    except WaveError:
        return _prepared(scenario, "deep", reach=np.inf)


def _near(scenario: Scenario) -> float:
    """The depth of a load's peak, m; of a force twice what small strain foretells of the relaxed layers."""
    if scenario.load.control == "depth":
        return scenario.load.peak
    lost = max(math.fsum(term.g for term in layer.relaxation) for layer in scenario.tissue.layers)
    try:
        linear = _wave(scenario, "linear", None)
    except WaveError:  # friction, or fibres, which small strain does not have
        return np.inf
    return NEAR * float(linear.law.depth_at(np.array([scenario.load.peak / (1.0 - lost)]))[0])


def _prepared(scenario: Scenario, large_press: str, *, reach: float | None = None) -> PreparedWave:
    """One wave; with a `reach` (m) it must cover the scenario's peak, and is set up no deeper than that."""
    wave = _wave(scenario, large_press, reach if reach is not None and np.isfinite(reach) else None)
    if reach is not None:
        peak = np.array([scenario.load.peak])
        _ = wave.law(peak) if scenario.load.control == "depth" else wave.law.depth_at(peak)
    return PreparedWave(
        follow=lambda drive: wave.run(drive.control, drive.time, drive.value),
        unknowns=wave.unknowns,
        choices=WaveChoices(large_press, wave.window, wave.modes),
        warnings=(FRICTION,) if scenario.tool.contact == "rigid_frictional" else (),
        picture=lambda drive: _picture(wave, scenario.tool.radius, drive),
    )


def _wave(scenario: Scenario, large_press: str, reach: float | None) -> LayeredWave:
    return LayeredWave(
        wave_layers(scenario.tissue.layers),
        wave_tool(scenario),
        discretisation=WaveDiscretisation(window=scenario.wave.window, modes=scenario.wave.modes),
        support=scenario.support.kind,
        relaxation=wave_relaxation(scenario),
        relaxing="shape",
        large_press=large_press,
        pretension=scenario.physics.pretension,
        physics=wave_physics(scenario),
        slip=wave_slip(scenario),
        reach=reach,
    )


def _picture(wave: LayeredWave, tool_radius: float, drive: Drive) -> Picture:
    """What draws the faces at the peak of a load history."""
    positions = vertices(tool_radius, 0.5 * wave.window)
    surface = wave.surface(positions, positions)
    state = wave.run(drive.control, drive.time, drive.value).faces.snapshot(int(np.abs(drive.value).argmax()))
    return lambda: surface.frame(state)


def _falling_back(scenario: Scenario, corrected: PreparedWave) -> PreparedWave:
    """A corrected wave that answers histories beyond its range followed deep, or in small strain, and says so."""

    def follow(drive: Drive) -> Solution:
        try:
            return corrected.follow(drive)
        except WaveError:
            return deeper(drive)

    @cache
    def deep() -> PreparedWave:
        return _prepared(scenario, "deep")

    def deeper(drive: Drive) -> Solution:
        try:
            return deep().follow(drive)
        except WaveError as error:
            solution = _small_strain(scenario).follow(drive)
            return solution.warned(_fell_back(error))

    return replace(corrected, follow=follow)


def _small_strain(scenario: Scenario) -> PreparedWave:
    """What is fallen back to: the linear wave, which knows no bottom, as far as it stays in the stack."""
    refuse_fibres(scenario, finite=False)
    linear, stack = _prepared(scenario, "linear"), scenario.tissue.thickness

    def follow(drive: Drive) -> Solution:
        solution = linear.follow(drive)
        deepest = float(solution.depth.max(initial=0.0))
        if deepest >= stack:
            raise WaveError(
                f"in small strain this load presses {MM * deepest:.3g} mm into a stack of {MM * stack:.3g} mm on a "
                "rigid base, and the layers' finite strain is not followed as far"
            )
        return solution

    return replace(linear, follow=follow)


def _fell_back(error: WaveError) -> str:
    return f"the wave is that of small strain throughout, without the layers' finite strain: {error}"
