"""The dry run and its pictures."""

import pytest

from bench_hw.errors import InputError
from bench_hw.motion.plan import drawing, plan, summary, write_plot
from bench_hw.motion.protocol_file import Protocol, load_protocol, shipped_protocols


def protocol(*segments):
    return Protocol.model_validate({"schema": 1, "name": "p", "segments": list(segments)})


def test_times_and_depths_of_a_press():
    planned = plan(load_protocol("paper_press").protocol)
    assert planned.duration == pytest.approx(1 + 2 + 2 + 2 + 1)
    assert planned.deepest == pytest.approx(2e-3)
    assert [step.kind for step in planned.steps] == ["rest", "approach", "move", "move", "retract"]
    assert planned.assumed


def test_cycles_are_summed():
    planned = plan(protocol({"kind": "cycle", "depth": ["0 mm", "2 mm"], "speed": "2 mm/s", "count": 3}), 0.0)
    assert planned.duration == pytest.approx(6.0)
    assert len(planned.steps) == 6
    assert not planned.assumed


def test_a_move_to_a_force_is_assumed():
    planned = plan(protocol({"kind": "move", "force": "2 N", "speed": "1 mm/s"}), 0.0)
    assert planned.steps[0].assumed
    assert planned.duration == pytest.approx(2.0)


@pytest.mark.parametrize("name", sorted(shipped_protocols()))
def test_the_shipped_ones_join_up_and_stay_moderate(name):
    planned = plan(load_protocol(name).protocol)
    for before, after in zip(planned.steps, planned.steps[1:], strict=False):
        assert after.depth_from == before.depth_to
        assert after.start == pytest.approx(before.start + before.duration)
    assert planned.steps[0].depth_from == pytest.approx(planned.steps[-1].depth_to)
    assert planned.deepest <= 3.001e-3
    assert planned.duration < 180.0


def test_the_richer_ones_hold_what_discovery_needs():
    protocols = {name: load_protocol(name).protocol for name in shipped_protocols()}
    speeds = {s.speed for s in protocols["discovery_two_speeds"].segments if s.kind == "cycle"}
    assert len(speeds) == 2
    assert any(s.kind == "hold" and s.duration >= 20 for s in protocols["discovery_holds"].segments)
    assert sum(s.count for s in protocols["discovery_cycles"].segments if s.kind == "cycle") >= 10
    depths = {s.depth[1] for s in protocols["discovery_two_depths"].segments if s.kind == "cycle"}
    assert len(depths) == 2
    assert any(s.kind == "rest" and s.duration >= 60 for s in protocols["discovery_rest_in_air"].segments)
    kinds = [s.kind for s in protocols["discovery_full"].segments]
    assert {"cycle", "hold", "rest", "retract"} <= set(kinds)


def test_the_summary_names_each_step_and_the_sum():
    lines = summary(plan(load_protocol("paper_press").protocol), trials=10)
    assert lines[0] == "paper_press: 8.0 s a trial, 10 trial(s): 80.0 s in all"
    assert "approach" in lines[2]
    assert "(assumed)" in lines[2]


def test_the_drawing_is_a_press():
    lines = drawing(plan(load_protocol("paper_press").protocol))
    assert lines[0].startswith("  -2.00 mm |**")
    assert "8.0 s" in lines[-1]
    assert max(len(line) for line in lines) < 80


def test_the_plot_is_written_whole(tmp_path):
    path = write_plot(plan(load_protocol("paper_press").protocol), tmp_path / "a" / "plot.svg")
    text = path.read_text()
    assert "<svg" in text
    assert text.rstrip().endswith("</svg>")


def test_the_plot_replaces_a_plot_and_nothing_else(tmp_path):
    mine, planned = tmp_path / "mine.svg", plan(load_protocol("paper_press").protocol)
    mine.write_text("<svg>mine</svg>")
    with pytest.raises(InputError, match="is not a picture of a motion"):
        write_plot(planned, mine)
    assert mine.read_text() == "<svg>mine</svg>"
    with pytest.raises(InputError, match=r"plot\.png: .* ends in \.svg"):
        write_plot(planned, tmp_path / "plot.png")
    assert write_plot(planned, write_plot(planned, tmp_path / "plot.svg")).stat().st_size > 1000
