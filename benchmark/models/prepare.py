"""From a scenario to a model that is ready to run."""

from __future__ import annotations

from benchmark.files import Scenario
from benchmark.models.keeping import Keeping
from benchmark.models.result import Drive, PreparedModel
from benchmark.models.user_file import UserFile


def prepare(
    model: str,
    scenario: Scenario,
    *,
    every_field: bool = False,
    own: UserFile | None = None,
    keeping: Keeping | None = None,
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

    Raises
    ------
    UncoveredError
        The model has no answer to this scenario.
    InputError
        The scenario is at fault.
    """
    if model == "fem":
        from benchmark.models.fem_model import FemModel

        return FemModel(scenario, every_field=every_field, keeping=keeping)
    if own is not None:
        from benchmark.models.user_model import UserModel

        return UserModel(scenario, own)
    from benchmark.models.wave_model import WaveModel

    return WaveModel(scenario)


def scenario_drive(scenario: Scenario) -> Drive:
    """Return the scenario's load history."""
    history = scenario.load_history()
    return Drive(scenario.load.control, history.time, history.value)
