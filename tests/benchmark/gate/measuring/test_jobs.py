"""Cases of a gate that take a session: its films, and what its model lacks."""

import pytest

from benchmark.errors import InputError
from benchmark.files.shipped import find
from benchmark.gate.measuring.jobs import CASES, WORKLOADS
from benchmark.sessions import SHIPPED

PHANTOM = {"session": str(SHIPPED / "phantom"), "expected": "viscoelastic_relaxation"}


def _values(model):
    return {value.name: value.value for value in CASES[model](PHANTOM)}


def test_the_films_of_a_session_are_tracked():
    values = _values("track")
    assert values["frames"] > 300.0
    assert values["missing_percent"] == 0.0
    assert 0.1 < values["farthest_mean_motion_mm"] < 5.0


def test_of_a_users_model_its_functions_alone_are_timed(tmp_path):
    """Reading the results took ten times as long as a fast model: one twice as slow was 12 to 20 % slower."""
    model = tmp_path / "model.py"
    model.write_text(
        "import numpy as np\n"
        "def deform(layers, tool, support, time, force):\n    return np.zeros((time.size, 3))\n"
        "def profile(*_):\n    raise ValueError('this is no part of the load history')\n"
    )
    job = {"scenario": str(find("skin-5N", "scenario")), "set": {}, "model": "wave", "own": str(model)}
    follow = WORKLOADS["history"](job)
    assert callable(follow())
    with pytest.raises(InputError, match="no part"):
        follow()()


@pytest.mark.slow
def test_the_effect_of_a_session_is_named_and_closes_its_gap():
    values = _values("discover")
    assert values["expected_named"] == 1.0
    assert 0.9 < values["force_gap_closed"] <= 1.0
