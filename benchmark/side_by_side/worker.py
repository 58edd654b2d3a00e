"""The child process: one model, one core, one thread, and what passes between it and the harness."""

from __future__ import annotations

import os
import re
import sys
import time
import traceback
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from benchmark.child_processes import end_with_parent, output_on_stderr
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.model_file import RepairedModel
from benchmark.models import (
    Drive,
    Keeping,
    ModelResult,
    StepProgress,
    UncoveredError,
    UserFile,
    frame_seconds,
    scenario_drive,
    silent,
)
from benchmark.response.model_with_effects import prepare_with_effects


@dataclass(frozen=True)
class RunCommand:
    """Set the model up and follow the load history, or so many steps of it; `keep_result` False is a timed repeat."""

    keep_result: bool
    steps: int | None = None


@dataclass(frozen=True)
class Remark:
    """What a person should know while the model runs, one sentence."""

    text: str


@dataclass(frozen=True)
class Seconds:
    """One execution: set-up, then wall and CPU time of the load history alone, in s.

    Reading profiles and fields off the finished history counts as neither.
    """

    setup: float
    wall: float
    cpu: float


@dataclass(frozen=True)
class Finished:
    """A finished execution, complete or stopped early.

    Attributes
    ----------
    seconds
        What it took.
    result
        None where it was not asked for; a user's own model gives it every time, to be compared with the first.
    peak_memory
        Of its process in bytes where it is known.
    frame
        Wall s of a picture of all faces (`benchmark.models.wave_parts`); None where it was not timed.
    """

    seconds: Seconds
    result: ModelResult | None
    peak_memory: int | None = None
    frame: float | None = None


@dataclass(frozen=True)
class Declined:
    """The model does not cover the scenario."""

    reason: str


@dataclass(frozen=True)
class Crashed:
    """An exception in the model's process. `input_error` says that the scenario, not the code, is at fault."""

    message: str
    trace: str
    input_error: bool


Answer = Finished | Declined | Crashed
Message = StepProgress | Remark | Answer


@dataclass(frozen=True)
class ModelJob:
    """What a process is for: a model's place, the scenario, whether fields are kept, and what a user puts there.

    `keep` is the folder in which an execution whose result is wanted keeps what an interruption would lose.
    """

    model: str
    scenario: Scenario
    every_field: bool = False
    own: UserFile | RepairedModel | None = None
    keep: Path | None = None


@output_on_stderr()
def serve(connection: Connection, job: ModelJob, core: int | None) -> None:
    """Answer `RunCommand`s on `connection` until `None` or its end arrives, or the parent is gone.

    What is written to stdout goes to stderr.
    """
    end_with_parent()
    if core is not None and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {core})
    try:
        while (command := connection.recv()) is not None:
            connection.send(_execute(connection, command, job))
    except (EOFError, BrokenPipeError, KeyboardInterrupt):
        return


def _execute(connection: Connection, command: RunCommand, job: ModelJob) -> Answer:
    """Run once and turn whatever happens into an answer."""
    try:
        return _run(connection, command, job)
    except UncoveredError as error:
        return Declined(str(error))
    except InputError as error:
        return Crashed(str(error), traceback.format_exc(), input_error=True)
    except Exception as error:
        return Crashed(f"{type(error).__name__}: {error}", traceback.format_exc(), input_error=False)


def _run(connection: Connection, command: RunCommand, job: ModelJob) -> Finished:
    """Set up, run and time; a picture is drawn where no result is wanted, so that it runs beside no other model.

    A run without a result is timed, and neither keeps nor takes up anything.
    """

    def report(progress: StepProgress) -> None:
        connection.send(progress)

    def say(text: str) -> None:
        connection.send(Remark(text))

    whole = scenario_drive(job.scenario)
    drive = Drive(whole.control, whole.time[: command.steps], whole.value[: command.steps])
    keeping = Keeping(job.keep, say) if command.keep_result and job.keep is not None else None
    started = time.perf_counter()
    prepared = prepare_with_effects(
        job.model,
        job.scenario,
        every_field=job.every_field and command.keep_result,
        own=job.own,
        keeping=keeping,
        judge_mesh=command.keep_result,
    )
    ready, cpu_ready = time.perf_counter(), time.process_time()
    reading = prepared.follow(drive, report if command.keep_result else silent)
    wall, cpu = time.perf_counter() - ready, time.process_time() - cpu_ready
    result = reading() if command.keep_result or isinstance(job.own, UserFile) else None
    memory = peak_memory()
    frame = None if command.keep_result else frame_seconds(prepared, drive)
    return Finished(Seconds(ready - started, wall, cpu), result, memory, frame)


def peak_memory() -> int | None:
    """The most memory this process has held, in bytes; None where the system does not tell.

    Linux says it in `/proc/self/status`; its `ru_maxrss` also counts the process that this one was started from.
    """
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        return _by_usage()
    held = re.search(r"^VmHWM:\s+(\d+) kB$", status, re.MULTILINE)
    return 1024 * int(held[1]) if held else _by_usage()


def _by_usage() -> int | None:
    try:
        import resource
    except ImportError:
        return None
    held = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return held if sys.platform == "darwin" else 1024 * held
