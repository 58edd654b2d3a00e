"""Making a baseline from what is measured now."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.errors import InputError, SolverError, TissuebenchError
from benchmark.gate.accuracy import CURVE, compare_values, farthest_step, wide_remarks
from benchmark.gate.baseline import (
    BASELINE_SIGN,
    Baseline,
    StoredTiming,
    StoredValue,
    differing,
    read_baseline,
    staged_baseline,
    write_baseline,
)
from benchmark.gate.history.history_file import HISTORY_SIGN, HistoryEntry, append
from benchmark.gate.plan import CheckRequest, GatePlan, load_plan
from benchmark.gate.processes import measure
from benchmark.gate.versions import Origin, gated_values, origin_of, this_version
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import check_file, check_ready
from reports.formatting import counted

NEEDED = 1_000_000
"""Bytes of a baseline and a line of its history, with room to spare."""
TIMING_UNIT = "x the reference workload"


@dataclass(frozen=True)
class Step:
    """What a quantity was in the old baseline (None where it was not there) and is in the new one (None: gone)."""

    quantity: str
    unit: str
    old: float | None
    new: float | None

    def words(self) -> str:
        """Old -> new."""
        old, new = ("none" if value is None else f"{value:.9g}" for value in (self.old, self.new))
        return f"{self.quantity}: {old} -> {new} {self.unit}".rstrip()


@dataclass(frozen=True)
class Accepted:
    """A baseline that was written, what changed in it, and what a reader must know."""

    path: Path
    steps: tuple[Step, ...]
    warnings: tuple[str, ...]
    differed: tuple[str, ...] = ()

    @property
    def unseen(self) -> str | None:
        """That values differed which no check will be red for now; None where none did."""
        if not self.differed:
            return None
        return (
            f"accepted, not checked: {differing(self.differed)} from the baseline that was here by more than the gate "
            "allows; a job that accepts each time is green whatever happens"
        )

    def to_dict(self) -> dict[str, Any]:
        """What `check --accept --json` prints."""
        steps = [vars(step).copy() for step in self.steps]
        said = {"warnings": list(self.warnings), "differed": list(self.differed)}
        return {"schema": 1, "accepted": str(self.path), "changes": steps, **said}


def accept(request: CheckRequest, listener: Listener) -> Accepted:
    """Measure this version, write it as the baseline, and add it to the history.

    Raises
    ------
    SolverError
        A gated value does not exist, so that nothing could be compared with it.
    InputError
        `--against` was asked for too, or the gate file cannot be used.
    OSError
        Where the file system refuses; the old baseline then stays.
    """
    if request.against is not None:
        raise InputError("--accept and --against exclude each other: a baseline is made from this version alone")
    plan = load_plan(request.gate)
    for path in (request.baseline_path, request.history_path):
        check_ready(path.absolute().parent, needed=NEEDED)
    check_file(request.baseline_path, "--baseline", BASELINE_SIGN, "a baseline")
    check_file(request.history_path, "--history", HISTORY_SIGN, "a history of checks")
    origin = origin_of(plan, request.seed)
    old, warnings = _old(request.baseline_path, plan.file.name)
    new, wide = _measured(plan, origin, listener)
    differed = _differed(old, new, plan)
    _put_down(request, new.model_copy(update={"differed": differed}))
    return Accepted(request.baseline_path, _steps(old, new), (*warnings, *wide), tuple(differed))


def _differed(old: Baseline | None, new: Baseline, plan: GatePlan) -> list[str]:
    """The values, and curves by their step, that a check against the old baseline would have been red for."""
    before = {} if old is None else old.accuracy
    both = {name: value for name, value in new.accuracy.items() if name in before and before[name].unit == value.unit}
    rows = compare_values(both, {name: before[name] for name in both}, plan.file.tolerances, "the old baseline")
    return [row.label for row in rows if not row.passed]


def _put_down(request: CheckRequest, new: Baseline) -> None:
    """Write baseline and history, both or none; one that cannot be written is kept elsewhere, and that is said."""
    try:
        with staged_baseline(request.baseline_path, new):
            append(request.history_path, _entry(new))
    except OSError as error:
        kept = Path(tempfile.mkdtemp(prefix="tissuebench-kept-")) / request.baseline_path.name
        write_baseline(kept, new)
        raise InputError(
            f"{request.baseline_path} and its history cannot be written and are as they were: "
            f"{error.strerror or error}; the new baseline is kept in {kept}"
        ) from error


def _old(path: Path, gate: str) -> tuple[Baseline | None, list[str]]:
    """The baseline that is replaced; one that cannot be read, or of another gate, is replaced too, with a warning."""
    if not path.exists():
        return None, []
    try:
        old = read_baseline(path)
    except TissuebenchError as error:
        return None, [f"the old baseline is replaced without a comparison: {error}"]
    other = f"the baseline of another gate, {old.gate!r}, is replaced by one of {gate!r}"
    return old, [] if old.gate == gate else [other]


def _measured(plan: GatePlan, origin: Origin, listener: Listener) -> tuple[Baseline, list[str]]:
    """The baseline of this version, and warnings of the gate file's tolerances."""
    head, file = this_version(plan), plan.file
    listener.say(f"gate {file.name}: values of {counted(len(plan.cases), 'case')}")
    values = gated_values(head)
    missing = [f"{name} ({value.reason})" for name, value in values.items() if value.value is None]
    if missing:
        raise SolverError(f"no baseline was made: there is no value of {', '.join(missing)}")
    wide = wide_remarks(values, file.tolerances)  # refuses what a check could not use
    with listener.progress(f"gate {file.name}: {counted(len(file.timed), 'time')}") as advance:
        measured = measure((head,), lambda _: False, lambda done, most: advance("processes", done, most, ""))
    found = Baseline(
        gate=file.name,
        fingerprint=plan.fingerprint,
        made=origin.made,
        revision=origin.revision,
        machine=origin.machine,
        accuracy=values,
        timing={
            name: StoredTiming(ratios=[math.exp(each) for each in times]) for name, times in measured.ratios[0].items()
        },
    )
    return found, wide


def _entry(baseline: Baseline) -> HistoryEntry:
    ratios = {name: {"ratio": typical(each), "ci95": None, "allowed": None} for name, each in baseline.timing.items()}
    return HistoryEntry(
        made=baseline.made,
        revision=baseline.revision,
        machine=baseline.machine.processor,
        against=None,
        passed=None,
        accuracy={name: each.value for name, each in baseline.accuracy.items()},
        timing=ratios,
    )


def typical(timing: StoredTiming) -> float:
    """Geometric mean over the processes of a stored time."""
    return math.exp(math.fsum(map(math.log, timing.ratios)) / len(timing.ratios))


def _steps(old: Baseline | None, new: Baseline) -> tuple[Step, ...]:
    before = {} if old is None else old.accuracy
    steps = [
        Step(name, _unit(name, before, new.accuracy), _value(before, name), _value(new.accuracy, name))
        for name in {**new.accuracy, **before}
    ]
    times = {} if old is None else {name: typical(each) for name, each in old.timing.items()}
    now = {name: typical(each) for name, each in new.timing.items()}
    timed = [Step(name, TIMING_UNIT, times.get(name), now.get(name)) for name in {**now, **times}]
    return (*steps, *_curve_steps(before, new.accuracy), *timed)


def _curve_steps(old: Mapping[str, StoredValue], new: Mapping[str, StoredValue]) -> list[Step]:
    """The load step of each curve that changed at which it changed most, where that is not told of the value itself."""
    found = []
    for name in old.keys() & new.keys():
        step = farthest_step(new[name], old[name])
        one, other = ((old[name].curve or {}).get(step or ""), (new[name].curve or {}).get(step or ""))
        if one != other and (one, other) != (old[name].value, new[name].value):
            found.append(Step(f"{name}{CURVE} at {step}", new[name].unit, one, other))
    return sorted(found, key=lambda each: each.quantity)


def _unit(name: str, old: Mapping[str, StoredValue], new: Mapping[str, StoredValue]) -> str:
    return (new.get(name) or old[name]).unit


def _value(values: Mapping[str, StoredValue], name: str) -> float | None:
    found = values.get(name)
    return None if found is None else found.value
