"""Cases of a gate that take a session: its films, and what its model lacks."""

import pytest

from benchmark.gate.measuring.jobs import CASES
from benchmark.sessions import SHIPPED

PHANTOM = {"session": str(SHIPPED / "phantom"), "expected": "viscoelastic_relaxation"}


def _values(model):
    return {value.name: value.value for value in CASES[model](PHANTOM)}


def test_the_films_of_a_session_are_tracked():
    values = _values("track")
    assert values["frames"] > 300.0
    assert values["missing_percent"] == 0.0
    assert 0.1 < values["farthest_mean_motion_mm"] < 5.0


@pytest.mark.slow
def test_the_effect_of_a_session_is_named_and_closes_its_gap():
    values = _values("discover")
    assert values["expected_named"] == 1.0
    assert 0.9 < values["force_gap_closed"] <= 1.0
