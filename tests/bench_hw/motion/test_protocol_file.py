"""What a protocol of motion may say."""

import pytest

from bench_hw.errors import InputError
from bench_hw.motion.protocol_file import load_protocol, shipped_protocols

HEAD = 'schema = 1\nname = "p"\n'


@pytest.fixture
def load(tmp_path):
    def load(*segments, head=HEAD):
        path = tmp_path / "p.toml"
        path.write_text(head + "\n".join(f"[[segments]]\n{segment}" for segment in segments))
        return load_protocol(path).protocol

    return load


MOVE = 'kind = "move"\ndepth = "2 mm"\nspeed = "1 mm/s"'


def test_every_kind_of_segment_in_si(load):
    protocol = load(
        'kind = "rest"\nduration = "500 ms"',
        'kind = "approach"\ntouch_force = "50 mN"\nspeed = "1 mm/s"\nmax_depth = "5 mm"',
        MOVE,
        'kind = "move"\nforce = "5 N"\nspeed = "0.5 mm/s"',
        'kind = "hold"\nduration = "10 s"',
        'kind = "cycle"\ndepth = ["0 mm", "3 mm"]\nspeed = "2 mm/s"\ncount = 4',
        'kind = "retract"\ndepth = "-2 mm"\nspeed = "5 mm/s"',
    )
    rest, approach, move, push, hold, cycle, retract = protocol.segments
    assert (rest.duration, hold.duration) == (0.5, 10.0)
    assert (approach.touch_force, approach.speed, approach.max_depth) == pytest.approx((0.05, 1e-3, 5e-3))
    assert (move.depth, move.force, push.depth, push.force) == (pytest.approx(2e-3), None, None, 5.0)
    assert (cycle.depth, cycle.count) == (pytest.approx((0.0, 3e-3)), 4)
    assert retract.depth == pytest.approx(-2e-3)
    assert protocol.fastest == pytest.approx(5e-3)
    assert protocol.approach is approach
    assert protocol.depths == pytest.approx((2e-3, 0.0, 3e-3, -2e-3))
    assert protocol.rest_depth == pytest.approx(-2e-3)


def test_a_protocol_without_a_retraction_rests_two_millimetres_above(load):
    protocol = load(MOVE)
    assert protocol.rest_depth == -2e-3
    assert protocol.approach is None


@pytest.mark.parametrize(
    ("segment", "says"),
    [
        ('kind = "jump"', "kind"),
        ('kind = "rest"\nduration = "0 s"', "allowed is more than 0 s"),
        ('kind = "rest"\nduration = 5', "has no unit"),
        ('kind = "rest"\nduration = "5 mm"', "no quantity in s"),
        ('kind = "rest"', "duration: is missing"),
        (MOVE + '\nforce = "1 N"', "either depth or force"),
        ('kind = "move"\nspeed = "1 mm/s"', "either depth or force"),
        (MOVE + "\ncolour = 1", "colour: is unknown here"),
        ('kind = "move"\ndepth = "2 m"\nspeed = "1 mm/s"', "allowed is at most 100 mm"),
        ('kind = "cycle"\ndepth = ["1 mm", "1 mm"]\nspeed = "1 mm/s"\ncount = 1', "must differ"),
        ('kind = "cycle"\ndepth = ["1 mm"]\nspeed = "1 mm/s"\ncount = 1', "depth"),
        ('kind = "cycle"\ndepth = ["0 mm", "1 mm"]\nspeed = "1 mm/s"\ncount = 1.5', "count"),
        ('kind = "approach"\ntouch_force = "0 N"\nspeed = "1 mm/s"\nmax_depth = "1 mm"', "touch_force"),
    ],
)
def test_refuses_with_file_and_key(load, segment, says):
    with pytest.raises(InputError, match=says) as caught:
        load(segment)
    assert "p.toml" in str(caught.value)


@pytest.mark.parametrize(
    ("head", "says"),
    [
        ('schema = 2\nname = "p"\n', "schema"),
        ("schema = 1\n", "name: is missing"),
        (HEAD + "colour = 3\n", "colour: is unknown"),
    ],
)
def test_refuses_a_head_that_is_not_allowed(load, head, says):
    with pytest.raises(InputError, match=says):
        load(MOVE, head=head)


def test_refuses_a_protocol_that_does_nothing(tmp_path):
    (tmp_path / "p.toml").write_text(HEAD + "segments = []\n")
    with pytest.raises(InputError, match="segments"):
        load_protocol(tmp_path / "p.toml")


def test_a_setup_for_a_person_is_kept(load):
    protocol = load(MOVE, head=HEAD + '[setup]\ntool_radius = "8 mm"\nrigid_block = true\n')
    assert protocol.setup == {"tool_radius": "8 mm", "rigid_block": True}


def test_the_shipped_protocols_are_whole():
    assert {"paper_press", "paper_ten_presses"} <= set(shipped_protocols())
    for name in shipped_protocols():
        protocol = load_protocol(name).protocol
        assert protocol.name == name
        assert protocol.approach is not None
        assert protocol.description


def test_an_unknown_name_lists_the_shipped_ones():
    with pytest.raises(InputError, match=r"protocol 'papper'.*paper_press"):
        load_protocol("papper")
