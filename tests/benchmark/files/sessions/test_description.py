import pytest

from bench_hw.capture import session_keys
from bench_hw.vision.markers.grid import Layout
from benchmark.errors import InputError
from benchmark.files.schema import known_keys, validated
from benchmark.files.sessions.description import (
    Camera,
    ConditionKeys,
    Drive,
    SessionFile,
    TrialEntry,
    assumptions,
    base_setup,
    setups,
)
from benchmark.files.sources import Source
from benchmark.files.tool import Support, Tool

TRIALS = [{"file": "a.csv", "condition": "slow"}]


def read(**keys):
    return validated(SessionFile, {"name": "s", "trials": TRIALS, **keys}, Source("session.toml"))


def test_name_and_trials_are_enough():
    session = read()
    assert (session.specimen, session.drive.channel, session.camera, session.synthetic) == (None, "depth", None, False)
    assert (dict(session.tool), dict(session.support), dict(session.conditions)) == ({}, {}, {})


def test_a_camera_has_a_grid():
    camera = read(camera={"marker_rows": 3, "marker_columns": 6, "marker_spacing": "8 mm", "distance": "70 mm"}).camera
    assert (camera.marker_rows, camera.marker_columns, camera.marker_spacing, camera.distance) == (3, 6, 8e-3, 0.07)
    assert (camera.file, camera.centre_marker) == (None, None)
    assert (camera.print_scatter, camera.scale_uncertainty) == (None, None)


def test_how_well_markers_were_made():
    grid = {"marker_rows": 3, "marker_columns": 6, "marker_spacing": "8 mm"}
    camera = read(camera={**grid, "print_scatter": "0.1 mm", "scale_uncertainty": "0.3 %"}).camera
    assert (camera.print_scatter, camera.scale_uncertainty) == (1e-4, 0.003)


@pytest.mark.parametrize(
    ("rows", "columns", "allowed"),
    [(1, 1, False), (1, 3, False), (1, 4, True), (2500, 1, False), (50, 50, True), (51, 50, False)],
)
def test_a_grid_has_as_many_markers_as_can_be_tracked(rows, columns, allowed):
    camera = {"marker_rows": rows, "marker_columns": columns, "marker_spacing": "8 mm"}
    if allowed:
        read(camera=camera)
        assert Layout(rows, columns).count == rows * columns
    else:
        with pytest.raises(InputError, match=r"marker_rows: .*allowed"):
            read(camera=camera)


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ({"trials": []}, "trials: it has 0 entries; allowed: at least 1"),
        ({"trials": [{"file": "a.csv"}]}, "trials[#1].condition: this key is missing"),
        ({"trials": [{"condition": "a"}]}, "trials[#1].file: this key is missing"),
        ({"trials": [{**TRIALS[0], "marker": "m"}]}, "trials[#1].marker: this key is not known; did you mean markers?"),
        ({"drive": {"channel": "speed"}}, "drive.channel: 'speed' is not allowed; allowed: 'depth' or 'force'"),
        ({"camera": {"marker_rows": 3}}, "camera.marker_columns: this key is missing"),
        ({"synthetic": "yes"}, "synthetic: 'yes' is not allowed; allowed: true, false"),
        ({"conditions": {"slow": {"tol": {}}}}, "conditions.slow.tol: this key is not known; did you mean tool?"),
        ({"specimn": "x"}, "specimn: this key is not known; did you mean specimen?"),
        ({"tool": 5}, "tool: 5 is no table of keys and values"),
    ],
)
def test_bad_keys_are_refused_by_name(keys, says):
    with pytest.raises(InputError) as refusal:
        read(**keys)
    assert f"session.toml, {says}" in str(refusal.value)


SOURCE = Source("session.toml")


def session(**keys):
    trials = [{"file": "a.csv", "condition": "slow"}, {"file": "b.csv", "condition": "fast"}]
    return validated(SessionFile, {"name": "s", "trials": trials, **keys}, SOURCE)


def assumed(file, *conditions):
    return assumptions(file, {name: setups(file, ["slow", "fast"], SOURCE)[name] for name in conditions})


def test_a_touching_tool_gets_an_edge_and_says_so():
    file = session(
        tool={"radius": "10 mm", "contact": "rigid_frictionless"},
        conditions={"fast": {"tool": {"edge_radius": "2 mm"}}},
    )
    found = setups(file, ["slow", "fast"], SOURCE)
    assert (found["slow"].tool.edge_radius, found["fast"].tool.edge_radius) == (pytest.approx(1e-3), 2e-3)
    said = [each for each in assumed(file, "slow", "fast") if "edge" in each]
    assert len(said) == 1
    assert said[0].startswith("the tool's edge is not given: assumed rounded by 1 mm, a tenth")
    assert not any("edge" in each for each in assumed(file, "fast"))


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_other_tools_stay_sharp(contact):
    file = session(tool={"contact": contact})
    assert base_setup(file, SOURCE).tool.edge_radius is None
    assert not any("edge" in each for each in assumed(file, "slow", "fast"))


def test_what_is_not_given_is_assumed_and_said():
    file = session()
    assert base_setup(file, SOURCE).tool == Tool(radius=5e-3, contact="rigid_bonded")
    assert base_setup(file, SOURCE).support == Support(kind="bonded")
    said = " ".join(assumed(file, "slow", "fast"))
    assert all(word in said for word in ("assumed 5 mm", "assumed rigid_bonded", "assumed bonded"))


def test_what_is_given_is_not_assumed():
    file = session(tool={"radius": "3 mm", "contact": "rigid_bonded"}, support={"kind": "bonded"})
    assert assumed(file, "slow", "fast") == []
    assert base_setup(file, SOURCE).tool.radius == 3e-3


def test_a_condition_overrides_single_keys():
    file = session(tool={"radius": "3 mm"}, conditions={"fast": {"tool": {"contact": "uniform_pressure"}}})
    found = setups(file, ["slow", "fast"], SOURCE)
    assert found["slow"].tool == Tool(radius=3e-3, contact="rigid_bonded")
    assert found["fast"].tool == Tool(radius=3e-3, contact="uniform_pressure")


def test_an_assumption_in_any_condition_is_said():
    hole = {"kind": "hole", "hole_radius": "30 mm"}
    file = session(conditions={"fast": {"tool": {"radius": "2 mm"}, "support": hole}})
    assert any("radius" in each for each in assumed(file, "slow", "fast"))
    assert not any("radius" in each for each in assumed(file, "fast"))
    assert not any("support" in each for each in assumed(file, "fast"))


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


def test_the_bench_writes_the_keys_that_are_read():
    """`bench_hw` knows nothing of this package and checks what it writes by a list of its own."""
    pairs = [
        (session_keys.ToolKeys, Tool),
        (session_keys.SupportKeys, Support),
        (session_keys.CameraKeys, Camera),
        (session_keys.DriveKeys, Drive),
        (session_keys.TrialKeys, TrialEntry),
        (session_keys.ConditionKeys, ConditionKeys),
    ]
    for written, read in pairs:
        assert set(written.model_fields) == set(read.model_fields), read.__name__
    assert set(known_keys(SessionFile)) <= set(known_keys(session_keys.SessionKeys))
