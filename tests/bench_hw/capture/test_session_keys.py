"""What `capture --set` may put into a session file is checked before anything moves."""

import pytest

from bench_hw.capture.session_keys import check_session, check_session_file
from bench_hw.errors import InputError


@pytest.mark.parametrize(
    "tables",
    [
        {"tool": {"radius": "5 mm", "contact": "rigid_bonded", "position": ["1 mm", "0 mm"], "tilt": "3 deg"}},
        {"tool": {"radius": "5 mm +/- 1 %"}, "support": {"kind": "hole", "hole_radius": "30 mm ± 0.1 mm"}},
        {"camera": {"marker_rows": 3, "marker_columns": 6, "marker_spacing": "10 mm", "scale_uncertainty": "0.3 %"}},
        {"conditions": {"slow press": {"tool": {"radius": "6 mm"}}}, "specimen": "skin_forearm", "synthetic": True},
    ],
)
def test_what_a_session_may_say_passes(tables):
    check_session(tables, "--set")


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ({"tool": {"radius": 5}}, "key tool.radius: 5 has no unit"),
        ({"tool": {"rdius": "5 mm"}}, "key tool.rdius: is unknown here"),
        ({"tool": {"radius": "5 N"}}, "key tool.radius: '5 N' is no quantity in m"),
        ({"tool": 1}, "key tool = 1: allowed is a table"),
        ({"schema": 7}, "key schema = 7: allowed is 1"),
        ({"drive": {"channel": "speed"}}, "allowed is 'depth' or 'force'"),
        ({"specimen": "a\nb"}, "allowed are printable characters"),
        ({"camera": {"marker_rows": 0}}, "key camera.marker_rows = 0: allowed is at least 1"),
    ],
)
def test_anything_else_is_refused_by_key(tables, says):
    with pytest.raises(InputError) as caught:
        check_session(tables, "--set")
    assert says in str(caught.value)


def test_the_file_is_read_back(tmp_path):
    (tmp_path / "session.toml").write_text('schema = 1\nname = "a"\n[tool]\nradius = "5"\n')
    with pytest.raises(InputError, match=r"tool\.radius"):
        check_session_file(tmp_path / "session.toml")
