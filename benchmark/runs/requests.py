"""What `run` was asked for, carried out one after the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario
from benchmark.files.load import load_history
from benchmark.models import NOTHING, Own, read_reference, read_user_file
from benchmark.response.model_with_effects import load_repair
from benchmark.runs.options import Listener, RunOptions
from benchmark.runs.output.destination import NEEDED, claimed, destination
from benchmark.runs.output.run_folder import RunOutcome, write_run
from benchmark.runs.output.unfinished import unfinished
from benchmark.runs.record import RunRecord
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.session_run import run_session
from benchmark.runs.tissues_run import run_tissues
from benchmark.sessions import HIDDEN_EFFECT, SHIPPED
from reports.manifest import read_manifest

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
    wave: Path | None = None
    reference: Path | None = None
    tissues: Sequence[str] = ()
    model: Path | None = None
    effects: Path | None = None


def carry_out(request: RunRequest, options: RunOptions, listener: Listener) -> list[RunOutcome]:
    """Run a scenario, a session, or, with neither, the shipped ones.

    Raises
    ------
    InputError
        Options that do not go together, or unusable input; nothing is written then.
    SolverError
        A model's process failed.
    """
    _check_together(request)
    with claimed(request.out, "run"):
        _check_places(request)
        return _carried_out(request, options, listener)


def _carried_out(request: RunRequest, options: RunOptions, listener: Listener) -> list[RunOutcome]:
    """Run what was asked for, each where its result goes."""
    if request.trials is not None:
        return [_session(request, request.trials, request.out, options, listener)]
    if request.scenario is not None and len(request.tissues) > 1:
        return run_tissues(
            request.scenario, request.tissues, request.settings or {}, request.out, _own(request), options, listener
        )
    if request.scenario is not None:
        return [_scenario(request, request.scenario, request.out, options, listener)]
    return _shipped(request, options, listener)


def computed(request: RunRequest, options: RunOptions, listener: Listener) -> RunRecord:
    """Run one scenario or one session; nothing is written.

    Raises
    ------
    InputError, SolverError
        As `carry_out`; a request for neither, or for several tissues, is an InputError.
    """
    _check_together(request)
    if request.trials is not None:
        return _session_record(request, request.trials, options, listener)
    if request.scenario is None or len(request.tissues) > 1:
        raise InputError("give a scenario or trials, and at most one tissue")
    scenario = _chosen(request, request.scenario)
    return run_scenario(scenario, options, listener, warnings=_idle(request), own=_own(request, scenario))


def _check_together(request: RunRequest) -> None:
    """Refuse options that do not go together."""
    if request.scenario is not None and request.trials is not None:
        raise InputError("SCENARIO and --trials exclude each other: a session brings its own tool, support and load")
    if request.specimen is not None and request.trials is None:
        raise InputError("--specimen names the tissue of trials: give --trials SESSION with it")
    if request.trials is None and request.scenario is None and (request.settings or request.wave):
        raise InputError("--set and --wave need a SCENARIO or --trials, so that it is clear what they change")
    if request.scenario is None and (request.reference or request.tissues):
        raise InputError("--reference and --tissue belong to a SCENARIO: a session's press and specimen are its own")
    if request.tissues and "tissue" in (request.settings or {}):
        raise InputError("--tissue and --set tissue=... name the same thing: give one of them")
    if request.model is not None and request.wave is not None:
        raise InputError("--model and --wave exclude each other: a model file repairs the wave model of the harness")
    if request.effects is not None and request.model is None:
        raise InputError("--effects brings effects that a model file names: give --model with it")
    if request.model is not None and request.trials is None and request.scenario is None:
        raise InputError("--model needs a SCENARIO or --trials, so that it is clear what it is tried on")
    if request.reference is not None and len(request.tissues) > 1:
        raise InputError("--reference is the FEA of one tissue: give one --tissue with it, or none")


def _check_places(request: RunRequest) -> None:
    """Refuse an `--out` that would lose something, or cannot be written, before anything is computed."""
    texts = (request.scenario, request.specimen, *request.tissues, *(request.settings or {}).values())
    inputs = (request.trials, request.wave, request.reference, request.model, request.effects, *texts)
    shipped = request.scenario is None and request.trials is None
    if shipped and request.out is not None and read_manifest(request.out) is not None:
        raise InputError(f"--out {request.out} is a result; run alone makes folders in it, so give another one")
    for name in (DEFAULT_SESSION, DEFAULT_SCENARIO, HIDDEN_EFFECT) if shipped else ("",):
        destination(None if request.out is None else request.out / name, "", inputs)


def _own(request: RunRequest, scenario: Scenario | None = None) -> Own:
    """What the user puts in the place of our models."""
    wave = None if request.wave is None else read_user_file(request.wave)
    repair = None if request.model is None else load_repair(request.model, request.effects)
    reference = None
    if request.reference is not None and scenario is not None:
        reference = read_reference(request.reference, scenario)
    return NOTHING if wave is None and reference is None and repair is None else Own(wave, reference, repair)


IDLE = {"--wave": ("wave.",), "--reference": ("fem.mesh", "fem.radius")}
"""Beginnings of the keys that nothing reads where a user's own model stands in the place of ours."""


def _idle(request: RunRequest) -> tuple[str, ...]:
    """What is set of a model of ours in whose place the user's own stands, a sentence each."""
    given = [name for name, path in (("--wave", request.wave), ("--reference", request.reference)) if path is not None]
    return tuple(
        f"--set {key} has no effect: what {name} names stands in that model's place"
        for name in given
        for key in request.settings or {}
        if key.startswith(IDLE[name])
    )


def _shipped(request: RunRequest, options: RunOptions, listener: Listener) -> list[RunOutcome]:
    """The phantom session and the 5 N press, each in a folder of its own."""
    outs = [None if request.out is None else request.out / name for name in (DEFAULT_SESSION, DEFAULT_SCENARIO)]
    return [
        _session(request, SHIPPED / DEFAULT_SESSION, outs[0], options, listener),
        _scenario(request, DEFAULT_SCENARIO, outs[1], options, listener),
    ]


def _scenario(request: RunRequest, name: str, out: Path | None, options: RunOptions, listener: Listener) -> RunOutcome:
    scenario = _chosen(request, name)
    folder = destination(out, scenario.name, needed=room(scenario, options))
    own = _own(request, scenario)
    with unfinished(folder) as keep:
        options = replace(options, keep=keep)
        return write_run(run_scenario(scenario, options, listener, warnings=_idle(request), own=own), folder)


STEP = {"axisymmetric": 500_000, "block": 8_000_000, "surface": 8_000_000}
"""Bytes of one step's fields on the default mesh, rounded up."""


def room(scenario: Scenario, options: RunOptions) -> int:
    """About how many bytes the result of a run takes: its page and tables, and the fields of its steps."""
    steps = load_history(scenario.load).time.size if options.every_field else 2
    return NEEDED + steps * STEP[scenario.fem.geometry]


def _chosen(request: RunRequest, name: str) -> Scenario:
    """The scenario with its settings and its one other tissue put in."""
    tissue = {"tissue": request.tissues[0]} if request.tissues else {}
    return load_scenario(name, {**(request.settings or {}), **tissue})


def _session(request: RunRequest, path: Path, out: Path | None, options: RunOptions, listener: Listener) -> RunOutcome:
    if out is None:
        record = _session_record(request, path, options, listener)
        return write_run(record, destination(None, record.name))
    with unfinished(destination(out, path.name)) as keep:
        return write_run(_session_record(request, path, replace(options, keep=keep), listener), out)


def _session_record(request: RunRequest, path: Path, options: RunOptions, listener: Listener) -> RunRecord:
    return run_session(path, request.specimen, request.settings or {}, options, listener, _own(request))
