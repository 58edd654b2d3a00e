import pytest

from benchmark.files import load_scenario
from benchmark.models import UncoveredError, prepare, scenario_drive

OUTSIDE = {
    "option of the body": ({"physics.pretension": "20 kPa"}, "pretension", ("fem", "wave")),
    "tilted tool": ({"tool.tilt": "3 deg"}, "tilted", ("fem", "wave")),
    "block": ({"fem.geometry": "block"}, "block", ("fem",)),
    "friction": (
        {"tool.contact": "rigid_frictional", "physics.friction_coefficient": "0.3"},
        "friction",
        ("fem", "wave"),
    ),
    "endless base": ({"support.kind": "half_space"}, "half_space", ("wave",)),
    "published membrane": ({"wave.model": "published"}, "published", ("wave",)),
}


@pytest.mark.parametrize("case", OUTSIDE)
def test_what_a_model_lacks_it_declines(case: str) -> None:
    settings, word, models = OUTSIDE[case]
    scenario = load_scenario("skin-5N", settings)
    for model in models:
        with pytest.raises(UncoveredError, match=word):
            prepare(model, scenario)


def test_relaxation_left_out_is_said() -> None:
    scenario = load_scenario(
        "skin-5N",
        {
            "subcutaneous_fat.relaxation": '[{ g = 0.3, tau = "0.5 s" }]',
            "load.peak": "0.1 N",
            "load.observations": "2",
            "fem.mesh": "coarse",
        },
    )
    for model in ("fem", "wave"):
        result = prepare(model, scenario).run(scenario_drive(scenario))
        assert any("relaxation of subcutaneous_fat is left out" in warning for warning in result.warnings)
