"""How fast the tool goes back: from the first sample over the limit to the packet at the board, in real time."""

import threading

import numpy as np
import pytest

from bench_hw.capture.loop import Loop, LoopContext
from bench_hw.capture.progress import CaptureState, Silent
from bench_hw.capture.trial import end_safely
from bench_hw.clock import MonotonicClock
from bench_hw.motion.steps import go_to
from bench_hw.rig.opening import open_bench
from bench_hw.rig.rig_file import simulated_rig
from bench_hw.safety import SafetyError, SafetyLimits
from bench_hw.simulated.specimen import SheetSpecimen

pytestmark = pytest.mark.slow

REPEATS, LIMIT = 50, 1.0
BACK = bytes.fromhex("20 00 00")


class Timed:
    """A specimen that notes when its force first passed the limit, and a board's ear that notes packets."""

    def __init__(self, clock):
        self.clock = clock
        self.over = self.sent_back = None
        self.sheet = SheetSpecimen(damping=0.0)

    def __call__(self, time, depth, start):
        answer = self.sheet(time, depth, start)
        over = np.flatnonzero(answer.force[:, 2] > LIMIT)
        if len(over) and self.over is None:
            self.over = float(time[start + over[0]])
        return answer

    def listen(self, board):
        handle = board.handle

        def hear(data):
            if data == BACK and self.sent_back is None:
                self.sent_back = self.clock.now()
            return handle(data)

        board.handle = hear


def reaction(bench, timed, clock, switched_on):
    """One press over the limit: seconds from the first sample over it to the command to go back."""
    limits = SafetyLimits(LIMIT, 0.5, bench.travel, tuple(bench.force.ranges.tolist()))
    context = LoopContext(clock, limits, threading.Event(), Silent())
    timed.over = timed.sent_back = None
    loop = Loop(bench, context, None, 0.0, CaptureState())
    with pytest.raises(SafetyError, match="is above the limit") as caught:
        loop.run(go_to(0.009, 0.010, loop.now))
    end_safely(loop, caught.value, None, context)
    clock.sleep(0.3)
    return timed.sent_back - (switched_on + timed.over)


def test_within_five_milliseconds(capsys):
    clock = MonotonicClock()
    timed = Timed(clock)
    rig = simulated_rig({"camera": None, "force": {"noise": "0 N"}})
    switched_on = clock.now()
    with open_bench(rig, clock, specimen=timed) as bench:
        switched_on = bench.twins.bench._start
        timed.listen(bench.twins.board)
        bench.start()
        times = np.array([reaction(bench, timed, clock, switched_on) for _ in range(REPEATS)])
    with capsys.disabled():
        print(f"\nreaction: median {1e3 * np.median(times):.2f} ms, worst {1e3 * times.max():.2f} ms of {REPEATS}")
    assert times.min() > 0.0
    assert np.median(times) < 5e-3
