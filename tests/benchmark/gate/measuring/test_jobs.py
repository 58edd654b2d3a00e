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


@pytest.mark.parametrize("kind", ["float64", "float32"])
def test_a_users_model_that_keeps_its_answers_is_asked_anew_each_time(tmp_path, kind):
    """A dictionary keyed by the load made each call after the first a look-up: ten times the cost was -0.3 %."""
    model, log = tmp_path / "model.py", tmp_path / "calls.txt"
    model.write_text(
        "import numpy as np\nfrom pathlib import Path\nKNOWN = {}\n"
        "def deform(layers, tool, support, time, force):\n"
        f"    key = force.astype(np.{kind}).tobytes()\n"
        "    if key not in KNOWN:\n"
        f"        Path({str(log)!r}).open('a').write('.')\n"
        "        KNOWN[key] = 1e-4 * np.outer(force, np.ones(len(layers)))\n"
        "    return KNOWN[key]\n"
    )
    job = {"scenario": str(find("skin-5N", "scenario")), "set": {}, "model": "wave", "own": str(model)}
    follow = WORKLOADS["history"](job)
    before = len(log.read_text()) if log.exists() else 0
    for _ in range(50):
        follow()
    assert len(log.read_text()) - before == 50


@pytest.mark.slow
def test_the_effect_of_a_session_is_named_and_closes_its_gap():
    values = _values("discover")
    assert values["expected_named"] == 1.0
    assert 0.9 < values["force_gap_closed"] <= 1.0
