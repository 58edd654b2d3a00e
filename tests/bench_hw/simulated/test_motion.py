"""How the simulated actuator moves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.simulated.motion import ActuatorMotion


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
