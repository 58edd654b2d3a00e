"""The child process: one model, one core, one thread, answering commands until it is told to stop."""

from __future__ import annotations

import os
import sys
import time
import traceback
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from benchmark.children import end_with_parent
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.model_file import RepairedModel
from benchmark.models import (
    Keeping,
    StepProgress,
    UncoveredError,
    UserFile,
    frame_seconds,
    prepare,
    scenario_drive,
    silent,
)
from benchmark.side_by_side.messages import Answer, Crashed, Declined, Finished, Remark, RunCommand, Seconds


@dataclass(frozen=True)
class Job:
    """What a process is for: a model's place, the scenario, whether fields are kept, and what a user puts there.

    `keep` is the folder in which an execution whose result is wanted keeps what an interruption would lose.
    """

    model: str
    scenario: Scenario
    every_field: bool = False
    own: UserFile | RepairedModel | None = None
    keep: Path | None = None


def serve(connection: Connection, job: Job, core: int | None) -> None:
    """Answer `RunCommand`s on `connection` until `None` or its end arrives, or the parent is gone."""
    end_with_parent()
    if core is not None and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {core})
    try:
        while (command := connection.recv()) is not None:
            connection.send(_execute(connection, command, job))
    except (EOFError, BrokenPipeError, KeyboardInterrupt):
        return


def _execute(connection: Connection, command: RunCommand, job: Job) -> Answer:
    """Run once and turn whatever happens into an answer."""
    try:
        return _run(connection, command, job)
    except UncoveredError as error:
        return Declined(str(error))
    except InputError as error:
        return Crashed(str(error), traceback.format_exc(), input_error=True)
    except Exception as error:
        return Crashed(f"{type(error).__name__}: {error}", traceback.format_exc(), input_error=False)


def _run(connection: Connection, command: RunCommand, job: Job) -> Finished:
    """Set up, run and time; a picture is drawn where no result is wanted, so that it runs beside no other model.

    A run without a result is timed, and neither keeps nor takes up anything.
    """

    def report(progress: StepProgress) -> None:
        connection.send(progress)

    def say(text: str) -> None:
        connection.send(Remark(text))

    drive = scenario_drive(job.scenario)
    keeping = Keeping(job.keep, say) if command.keep_result and job.keep is not None else None
    started = time.perf_counter()
    every_field = job.every_field and command.keep_result
    prepared = prepare(job.model, job.scenario, every_field=every_field, own=job.own, keeping=keeping)
    ready, cpu_ready = time.perf_counter(), time.process_time()
    reading = prepared.follow(drive, report if command.keep_result else silent)
    wall, cpu = time.perf_counter() - ready, time.process_time() - cpu_ready
    result = reading() if command.keep_result else None
    memory = peak_memory()
    frame = None if command.keep_result else frame_seconds(prepared, drive)
    return Finished(Seconds(ready - started, wall, cpu), result, memory, frame)


def peak_memory() -> int | None:
    """The most memory this process has held, in bytes; None where the system does not tell."""
    try:
        import resource
    except ImportError:
        return None
    held = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return held if sys.platform == "darwin" else 1024 * held
