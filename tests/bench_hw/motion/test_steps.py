"""Carrying a protocol out against an ideal actuator and spring, without any device."""

import numpy as np
import pytest

from bench_hw.motion.protocol_file import Protocol
from bench_hw.motion.steps import Halt, MotionError, MoveTo, Note, Observation, carry_out, go_to

CONTACT, STIFFNESS, STEP = 0.010, 1000.0, 1e-3


class IdealBench:
    """Moves exactly as told; presses like a spring from `CONTACT` on."""

    def __init__(self, zero=CONTACT, position=0.005, stuck=False):
        self.now = Observation(0.0, position, 0.0, zero, 1e-5, (0.0, 0.020))
        self.target, self.speed, self.stuck = position, 0.0, stuck
        self.actions, self.path = [], []

    def run(self, script, longest=200.0):
        for action in script:
            if action is not None:
                self.actions.append(action)
            if isinstance(action, MoveTo):
                self.target, self.speed = action.position, action.speed
            elif isinstance(action, Halt):
                self.target = self.now.position
            elif action is None:
                self.step()
                assert self.now.time < longest
        return self

    def step(self):
        now = self.now
        now.time += STEP
        change = self.speed * STEP * (not self.stuck)
        now.position += min(max(self.target - now.position, -change), change)
        now.press = STIFFNESS * max(0.0, now.position - CONTACT)
        self.path.append((now.time, now.position))


def protocol(*segments):
    return Protocol.model_validate({"schema": 1, "name": "p", "segments": list(segments)})


APPROACH = {"kind": "approach", "touch_force": "0.1 N", "speed": "2 mm/s", "max_depth": "8 mm"}


def run(*segments, **options):
    bench = IdealBench(**options)
    return bench.run(carry_out(protocol(*segments), bench.now))


def test_waiting_takes_its_time():
    assert run({"kind": "rest", "duration": "2 s"}).now.time == pytest.approx(2.0, abs=2 * STEP)


def test_an_approach_stops_at_the_touch_and_makes_it_depth_zero():
    bench = run(APPROACH)
    touch = CONTACT + 0.1 / STIFFNESS
    assert bench.now.zero == pytest.approx(touch, abs=5e-6)
    assert bench.now.position == pytest.approx(touch, abs=5e-6)
    assert [type(action) for action in bench.actions] == [Note, MoveTo, Halt, Note]
    assert bench.actions[-1].kind == "touch"


def test_depths_are_counted_from_the_touch():
    bench = run(APPROACH, {"kind": "move", "depth": "2 mm", "speed": "1 mm/s"})
    assert bench.now.position == pytest.approx(bench.now.zero + 2e-3, abs=2e-5)


def test_without_a_touch_there_is_an_error_with_figures():
    with pytest.raises(MotionError, match=r"no touch of 0\.1 N down to 3\.00 mm .* raise max_depth"):
        run({**APPROACH, "max_depth": "3 mm"}, zero=0.005)


def test_a_force_before_the_tool_has_moved_is_no_touch():
    bench = IdealBench()
    bench.now.press = 0.4  # a sensor that nobody zeroed
    with pytest.raises(MotionError, match=r"0\.400 N before the tool moves, at position 5\.00 mm.*force\.bias"):
        bench.run(carry_out(protocol(APPROACH), bench.now))
    assert not [action for action in bench.actions if isinstance(action, MoveTo)]


def test_an_approach_ends_where_the_force_grows_the_wrong_way():
    class Turned(IdealBench):
        def step(self):
            super().step()
            self.now.press = -self.now.press

    bench = Turned()
    with pytest.raises(MotionError, match=r"negative where the tool presses.*force\.press_axis"):
        bench.run(carry_out(protocol(APPROACH), bench.now))
    assert bench.now.position == pytest.approx(CONTACT + 0.1 / STIFFNESS, abs=1e-5)


def test_an_approach_never_leaves_the_travel():
    with pytest.raises(MotionError, match="no touch"):
        run({**APPROACH, "touch_force": "50 N", "max_depth": "90 mm"})


@pytest.mark.parametrize(("start", "force"), [(0.005, "2 N"), (0.014, "2 N")])
def test_a_move_to_a_force_comes_from_either_side(start, force):
    bench = IdealBench(position=start)
    bench.step()
    bench.run(carry_out(protocol({"kind": "move", "force": force, "speed": "1 mm/s"}), bench.now))
    assert bench.now.press == pytest.approx(2.0, abs=5e-3)
    assert isinstance(bench.actions[-1], Halt)


def test_a_press_to_a_force_is_never_sent_far_ahead_and_goes_as_one_move():
    """A board goes on to where it was sent when its computer dies: that was the end of the travel."""
    segment = {"kind": "move", "force": "2 N", "speed": "1 mm/s"}
    bench = IdealBench()
    ahead = []
    for action in carry_out(protocol(segment), bench.now):
        if isinstance(action, MoveTo):
            bench.target, bench.speed = action.position, action.speed
        elif action is None:
            bench.step()
        ahead.append(bench.target - bench.now.position)
    assert max(ahead) <= 0.5e-3 + 1e-9
    times, path = np.array(bench.path).T
    np.testing.assert_allclose(path, 5e-3 + 1e-3 * times, atol=1e-9)
    assert bench.now.press == pytest.approx(2.0, abs=5e-3)


def test_a_press_to_a_force_is_sent_beyond_the_dead_band():
    bench = IdealBench()
    bench.now.tolerance = 0.4e-3
    bench.run(carry_out(protocol({"kind": "move", "force": "2 N", "speed": "0.1 mm/s"}), bench.now))
    moves = [action.position for action in bench.actions if isinstance(action, MoveTo)]
    assert moves[0] == pytest.approx(0.005 + 1.6e-3)
    assert bench.now.press == pytest.approx(2.0, abs=5e-3)


def test_a_force_out_of_reach_is_an_error():
    with pytest.raises(MotionError, match="50 N was not reached within the travel"):
        run({"kind": "move", "force": "50 N", "speed": "5 mm/s"})


def test_a_cycle_goes_there_and_back_as_often_as_it_says():
    bench = run({"kind": "cycle", "depth": ["0 mm", "2 mm"], "speed": "2 mm/s", "count": 3})
    turns = [action.position for action in bench.actions if isinstance(action, MoveTo)]
    assert turns == pytest.approx([CONTACT] + [CONTACT + 2e-3, CONTACT] * 3)
    assert [action.message for action in bench.actions if isinstance(action, Note)][1:] == [
        "cycle 1 of 3",
        "cycle 2 of 3",
        "cycle 3 of 3",
    ]


def test_a_depth_outside_the_travel_is_refused_before_it_is_sent():
    bench = IdealBench()
    with pytest.raises(MotionError, match=r"position 25\.00 mm \(depth 15\.00 mm\) is outside the travel"):
        bench.run(carry_out(protocol({"kind": "move", "depth": "15 mm", "speed": "1 mm/s"}), bench.now))
    assert not [action for action in bench.actions if isinstance(action, MoveTo)]


def test_an_actuator_that_stands_still_is_an_error():
    with pytest.raises(MotionError, match=r"did not reach 12\.00 mm"):
        run({"kind": "move", "depth": "2 mm", "speed": "1 mm/s"}, stuck=True)


def test_nothing_is_sent_when_it_is_there_already():
    bench = run({"kind": "retract", "depth": "-5 mm", "speed": "1 mm/s"})
    assert not [action for action in bench.actions if isinstance(action, MoveTo)]


def test_going_somewhere_apart_from_a_protocol():
    bench = IdealBench()
    bench.run(go_to(0.008, 1e-3, bench.now))
    assert bench.now.position == pytest.approx(0.008, abs=2e-5)
