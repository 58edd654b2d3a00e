"""From a scenario to a model that is ready to run, and to the wave of small strain beside one of finite strain."""

from __future__ import annotations

from benchmark.files import Scenario
from benchmark.models.model_result import Array, Drive, Keeping, ModelResult, PreparedModel, WaveChoices
from benchmark.models.user_file import UserFile


def prepare(
    model: str,
    scenario: Scenario,
    *,
    every_field: bool = False,
    own: UserFile | None = None,
    keeping: Keeping | None = None,
    judge_mesh: bool = False,
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

    Raises
    ------
    UncoveredError
        The model has no answer to this scenario.
    InputError
        The scenario is at fault.
    """
    if model == "fem":
        from benchmark.models.fem_model import FemModel

        return FemModel(scenario, every_field=every_field, keeping=keeping, judge_mesh=judge_mesh)
    if own is not None:
        from benchmark.models.user_model import UserModel

        return UserModel(scenario, own)
    from benchmark.models.wave_model import WaveModel

    return WaveModel(scenario)


def scenario_drive(scenario: Scenario) -> Drive:
    """Return the scenario's load history."""
    history = scenario.load_history()
    return Drive(scenario.load.control, history.time, history.value)


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
