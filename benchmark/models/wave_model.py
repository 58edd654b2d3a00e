"""The wave models as a model of the harness."""

from __future__ import annotations

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.model_result import (
    Drive,
    ModelResult,
    OnStep,
    Picture,
    Reading,
    StepProgress,
    UncoveredError,
    profile_radii,
    silent,
)
from benchmark.models.scenario_effects import SHEAR_LIMIT, keys_on_top, refuse_options, refuse_solid
from benchmark.models.wave_layered import layered_wave
from benchmark.models.wave_parts import PreparedWave, Solution
from benchmark.models.wave_plate import plate_wave
from wavemodel import NotCoveredError, WaveError


class WaveModel:
    """A scenario's wave, set up: the layered one on a base, that of a sheet over a hole.

    Raises
    ------
    UncoveredError
        The wave model has no answer to this scenario.
    InputError
        The scenario cannot be used as it stands.
    """

    def __init__(self, scenario: Scenario):
        refuse_options(scenario, ("pretension", *(() if _is_sheet(scenario) else (SHEAR_LIMIT,)), *keys_on_top()))
        refuse_solid(scenario)
        self._scenario = scenario
        try:
            self._wave = _prepare(scenario)
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
            A press beyond the model's range.
        """
        try:
            solution = self._wave.follow(drive)
        except WaveError as error:
            raise UncoveredError(str(error)) from None
        return lambda: self._result(solution, drive, on_step)

    def picture(self, drive: Drive) -> Picture | None:
        """Make ready to draw the faces at the peak of a load history; None where the wave has no tables for it."""
        try:
            return None if self._wave.picture is None else self._wave.picture(drive)
        except WaveError:
            return None

    def _result(self, solution: Solution, drive: Drive, on_step: OnStep) -> ModelResult:
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
            unknowns=self._wave.unknowns,
            notes=self._wave.choices.notes(),
            choices=self._wave.choices,
            warnings=(*self._wave.warnings, *solution.warnings),
        )


def _prepare(scenario: Scenario) -> PreparedWave:
    """The wave that the scenario asks for; over a hole "layered" is the layered sheet."""
    model = scenario.wave.model
    if scenario.support.cylinder:
        raise UncoveredError(
            "the wave runs in tissue that goes on beside the tool; a cylinder between plates ends there"
        )
    if model == "published":
        raise UncoveredError(
            "the wave model published does not predict a scenario: it returns the depth it is fed; layered and plate do"
        )
    return plate_wave(scenario) if _is_sheet(scenario) else layered_wave(scenario)


def _is_sheet(scenario: Scenario) -> bool:
    return scenario.wave.model == "plate" or scenario.support.kind == "hole"
