"""`capture`: a session of trials from an order: devices checked, tool brought up, trials recorded, files written."""

from __future__ import annotations

import hashlib
import json
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from bench_hw.capture.loop import LoopContext
from bench_hw.capture.order import CaptureOrder, check_order, check_replay
from bench_hw.capture.progress import CaptureState, ProgressDisplay, stop_on_signals, stopped_by
from bench_hw.capture.session_folder import (
    CAMERA_FILE,
    LOG_FILE,
    SESSION_FILE,
    SessionFolder,
    camera_place,
    camera_text,
)
from bench_hw.capture.trial import Fault, TrialOutcome, find_zero, go_home, record_trial
from bench_hw.clock import Clock, MonotonicClock, SimulatedClock, wait_until
from bench_hw.errors import DeviceError, InputError, system_words
from bench_hw.motion.plan import plan
from bench_hw.rig.bench import Bench
from bench_hw.rig.opening import open_bench
from bench_hw.safety import SafetyLimits
from bench_hw.storage.folder_lock import locked
from bench_hw.trial_file import open_trial
from bench_hw.trial_file.records import TrialHeader

if TYPE_CHECKING:
    from bench_hw.simulated.specimen import Specimen

_TURN, _SIMULATED_TURN = 1e-3, 2e-3
_LARGEST_LATENCY = 0.5
_SAME_RATE, _LEAST_TIME = 0.1, 0.5
"""Relative difference of two rates of the force that are one, and the time (s) from which it is told."""
_LATE = 0.5
"""Share of the readings of position that a rig asks for, below which it is told."""
_SWITCH_INTERVAL = 5e-4
"""How often threads take turns while trials are recorded, s: the loop must not wait for a drawing."""


@dataclass(frozen=True, slots=True)
class SessionOutcome:
    """What a capture made: its folder, the finished trials and the fault that ended it, if any."""

    folder: Path
    trials: tuple[Path, ...]
    fault: Fault | None


def capture(order: CaptureOrder, progress: ProgressDisplay, *, specimen: Specimen | None = None) -> SessionOutcome:
    """Record a session.

    Parameters
    ----------
    order : CaptureOrder
        What is asked for.
    progress : ProgressDisplay
        What a person sees.
    specimen : Specimen, optional
        What lies under a simulated tool.

    Returns
    -------
    SessionOutcome
        Its `fault` names what ended the session early; the trial it happened in is in the folder, but not in
        `session.toml`.

    Raises
    ------
    InputError
        The order cannot be carried out; nothing moved.
    DeviceError
        A device is missing, wrong or silent; nothing moved and there is no trial file. Or something went wrong
        before the first trial; then the tool was sent back.
    """
    check_order(order)
    with locked(order.out, "capture"):
        return _captured(order, progress, specimen)


def _captured(order: CaptureOrder, progress: ProgressDisplay, specimen: Specimen | None) -> SessionOutcome:
    folder = SessionFolder(order)
    clock: Clock = SimulatedClock(step=_SIMULATED_TURN) if order.fast else MonotonicClock()
    try:
        with (
            stop_on_signals() as stop,
            _short_turns(),
            open_bench(order.rig, clock, specimen=specimen, seed=folder.seed(order)) as bench,
        ):
            return _Session(order, folder, bench, _loop_context(order, bench, clock, stop, progress)).run()
    finally:
        folder.abandon()


class _Session:
    def __init__(self, order: CaptureOrder, folder: SessionFolder, bench: Bench, context: LoopContext) -> None:
        self._order, self._folder, self._bench, self._context = order, folder, bench, context
        self._condition = order.condition or order.protocol.protocol.name
        self._done: list[Path] = []
        self._calibrations: dict[str, str] = {}
        self._counted: dict[str, dict[str, int]] = {}

    def run(self) -> SessionOutcome:
        if self._bench.replay is not None:
            check_replay(self._order, self._bench.replay.header)
        self._bench.start()
        with self._context.progress.showing():
            zero = find_zero(self._bench, self._order, self._context)
            try:
                self._begin_files()
                fault = self._record_all(zero)
            finally:  # also when a file between two trials cannot be written: a tool that moved never stays
                if self._order.protocol.protocol.moves:
                    with suppress(DeviceError):
                        go_home(self._bench, self._context)
        return SessionOutcome(self._folder.path, tuple(self._done), fault)

    def _record_all(self, zero: float) -> Fault | None:
        self._health()
        for number in range(1, self._order.trials + 1):
            if number > 1 and not self._rest():
                by = stopped_by(self._context.stop)
                return Fault("interrupted", f"stopped by {by} between two trials; the tool was sent back", True)
            outcome = self._record(number, zero)
            if outcome.fault is not None:
                return outcome.fault
        return None

    def _record(self, number: int, zero: float) -> TrialOutcome:
        protocol = self._order.protocol.protocol
        if self._bench.twins is not None:
            self._bench.twins.lay_anew()
        self._bench.zero_force()
        self._count_from_here()
        name = self._folder.next_trial()
        header = self._header(name, zero)
        writer = open_trial(self._folder.path / f"{name}.mcap", header, background=not self._order.fast)
        self._bench.begin_trial(header.clock_epoch)
        snapshot = CaptureState(number, self._order.trials, planned=plan(protocol).duration)
        outcome = record_trial(self._bench, protocol, writer, zero, self._context, snapshot)
        try:
            self._note(outcome, header)
        except OSError as error:
            if outcome.fault is None:
                error.add_note(f"{outcome.path} is whole; what stands beside it ({SESSION_FILE}, {LOG_FILE}) is behind")
                raise
            words = f"{outcome.fault.message}; {LOG_FILE} cannot be written either ({system_words(error)})"
            return replace(outcome, fault=replace(outcome.fault, message=words))
        return outcome

    def _note(self, outcome: TrialOutcome, header: TrialHeader) -> None:
        health = self._health()
        self._tell(header, health, outcome.positions)
        if outcome.path is not None and outcome.fault is None:
            self._done.append(outcome.path)
            self._folder.add_trial(outcome.path, self._condition)
        entry = {
            "file": outcome.path.name if outcome.path else f"{header.name}.mcap.part",
            "condition": self._condition,
            "started": header.started,
            **health,
            "fault": None if outcome.fault is None else asdict(outcome.fault),
        }
        self._folder.write_log(self._order, self._bench.infos(), entry)

    def _tell(self, header: TrialHeader, health: dict[str, dict[str, int]], positions: int) -> None:
        """Say what a trial lacks; of a replayed one it was said when it was recorded."""
        if self._bench.replay is not None:
            return
        elapsed = self._context.clock.now() - header.clock_epoch
        rates = self._bench.force.rate, self._bench.rig.actuator.rate
        said = [*_missing(health), *_other_rate(health["force"], elapsed, rates[0])]
        if elapsed > _LEAST_TIME and positions < _LATE * rates[1] * elapsed:
            said.append(
                f"depth came at {positions / elapsed:.3g} Hz, and the rig asks for {rates[1]:g} Hz (actuator.rate): "
                "the board answers late"
            )
        for each in said:
            self._context.progress.say(f"{header.name}: {each}")

    def _count_from_here(self) -> None:
        """Take what waits since the trial before: what was lost of it, where nobody read, is none of this trial's."""
        for device in (self._bench.force, self._bench.camera):
            with suppress(DeviceError):  # the trial will meet it
                if device is not None:
                    device.read()
        self._health()

    def _health(self) -> dict[str, dict[str, int]]:
        """Counts of each stream since the last time this was asked."""
        camera = self._bench.camera
        counts = {"force": asdict(self._bench.force.health)}
        if camera is not None:
            counts["camera"] = asdict(camera.health)
        before, self._counted = self._counted, counts
        return {
            device: {name: value - before.get(device, {}).get(name, 0) for name, value in found.items()}
            for device, found in counts.items()
        }

    def _begin_files(self) -> None:
        order = self._order
        keys: dict[str, dict[str, object]] = {}
        if self._bench.twins is not None:
            keys = getattr(self._bench.twins.settings.specimen, "session_keys", dict)()
        if order.rig.rig.camera is None:
            keys.pop("camera", None)
        text = camera_text(order.rig)
        if text is not None:
            self._calibrations["camera"] = hashlib.sha256(text.encode()).hexdigest()
            if not order.append:
                self._folder.keep(CAMERA_FILE, text)
            if "camera" in keys:
                keys["camera"] |= {"file": CAMERA_FILE} | camera_place(order.rig.rig)
        self._folder.begin(order, keys)
        if order.append and (other := self._folder.other_rig(order)):
            self._context.progress.say(
                f"--append: the session's trials were recorded with the rig {other!r}, these are with "
                f"{order.rig.rig.name!r}; they are read as trials of one bench"
            )

    def _header(self, name: str, zero: float) -> TrialHeader:
        infos, order = self._bench.infos(), self._order
        settings = {f"{device}.{key}": value for device, info in infos.items() for key, value in info.settings.items()}
        settings |= {"depth_zero": f"{zero * 1e3:.4f} mm", "condition": self._condition, "rig": order.rig.text}
        settings["session"] = json.dumps(self._folder.told)
        return TrialHeader(
            name=name,
            started=datetime.now(UTC).isoformat(),
            clock_epoch=self._context.clock.now(),
            press_axis=order.rig.rig.force.press_axis,
            protocol=order.protocol.protocol.name,
            protocol_text=order.protocol.text,
            serials={device: info.serial for device, info in infos.items() if info.serial},
            calibrations=self._calibrations | {d: info.calibration for d, info in infos.items() if info.calibration},
            settings=settings,
            synthetic=order.rig.rig.synthetic,
        )

    def _rest(self) -> bool:
        """Wait between two trials; False if that was interrupted."""
        return not wait_until(self._context.clock, self._context.stop.is_set, self._order.pause, interval=0.05)


def _missing(health: dict[str, dict[str, int]]) -> Iterator[str]:
    """Say what of a trial's samples and pictures did not come, or came for nothing."""
    force, camera = health["force"], health.get("camera", {})
    if lost := force["lost"]:
        yield f"{lost} of {force['received'] + lost} force records are lost"
    if malformed := force["malformed"]:
        yield f"{malformed} datagrams of the force sensor were no records"
    if dropped := camera.get("dropped", 0):
        yield f"{dropped} of {camera['received'] + dropped} pictures are lost"
    if frozen := camera.get("frozen", 0):
        yield f"{frozen} of {camera['received']} pictures are the one before to the byte"


def _other_rate(force: dict[str, int], elapsed: float, rate: float) -> Iterator[str]:
    """Say where the sensor's samples came at another rate (Hz) than it tells; `elapsed` in s."""
    came = (force["received"] + force["lost"]) / elapsed if elapsed > _LEAST_TIME else rate
    if abs(came - rate) > _SAME_RATE * rate:
        yield (
            f"force came at {came:.4g} Hz, and the sensor tells of {rate:g} Hz; samples have their time of arrival, "
            "those of one datagram are spaced by what it tells"
        )


def _loop_context(
    order: CaptureOrder, bench: Bench, clock: Clock, stop: threading.Event, progress: ProgressDisplay
) -> LoopContext:
    rig = order.rig.rig
    if bench.force.latency > _LARGEST_LATENCY * rig.safety.force_stale:
        raise InputError(
            f"{order.rig.path}: the force sensor delivers every {bench.force.latency * 1e3:g} ms in this mode; allowed "
            f"is {_LARGEST_LATENCY:g} of safety.force_stale ({rig.safety.force_stale * 1e3:g} ms): use realtime mode"
        )
    limits = SafetyLimits(
        rig.safety.force_limit,
        rig.safety.force_stale,
        bench.travel,
        tuple(bench.force.ranges.tolist()),
        rig.force_frozen,
        rig.camera_silent,
        rig.camera_frozen,
    )
    return LoopContext(clock, limits, stop, progress, _SIMULATED_TURN if order.fast else _TURN)


@contextmanager
def _short_turns() -> Iterator[None]:
    before = sys.getswitchinterval()
    sys.setswitchinterval(_SWITCH_INTERVAL)
    try:
        yield
    finally:
        sys.setswitchinterval(before)
