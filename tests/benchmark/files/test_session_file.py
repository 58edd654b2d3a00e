import pytest

from benchmark.errors import InputError
from benchmark.files.problems import validated
from benchmark.files.session_file import SessionFile
from benchmark.files.sources import Source

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
