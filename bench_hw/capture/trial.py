"""One trial: depth zero found, the tool brought to where a trial begins, the protocol carried out and recorded.

Whatever goes wrong, the tool is sent back first; then the fault is written, recording goes on for a moment so
that the file shows the tool going back, and the file is closed. Moves before the first trial are not recorded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from bench_hw.capture.loop import RETRACT_TIME, Loop, LoopContext, Recorder
from bench_hw.capture.order import CaptureOrder, check_depths
from bench_hw.capture.progress import CaptureState
from bench_hw.errors import BenchError, TrialFileError
from bench_hw.motion.protocol_file import Protocol
from bench_hw.motion.steps import Action, MotionError, Observation, carry_out, go_to
from bench_hw.rig.bench import Bench
from bench_hw.safety import SafetyError
from bench_hw.trial_file.records import TrialWriter

_COAST = 1.0
"""How long recording goes on after a fault, s."""
_SPEED = 5e-3
_HOME_TIME = 10.0


@dataclass(frozen=True, slots=True)
class Fault:
    """What ended a trial: a short kind, what happened, and whether the actuator took the command to go back."""

    kind: str
    message: str
    retracted: bool


@dataclass(frozen=True, slots=True)
class TrialOutcome:
    """How a trial ended: its file (None if that could not be finished), its fault, if any, and readings of position."""

    path: Path | None
    fault: Fault | None = None
    positions: int = 0


def record_trial(
    bench: Bench, protocol: Protocol, writer: TrialWriter, zero: float, context: LoopContext, snapshot: CaptureState
) -> TrialOutcome:
    """Carry a protocol out and record it.

    Parameters
    ----------
    bench : Bench
        The connected, streaming devices.
    protocol : Protocol
        What to do.
    writer : TrialWriter
        The trial's file; closed here, whatever happens.
    zero : float
        Position of the actuator that is depth zero, m.
    context : LoopContext
        Clock, limits, stop flag and progress.
    snapshot : CaptureState
        The state to show.

    Returns
    -------
    TrialOutcome
        Its `fault` is None only if the protocol came to its end and the file is whole.
    """
    recorder = Recorder(writer, zero)
    loop = Loop(bench, context, recorder, zero, snapshot)
    fault = None
    try:
        loop.run(carry_out(protocol, loop.now))
    except BaseException as error:
        fault = _ended(loop, error, recorder, context, writer)
        if not isinstance(error, BenchError | OSError):
            _close(writer)
            raise
    path, problem = _close(writer)
    return TrialOutcome(path, fault or problem, recorder.positions)


def _ended(loop: Loop, error: BaseException, recorder: Recorder, context: LoopContext, writer: TrialWriter) -> Fault:
    """End a trial safely; a second Ctrl-C meanwhile closes its file at once, so that nothing has to be recovered."""
    try:
        return end_safely(loop, error, recorder, context)
    except KeyboardInterrupt:
        _close(writer)
        raise


def end_safely(loop: Loop, error: BaseException, recorder: Recorder | None, context: LoopContext) -> Fault:
    """Send the tool back, note the fault and keep recording for a moment; give the fault."""
    problem = loop.send_back()
    ending = "the tool was sent back"
    if problem:
        ending = (
            f"the tool could NOT be sent back within {RETRACT_TIME:g} s ({problem}): cut the actuator's power and "
            "turn it back by hand"
        )
    fault = Fault(_kind(error), f"{str(error) or type(error).__name__}; {ending}", not problem)
    context.progress.say(f"fault ({fault.kind}): {fault.message}")
    if recorder is not None:
        with suppress(TrialFileError):
            recorder.event(context.clock.now(), fault.kind, fault.message, "fault")
        loop.coast(_COAST)
    return fault


def _close(writer: TrialWriter) -> tuple[Path | None, Fault | None]:
    try:
        return writer.close(), None
    except TrialFileError as error:
        return None, Fault("disk", f"{error}; run `python -m bench_hw recover` on {writer.path}", True)


def _kind(error: BaseException) -> str:
    if isinstance(error, SafetyError):
        return error.kind
    named = {MotionError: "motion", TrialFileError: "disk", OSError: "disk"}
    return next((kind for known, kind in named.items() if isinstance(error, known)), "unexpected")


def find_zero(bench: Bench, order: CaptureOrder, context: LoopContext) -> float:
    """Find the position (m) of depth zero and bring the tool to where a trial begins.

    Where the replayed trial had it or the rig's `actuator.contact` says; else where the protocol's own approach
    touches, tried once; else fully retracted. A protocol that only rests stays where the tool is, and without a
    contact that place is depth zero.

    Raises
    ------
    BenchError
        Nothing is touched, a depth would be outside the travel, or anything unsafe; the tool was sent back.
    """
    contact, protocol = bench.contact, order.protocol.protocol
    if not protocol.moves:
        return bench.actuator.position() if contact is None else contact
    if contact is None and protocol.approach is not None:
        bench.zero_force()
        context.progress.say("touching once to find depth zero (the rig file gives no actuator.contact)")
        alone = protocol.model_copy(update={"segments": (protocol.approach,)})
        start = bench.actuator.position()
        contact = move(bench, context, start, lambda now: carry_out(alone, now)).zero
    elif contact is None:
        context.progress.say("depth is counted from fully retracted: no actuator.contact and no approach")
        contact = 0.0
    low, high = order.rig.rig.travel
    begin = min(max(contact + protocol.rest_depth, low), high)
    speed = min(_SPEED, order.rig.rig.actuator.max_speed)
    move(bench, context, contact, lambda now: go_to(begin, speed, now))
    check_depths(order, contact)
    return contact


def move(
    bench: Bench, context: LoopContext, zero: float, script: Callable[[Observation], Iterator[Action]]
) -> Observation:
    """Carry a motion out without recording it, watched like a trial; give what was seen last.

    Raises
    ------
    BenchError
        Whatever went wrong; the tool was sent back.
    """
    loop = Loop(bench, context, None, zero, CaptureState())
    try:
        loop.run(script(loop.now))
    except BaseException as error:
        end_safely(loop, error, None, context)
        raise
    return loop.now


def go_home(bench: Bench, context: LoopContext) -> None:
    """Send the tool to the lower end of its travel and wait until it is there, 10 s at most.

    Raises
    ------
    DeviceError
        The actuator is lost.
    """
    low = context.limits.travel[0]
    bench.actuator.retract()
    end = context.clock.now() + _HOME_TIME
    while context.clock.now() < end and bench.actuator.position() > low + bench.actuator.uncertainty:
        context.clock.sleep(0.02)
