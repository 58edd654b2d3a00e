"""The wave models as a model of the harness."""

from __future__ import annotations

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.coverage import refuse_options, refuse_solid
from benchmark.models.radii import profile_radii
from benchmark.models.result import Drive, ModelResult, OnStep, Reading, StepProgress, UncoveredError, silent
from wavemodel import DiscTool, LayeredWave, NotCoveredError, Prony, WaveError, WaveLayer, WaveSolution

STRAINS = {"linear": "small strain", "corrected": "finite strain of the layers"}


class WaveModel:
    """A scenario's layered wave, set up.

    Raises
    ------
    UncoveredError
        The wave model has no answer to this scenario.
    InputError
        The scenario cannot be used as it stands.
    """

    def __init__(self, scenario: Scenario):
        refuse_options(scenario)
        refuse_solid(scenario)
        if scenario.wave.model != "layered":
            raise UncoveredError(f"the wave model {scenario.wave.model} does not predict a scenario; layered does")
        self._scenario = scenario
        try:
            self._model = _layered(scenario)
        except NotCoveredError as error:
            raise UncoveredError(str(error)) from None
        except WaveError as error:
            raise InputError(f"scenario {scenario.name}: {error}") from None

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history and read everything off it; raises like `follow`."""
        return self.follow(drive, on_step)()

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Reading:
        """Follow a load history: force, depth and every layer's deflection on the axis at each step.

        Raises
        ------
        UncoveredError
            A press beyond the range of a large press.
        """
        try:
            solution = self._model.run(drive.control, drive.time, drive.value)
        except WaveError as error:
            raise UncoveredError(str(error)) from None
        return lambda: self._result(solution, drive, on_step)

    def _result(self, solution: WaveSolution, drive: Drive, on_step: OnStep) -> ModelResult:
        """The solution in the harness's terms, with its profile."""
        peak = int(np.abs(drive.value).argmax())
        radii = profile_radii(self._scenario.tool.radius)
        steps = drive.time.size
        on_step(StepProgress(steps, steps, float(solution.force[peak]), float(solution.depth[peak])))
        return ModelResult(
            model="wave",
            layers=tuple(solution.layer_names),
            time=solution.time,
            force=solution.force,
            depth=solution.depth,
            top_deflection=solution.top_deflection,
            profile_radii=radii,
            profile=solution.profile(peak, radii),
            peak_step=peak,
            unknowns=self._model.unknowns,
            notes={
                "model": f"layered vector wave, {STRAINS[self._scenario.wave.large_press]}, no calibration",
                "window": f"{1e3 * self._model.window:.4g} mm",
                "modes": f"m, n = 1..{self._model.modes}",
            },
            warnings=tuple(solution.warnings),
        )


def _layered(scenario: Scenario) -> LayeredWave:
    """The scenario in the wave model's terms."""
    if scenario.support.kind == "half_space":
        raise UncoveredError("the layered wave needs a base at a finite depth, a half_space has none")
    layers = [
        WaveLayer(layer.name, layer.thickness, layer.density, layer.youngs_modulus, layer.poisson_ratio)
        for layer in scenario.tissue.layers
    ]
    return LayeredWave(
        layers,
        DiscTool(scenario.tool.radius, scenario.tool.contact),
        support=scenario.support.kind,
        window=scenario.wave.window,
        modes=scenario.wave.modes,
        relaxation=_relaxation(scenario),
        large_press=scenario.wave.large_press,
    )


def _relaxation(scenario: Scenario) -> list[Prony | None] | None:
    """A series a layer; None where all layers are elastic."""
    series = [
        Prony(tuple(term.g for term in layer.relaxation), tuple(term.tau for term in layer.relaxation))
        if layer.relaxation
        else None
        for layer in scenario.tissue.layers
    ]
    return series if any(series) else None
