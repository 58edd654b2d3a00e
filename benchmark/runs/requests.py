"""What `run` was asked for, carried out one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.runs.destination import destination
from benchmark.runs.folder import RunOutcome, write_run
from benchmark.runs.listener import Listener
from benchmark.runs.options import RunOptions
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.session_run import run_session
from benchmark.sessions import SHIPPED

DEFAULT_SCENARIO = "skin-5N"
DEFAULT_SESSION = "phantom"


@dataclass(frozen=True)
class RunRequest:
    """What the command line asked for; see `python -m benchmark run --help`."""

    scenario: str | None = None
    trials: Path | None = None
    specimen: str | None = None
    settings: Mapping[str, str] | None = None
    out: Path | None = None


def carry_out(request: RunRequest, options: RunOptions, listener: Listener) -> list[RunOutcome]:
    """Run a scenario, a session, or, with neither, the shipped ones.

    Raises
    ------
    InputError
        Options that do not go together, or unusable input; nothing is written then.
    SolverError
        A model's process failed.
    """
    if request.scenario is not None and request.trials is not None:
        raise InputError("SCENARIO and --trials exclude each other: a session brings its own tool, support and load")
    if request.specimen is not None and request.trials is None:
        raise InputError("--specimen names the tissue of trials: give --trials SESSION with it")
    if request.trials is not None:
        return [_session(request, request.trials, request.out, options, listener)]
    if request.scenario is not None:
        return [_scenario(request, request.scenario, request.out, options, listener)]
    if request.settings:
        raise InputError("--set needs a SCENARIO or --trials, so that it is clear what it changes")
    return _shipped(request, options, listener)


def _shipped(request: RunRequest, options: RunOptions, listener: Listener) -> list[RunOutcome]:
    """The phantom session and the 5 N press, each in a folder of its own."""
    outs = [None if request.out is None else request.out / name for name in (DEFAULT_SESSION, DEFAULT_SCENARIO)]
    return [
        _session(request, SHIPPED / DEFAULT_SESSION, outs[0], options, listener),
        _scenario(request, DEFAULT_SCENARIO, outs[1], options, listener),
    ]


def _scenario(request: RunRequest, name: str, out: Path | None, options: RunOptions, listener: Listener) -> RunOutcome:
    scenario = load_scenario(name, request.settings or {})
    folder = destination(out, scenario.name)
    return write_run(run_scenario(scenario, options, listener), folder)


def _session(request: RunRequest, path: Path, out: Path | None, options: RunOptions, listener: Listener) -> RunOutcome:
    record = run_session(path, request.specimen, request.settings or {}, options, listener)
    return write_run(record, destination(out, record.name))
