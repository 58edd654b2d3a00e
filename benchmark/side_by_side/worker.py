"""The child process: one model, one core, one thread, answering commands until it is told to stop."""

from __future__ import annotations

import os
import time
import traceback
from multiprocessing.connection import Connection

from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models import StepProgress, UncoveredError, prepare, scenario_drive, silent
from benchmark.side_by_side.messages import Answer, Crashed, Declined, Finished, RunCommand, Seconds


def serve(connection: Connection, model: str, scenario: Scenario, every_field: bool, core: int | None) -> None:
    """Answer `RunCommand`s on `connection` until `None` or its end arrives."""
    if core is not None and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {core})
    try:
        while (command := connection.recv()) is not None:
            connection.send(_execute(connection, command, model, scenario, every_field))
    except (EOFError, BrokenPipeError, KeyboardInterrupt):
        return


def _execute(connection: Connection, command: RunCommand, model: str, scenario: Scenario, every_field: bool) -> Answer:
    """Run once and turn whatever happens into an answer."""
    try:
        return _run(connection, command, model, scenario, every_field)
    except UncoveredError as error:
        return Declined(str(error))
    except InputError as error:
        return Crashed(str(error), traceback.format_exc(), input_error=True)
    except Exception as error:
        return Crashed(f"{type(error).__name__}: {error}", traceback.format_exc(), input_error=False)


def _run(connection: Connection, command: RunCommand, model: str, scenario: Scenario, every_field: bool) -> Finished:
    """Set up, run and time."""

    def report(progress: StepProgress) -> None:
        connection.send(progress)

    drive = scenario_drive(scenario)
    started = time.perf_counter()
    prepared = prepare(model, scenario, every_field=every_field and command.keep_result)
    ready, cpu_ready = time.perf_counter(), time.process_time()
    result = prepared.run(drive, report if command.keep_result else silent)
    wall, cpu = time.perf_counter() - ready, time.process_time() - cpu_ready
    return Finished(Seconds(ready - started, wall, cpu), result if command.keep_result else None)
