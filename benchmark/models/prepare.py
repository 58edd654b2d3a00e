"""From a scenario to a model that is ready to run, what its picture costs, and the wave of small strain beside it."""

from __future__ import annotations

import statistics
import time
from typing import Protocol, runtime_checkable

from benchmark.files import Scenario
from benchmark.models.model_result import Array, Drive, Keeping, ModelResult, Picture, PreparedModel, WaveChoices
from benchmark.models.user_file import UserFile

FRAMES = 50
"""Pictures that are timed."""


@runtime_checkable
class Pictured(Protocol):
    """A model that can draw its faces again and again from tables made beforehand."""

    def picture(self, drive: Drive) -> Picture | None:
        """Make ready to draw the faces at the peak of a load history; None where the model in use cannot."""
        ...


def prepare(
    model: str,
    scenario: Scenario,
    *,
    every_field: bool = False,
    own: UserFile | None = None,
    keeping: Keeping | None = None,
    judge_mesh: bool = False,
    beyond_limits: bool = True,
) -> PreparedModel:
    """Set a model up for a scenario.

    Parameters
    ----------
    model
        `"fem"` or `"wave"`.
    scenario
        Resolved scenario.
    every_field
        Keep the fields of each step instead of the peak's and the last one's (FEM).
    own
        A user's own model in the wave's place.
    keeping
        Where the steps of the load history are kept (FEM); None keeps nothing.
    judge_mesh
        Whether the result tells the discretisation error of its mesh (FEM), which takes further solutions.
    beyond_limits
        Whether a press goes on over limit points, where its curve jumps (FEM).

    Raises
    ------
    UncoveredError
        The model has no answer to this scenario.
    InputError
        The scenario is at fault.
    """
    if model == "fem":
        from benchmark.models.fem_model import FemModel

        return FemModel(
            scenario, every_field=every_field, keeping=keeping, judge_mesh=judge_mesh, beyond_limits=beyond_limits
        )
    if own is not None:
        from benchmark.models.user_model import UserModel

        return UserModel(scenario, own)
    from benchmark.models.wave_model import WaveModel

    return WaveModel(scenario)


def scenario_drive(scenario: Scenario) -> Drive:
    """Return the scenario's load history."""
    history = scenario.load_history()
    return Drive(scenario.load.control, history.time, history.value)


def frame_seconds(prepared: PreparedModel, drive: Drive) -> float | None:
    """Median wall s of a picture at the peak of a load history, tables made before; None of a model without one."""
    picture = prepared.picture(drive) if isinstance(prepared, Pictured) else None
    return None if picture is None else statistics.median(_seconds(picture) for _ in range(FRAMES))


def _seconds(picture: Picture) -> float:
    started = time.perf_counter()
    picture()
    return time.perf_counter() - started


def in_small_strain(scenario: Scenario) -> Scenario:
    """The scenario with the wave of small strain."""
    return scenario.model_copy(update={"wave": scenario.wave.model_copy(update={"large_press": "linear"})})


def took_finite_strain(scenario: Scenario, wave: ModelResult) -> bool:
    """Whether `large_press = "auto"` gave a wave the layers' finite strain."""
    choices = wave.choices
    strain = choices.strain if isinstance(choices, WaveChoices) else None
    return scenario.wave.large_press == "auto" and strain in ("corrected", "deep")


def small_strain_deflection(scenario: Scenario, drive: Drive) -> Array:
    """(n, L) m: each layer's deflection on the axis by the wave of small strain."""
    return prepare("wave", in_small_strain(scenario)).run(drive).top_deflection
