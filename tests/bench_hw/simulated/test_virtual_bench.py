"""How the simulated actuator moves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.simulated.specimen import Response, SheetSpecimen
from bench_hw.simulated.tabulated import TabulatedSpecimen, read_sheet
from bench_hw.simulated.virtual_bench import ActuatorMotion, VirtualBench
from bench_hw.simulated.virtual_specimen import HiddenEffects, SpecimenFile, ToolCurve, VirtualSpecimen


def run(motion, duration, step=1e-3):
    rows = []
    for _ in range(round(duration / step)):
        motion.step(step)
        rows.append((motion.position, motion.velocity))
    return np.array(rows)


def test_it_obeys_speed_and_acceleration():
    motion = ActuatorMotion(stroke=0.05, acceleration=0.1, target=0.02, speed=0.01)
    rows = run(motion, 3.0)
    assert rows[:, 1].max() == pytest.approx(0.01)
    assert np.abs(np.diff(rows[:, 1])).max() <= 0.1 * 1e-3 * (1 + 1e-9)
    assert np.argmax(rows[:, 1] >= 0.01 * (1 - 1e-9)) == pytest.approx(100, abs=2)  # 0.01 / 0.1 s
    assert rows[-1, 0] == pytest.approx(0.02, abs=2e-5)


def test_it_stops_inside_its_dead_band_short_of_the_target():
    count = 0.05 / 1024
    motion = ActuatorMotion(stroke=0.05, target=0.02, speed=0.002, dead_band=4 * count, resolution=count)
    rows = run(motion, 15.0)
    assert 3.0 * count <= 0.02 - rows[-1, 0] <= 5.0 * count
    assert rows[-1, 1] == 0.0


def test_it_takes_its_dead_time_to_leave_rest_and_none_to_go_on():
    prompt, late = (ActuatorMotion(stroke=0.05, target=0.01, speed=0.002, dead_time=wait) for wait in (0.0, 0.0155))
    at_once, later = run(prompt, 1.0), run(late, 1.0)
    assert later[:15, 0] == pytest.approx(0.0)
    assert later[15:, 0] == pytest.approx(at_once[:-15, 0])
    prompt.target = late.target = 0.02
    assert np.diff(run(late, 0.1)[:, 0]) == pytest.approx(np.diff(run(prompt, 0.1)[:, 0]))


@given(st.lists(st.floats(-0.01, 0.06), min_size=1, max_size=8), st.floats(1e-4, 0.02))
def test_it_never_leaves_its_stroke_or_breaks_its_speed(targets, speed):
    motion = ActuatorMotion(stroke=0.05, speed=speed)
    for target in targets:
        motion.target = target
        rows = run(motion, 0.3)
        assert np.all((rows[:, 0] >= 0.0) & (rows[:, 0] <= 0.05))
        assert np.abs(rows[:, 1]).max() <= speed * (1 + 1e-9)


def test_it_reads_whole_counts():
    motion = ActuatorMotion(stroke=0.05, position=0.01234, resolution=0.05 / 1024)
    assert motion.reading() == pytest.approx(253 * 0.05 / 1024)


def relaxing_sheet():
    return TabulatedSpecimen(read_sheet("phantom"), ((0.3, 2.0), (0.1, 30.0)))


def relaxing_phantom():
    curve = ToolCurve(radius_mm=5.0, depth_mm=(0.0, 1.0, 2.0, 4.0), force_N=(0.0, 1.0, 3.0, 9.0))
    effects = HiddenEffects(relaxation=((0.3, 2.0),), slip_share=0.4, slip_force_N=0.5)
    return VirtualSpecimen(SpecimenFile(schema=1, synthetic=True, tools=(curve,), effects=effects), 5e-3)


@pytest.fixture
def bench():
    motion = ActuatorMotion(stroke=0.05, position=0.010, target=0.014, speed=0.002)
    return VirtualBench(SheetSpecimen(damping=0.0), motion, contact=0.012, start=50.0)


def test_force_follows_the_depth(bench):
    force = bench.force_at(np.array([50.5, 51.5, 53.0]))
    depth = 0.014 - 0.012
    assert force[0, 2] == 0.0
    assert 0.0 < force[1, 2] < force[2, 2]
    assert force[2, 2] == pytest.approx(600 * depth * (1 + depth / 6e-3), rel=0.01)
    assert bench.depth() == pytest.approx(depth, abs=2e-5)


def test_asking_for_the_past_does_not_move_it(bench):
    bench.advance(52.0)
    depth = bench.depth()
    bench.advance(51.0)
    assert bench.depth() == depth


def test_the_way_it_is_asked_does_not_change_the_answer():
    def make():
        motion = ActuatorMotion(stroke=0.05, position=0.011, target=0.014, speed=0.002)
        return VirtualBench(SheetSpecimen(), motion, contact=0.012)

    one, many = make(), make()
    at_once = one.force_at(np.arange(1, 1001) * 1e-3)
    piecewise = np.concatenate([many.force_at(np.array([k * 1e-3])) for k in range(1, 1001)])
    assert np.allclose(at_once, piecewise, rtol=1e-9, atol=1e-12)


def test_faster_sensors_see_between_the_steps(bench):
    instants = 51.4 + np.arange(70) / 7000.0
    force = bench.force_at(instants)[:, 2]
    assert np.all(np.diff(force) >= 0.0)
    assert len(set(force.tolist())) > 60


def test_markers_are_those_of_the_instant(bench):
    before, after = bench.markers_at(50.1), bench.markers_at(53.0)
    assert before[:, 2].max() == 0.0
    assert after[:, 2].max() > 1e-3


def test_any_callable_can_be_put_under_the_tool():
    seen = []

    def springy(time, depth, start):
        seen.append((len(time), start))
        force = np.zeros((len(depth) - start, 3))
        force[:, 2] = 1000.0 * np.maximum(depth[start:], 0.0)
        return Response(force, np.zeros((len(depth) - start, 4, 3)))

    motion = ActuatorMotion(stroke=0.05, position=0.013, target=0.013)
    bench = VirtualBench(springy, motion, contact=0.012)
    assert bench.force_at(np.array([0.1]))[0, 2] == pytest.approx(1.0)
    assert bench.markers_at(0.1).shape == (4, 3)
    assert seen[0] == (1, 0)
    assert seen[1] == (101, 1)


def test_an_hour_takes_no_more_memory_than_a_minute(bench):
    sizes = []
    for now in (30.0, 60.0, 150.0):
        bench.advance(50.0 + now)
        sizes.append(sum(kept.nbytes for kept in vars(bench).values() if isinstance(kept, np.ndarray)))
    assert sizes[0] == sizes[2] < 1e6
    assert bench.depth() == pytest.approx(2e-3, abs=2e-5)


@pytest.mark.parametrize("make", [relaxing_sheet, relaxing_phantom])
def test_what_is_forgotten_is_still_in_the_force(make):
    def force(kept):
        motion = ActuatorMotion(stroke=0.05, position=0.0135, target=0.0135)
        bench = VirtualBench(make(), motion, contact=0.012, kept=kept)
        found = []
        for now in np.arange(1, 25) * 0.1:
            found.append(bench.force_at(np.array([now]))[0, 2])
            bench.markers_at(now - 0.02)
            motion.target = 0.0135 + 0.001 * (now > 1.0)
        return np.array(found)

    assert np.allclose(force(0.3), force(100.0), rtol=1e-12)


def test_a_long_wait_is_answered_from_its_beginning(bench):
    instants = 50.0 + np.arange(1, 500) * 0.1
    few = VirtualBench(SheetSpecimen(damping=0.0), ActuatorMotion(0.05, position=0.010, target=0.014, speed=0.002),
                       contact=0.012, start=50.0, kept=2.0)  # fmt: skip
    assert np.allclose(few.force_at(instants), bench.force_at(instants), rtol=1e-9, atol=1e-12)


def test_long_histories_are_kept(bench):
    bench.advance(50.0 + 10.0)
    force = bench.force_at(np.array([59.0]))
    assert force[0, 2] == pytest.approx(600 * 2e-3 * (1 + 2 / 6), rel=0.01)
