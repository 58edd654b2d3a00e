"""Before the first trial: where depth zero is, and the tool brought to where a trial begins. Not recorded."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from bench_hw.capture.loop import Loop, Surroundings
from bench_hw.capture.order import CaptureOrder, check_depths
from bench_hw.capture.progress import Snapshot
from bench_hw.capture.trial import end_safely
from bench_hw.motion.steps import Action, Observation, carry_out, go_to
from bench_hw.rig.bench import Bench

_SPEED = 5e-3
_HOME_TIME = 10.0


def find_zero(bench: Bench, order: CaptureOrder, around: Surroundings) -> float:
    """Find the position (m) of depth zero and bring the tool to where a trial begins.

    The rig's `actuator.contact` if it says so; else where the protocol's own approach touches, tried once;
    else fully retracted.

    Raises
    ------
    BenchError
        Nothing is touched, a depth would be outside the travel, or anything unsafe; the tool was sent back.
    """
    contact, protocol = order.rig.rig.actuator.contact, order.protocol.protocol
    if contact is None and protocol.approach is not None:
        bench.zero_force()
        around.progress.say("touching once to find depth zero (the rig file gives no actuator.contact)")
        alone = protocol.model_copy(update={"segments": (protocol.approach,)})
        start = bench.actuator.position()
        contact = move(bench, around, start, lambda now: carry_out(alone, now)).zero
    elif contact is None:
        around.progress.say("depth is counted from fully retracted: no actuator.contact and no approach")
        contact = 0.0
    low, high = order.rig.rig.travel
    begin = min(max(contact + protocol.rest_depth, low), high)
    speed = min(_SPEED, order.rig.rig.actuator.max_speed)
    move(bench, around, contact, lambda now: go_to(begin, speed, now))
    check_depths(order, contact)
    return contact


def move(
    bench: Bench, around: Surroundings, zero: float, script: Callable[[Observation], Iterator[Action]]
) -> Observation:
    """Carry a motion out without recording it, watched like a trial; give what was seen last.

    Raises
    ------
    BenchError
        Whatever went wrong; the tool was sent back.
    """
    loop = Loop(bench, around, None, zero, Snapshot())
    try:
        loop.run(script(loop.now))
    except BaseException as error:
        end_safely(loop, error, None, around)
        raise
    return loop.now


def go_home(bench: Bench, around: Surroundings) -> None:
    """Send the tool to the lower end of its travel and wait until it is there, 10 s at most.

    Raises
    ------
    DeviceError
        The actuator is lost.
    """
    low = around.limits.travel[0]
    bench.actuator.retract()
    end = around.clock.now() + _HOME_TIME
    while around.clock.now() < end and bench.actuator.position() > low + bench.actuator.uncertainty:
        around.clock.sleep(0.02)
