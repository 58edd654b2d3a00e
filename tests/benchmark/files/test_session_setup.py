import pytest

from benchmark.errors import InputError
from benchmark.files.problems import validated
from benchmark.files.session_file import SessionFile
from benchmark.files.session_setup import assumptions, base_setup, setups
from benchmark.files.sources import Source
from benchmark.files.tool import Support, Tool

SOURCE = Source("session.toml")


def session(**keys):
    trials = [{"file": "a.csv", "condition": "slow"}, {"file": "b.csv", "condition": "fast"}]
    return validated(SessionFile, {"name": "s", "trials": trials, **keys}, SOURCE)


def test_what_is_not_given_is_assumed_and_said():
    file = session()
    assert base_setup(file, SOURCE).tool == Tool(radius=5e-3, contact="rigid_bonded")
    assert base_setup(file, SOURCE).support == Support(kind="bonded")
    said = " ".join(assumptions(file, ["slow", "fast"]))
    assert all(word in said for word in ("assumed 5 mm", "assumed rigid_bonded", "assumed bonded"))


def test_what_is_given_is_not_assumed():
    file = session(tool={"radius": "3 mm", "contact": "rigid_bonded"}, support={"kind": "bonded"})
    assert assumptions(file, ["slow", "fast"]) == []
    assert base_setup(file, SOURCE).tool.radius == 3e-3


def test_a_condition_overrides_single_keys():
    file = session(tool={"radius": "3 mm"}, conditions={"fast": {"tool": {"contact": "uniform_pressure"}}})
    found = setups(file, ["slow", "fast"], SOURCE)
    assert found["slow"].tool == Tool(radius=3e-3, contact="rigid_bonded")
    assert found["fast"].tool == Tool(radius=3e-3, contact="uniform_pressure")


def test_an_assumption_in_any_condition_is_said():
    hole = {"kind": "hole", "hole_radius": "30 mm"}
    file = session(conditions={"fast": {"tool": {"radius": "2 mm"}, "support": hole}})
    assert any("radius" in each for each in assumptions(file, ["slow", "fast"]))
    assert not any("radius" in each for each in assumptions(file, ["fast"]))
    assert not any("support" in each for each in assumptions(file, ["fast"]))


def test_a_condition_without_trials_is_refused():
    with pytest.raises(InputError, match=r"conditions\.fats: no trial has this condition; did you mean fast"):
        setups(session(conditions={"fats": {}}), ["slow", "fast"], SOURCE)


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ({"tool": {"radius": "3 kPa"}}, "session.toml, tool.radius: '3 kPa' is a pressure"),
        ({"tool": {"radus": "3 mm"}}, "session.toml, tool.radus: this key is not known; did you mean radius"),
        ({"support": {"kind": "hole"}}, "session.toml, support.hole_radius: a support of kind"),
        ({"support": {"kind": "hole", "hole_radius": "4 mm"}}, "session.toml, support.hole_radius: 4 mm is not larger"),
        ({"conditions": {"slow": {"tool": {"radius": 3}}}}, "session.toml, conditions.slow.tool.radius: the bare"),
    ],
)
def test_bad_keys_are_refused_with_their_place(keys, says):
    with pytest.raises(InputError) as refusal:
        setups(session(**keys), ["slow", "fast"], SOURCE)
    assert str(refusal.value).startswith(says)
