"""`Loop`: the turns in which all devices are read, watched and recorded, on one clock, by one thread.

A turn takes a millisecond or two: drain the force sensor and check every sample first of all, ask the actuator when it
is due, take the camera's frames, then let the protocol decide. Nothing here waits for the disk: `Recorder` hands
records to the trial file's queue.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

from bench_hw.capture.progress import CaptureState, ProgressDisplay, stopped_by
from bench_hw.clock import Clock
from bench_hw.devices.protocols import CameraFrame, ForceBlock
from bench_hw.errors import BenchError, DeviceError
from bench_hw.motion.steps import Action, Halt, MotionError, MoveTo, Note, Observation
from bench_hw.rig.bench import Bench
from bench_hw.safety import SafetyError, SafetyLimits, SafetyMonitor
from bench_hw.trial_file.records import EventRecord, ForceRecord, FrameRecord, Level, PositionRecord, TrialWriter

RETRACT_TIME = 3.0
"""How long the tool's way back is tried for while the actuator is lost, s."""
_RETRACT_PAUSE = 0.05
_EARLY = 1e-6
_PICTURES = 31
"""Pictures whose rate is shown: the last second's of a webcam."""


class Recorder:
    """Writes one trial.

    Parameters
    ----------
    writer : TrialWriter
        The trial's file.
    zero : float
        Position of the actuator that is depth zero, m.
    """

    def __init__(self, writer: TrialWriter, zero: float) -> None:
        self._writer, self._zero = writer, zero
        self.positions = 0

    def force(self, block: ForceBlock) -> None:
        """Write each sample of a block."""
        counts = [None] * len(block) if block.counts is None else block.counts.tolist()
        rows = zip(
            block.time.tolist(),
            block.rdt_sequence.tolist(),
            block.ft_sequence.tolist(),
            block.status.tolist(),
            block.wrench.tolist(),
            counts,
            strict=True,
        )
        for time, rdt, ft, status, wrench, raw in rows:
            self._writer.write_force(
                ForceRecord(
                    time,
                    rdt,
                    ft,
                    status,
                    tuple(wrench[:3]),
                    tuple(wrench[3:]),
                    None if raw is None else tuple(raw),
                )
            )

    def position(self, time: float, position: float, counts: int | None, target: float | None) -> None:
        """Write one position of the actuator (m) and where it was sent."""
        self.positions += 1
        depth_of_target = None if target is None else target - self._zero
        self._writer.write_position(PositionRecord(time, position - self._zero, counts, depth_of_target))

    def frames(self, frames: Iterable[CameraFrame]) -> None:
        """Write pictures."""
        for frame in frames:
            self._writer.write_frame(FrameRecord(frame.time, frame.number, frame.data, frame.format))

    def event(self, time: float, kind: str, message: str, level: Level = "info") -> None:
        """Write something that happened."""
        self._writer.write_event(EventRecord(time, kind, message, level))


@dataclass(frozen=True, slots=True)
class LoopContext:
    """What a loop works with besides the devices.

    Parameters
    ----------
    clock : Clock
        The bench's clock.
    limits : SafetyLimits
        What is safe.
    stop : threading.Event
        Set by Ctrl-C.
    progress : ProgressDisplay
        What a person sees.
    turn : float
        Rest between two turns, s.
    """

    clock: Clock
    limits: SafetyLimits
    stop: threading.Event
    progress: ProgressDisplay
    turn: float = 1e-3


class Loop:
    """The turns of one trial, or of a motion that is not recorded.

    Parameters
    ----------
    bench : Bench
        The connected, streaming devices.
    context : LoopContext
        Clock, limits, stop flag and progress.
    recorder : Recorder or None
        Where samples go; None records nothing.
    zero : float
        Position of the actuator that is depth zero, m.
    snapshot : CaptureState
        The state to show.
    """

    def __init__(
        self, bench: Bench, context: LoopContext, recorder: Recorder | None, zero: float, snapshot: CaptureState
    ) -> None:
        self._bench, self._context, self._recorder = bench, context, recorder
        self._zero, self._snapshot, self._clock = zero, snapshot, context.clock
        self._began = self._next_position = self._clock.now()
        self._target: float | None = None
        self._monitor = SafetyMonitor(context.limits, self._began, bench.actuator.uncertainty)
        self._pictures: deque[float] = deque(maxlen=_PICTURES)
        self._seen: bytes | None = None
        self.now = Observation(self._began, 0.0, 0.0, zero, bench.actuator.uncertainty, context.limits.travel)

    def run(self, script: Iterator[Action]) -> None:
        """Turn until the script ends.

        Raises
        ------
        BenchError
            Whatever is unsafe, lost, interrupted or cannot be written; the tool has NOT been sent back yet.
        """
        self._drain()
        while True:
            self._turn()
            if not self._obey(script):
                return
            self._clock.sleep(self._context.turn)

    def send_back(self) -> str:
        """Send the tool back at once; while the actuator is lost, go on recording and try again.

        Returns
        -------
        str
            Empty, or why the actuator did not take the command.
        """
        deadline = self._clock.now() + RETRACT_TIME
        while True:
            try:
                self._bench.actuator.retract()
            except DeviceError as error:
                if self._clock.now() >= deadline:
                    return str(error)
                self.coast(_RETRACT_PAUSE)
            else:
                self._target = self._context.limits.travel[0]
                return ""

    def coast(self, duration: float) -> None:
        """Go on recording for `duration` seconds without watching, deciding or complaining: after a fault."""
        end = self._clock.now() + duration
        while self._clock.now() < end:
            for part in (self._record_force, self._record_position, self._record_frames):
                try:
                    part()
                except BenchError:
                    continue  # that something is wrong is known already
            self._clock.sleep(self._context.turn)

    def _drain(self) -> None:
        with self._blaming("force_lost"):
            self._bench.force.read()
        if self._bench.camera is not None:
            with self._blaming("camera_lost"):
                self._bench.camera.read()

    def _turn(self) -> None:
        if self._context.stop.is_set():
            raise SafetyError("interrupted", f"stopped by {stopped_by(self._context.stop)}", self._clock.now())
        self._force()
        self._confirmed(lambda: self._monitor.check_fresh(self._clock.now()), self._force)
        self._monitor.check_position(self._record_position(), self._clock.now())
        if self._bench.camera is not None:
            self._camera()
        self.now.time = self._clock.now()
        self._show()

    def _confirmed(self, check: Callable[[], None], read_again: Callable[[], None]) -> None:
        """Check, and once more after simulated devices that a busy machine held up have caught up."""
        try:
            check()
        except SafetyError:
            self._bench.catch_up()
            self._clock.settle()
            read_again()
            check()

    def _force(self) -> None:
        with self._blaming("force_lost"):
            block = self._bench.force.read()
        if not len(block):
            return
        try:
            self._monitor.check_force(block)
        finally:
            if self._recorder is not None:
                self._recorder.force(block)
        self.now.press = float(self._bench.press(block)[-1])

    def _record_force(self) -> None:
        block = self._bench.force.read()
        if self._recorder is not None:
            self._recorder.force(block)

    def _record_position(self) -> float:
        before = self._clock.now()
        if before < self._next_position - _EARLY:
            return self.now.position
        actuator = self._bench.actuator
        period = 1.0 / self._bench.rig.actuator.rate
        self._next_position = max(self._next_position + period, before + 0.5 * period)
        with self._blaming("actuator_lost"):
            self.now.position = actuator.position()
        if self._recorder is not None:
            time = 0.5 * (before + self._clock.now())
            self._recorder.position(time, self.now.position, actuator.counts, self._target)
        return self.now.position

    def _camera(self) -> None:
        """Record pictures and check that they come; a fault of the camera itself is none of what may come late."""
        found = [self._record_frames()]
        self._confirmed(
            lambda: self._monitor.check_camera(found[-1][0], self._clock.now(), found[-1][1]),
            lambda: found.append(self._record_frames()),
        )

    def _record_frames(self) -> tuple[int, int]:
        """Record the pictures that have come: how many, and how many of them are the one before to the byte."""
        if self._bench.camera is None:
            return 0, 0
        with self._blaming("camera_lost"):
            frames = self._bench.camera.read()
        if self._recorder is not None:
            self._recorder.frames(frames)
        self._pictures.extend(frame.time for frame in frames)
        seen = [self._seen, *(frame.data for frame in frames)]
        self._seen = seen[-1]
        return len(frames), sum(one == other for one, other in pairwise(seen))

    def _obey(self, script: Iterator[Action]) -> bool:
        """Do what the script says until it waits; False at its end."""
        for action in script:
            if action is None:
                return True
            with self._blaming("actuator_lost"):
                self._do(action)
        return False

    def _do(self, action: MoveTo | Halt | Note) -> None:
        if isinstance(action, Note):
            self._snapshot.doing = action.message
            if self._recorder is not None:
                self._recorder.event(self._clock.now(), action.kind, action.message)
        elif isinstance(action, MoveTo):
            self._bench.actuator.move_to(action.position, action.speed)
            self._target = action.position
        else:
            self._bench.actuator.halt()
            self._target = self.now.position

    def _show(self) -> None:
        shown = self._snapshot
        shown.elapsed = self.now.time - self._began
        shown.depth, shown.press = self.now.position - self._zero, self.now.press
        shown.lost = self._bench.force.health.lost
        if (camera := self._bench.camera) is not None:
            shown.camera, shown.dropped = _rate(self._pictures), camera.health.dropped
        self._context.progress.update(shown)

    @contextmanager
    def _blaming(self, kind: str) -> Iterator[None]:
        """Give what a driver raises the name of its device."""
        try:
            yield
        except (SafetyError, MotionError):
            raise
        except DeviceError as error:
            raise SafetyError(kind, str(error), self._clock.now()) from error


def _rate(times: deque[float]) -> float:
    """Pictures per second; 0 before the second."""
    return (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 and times[-1] > times[0] else 0.0
