"""A sweep from request to report: choose the points, compute what is missing, say how far it is and what was found."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.resumable import going_on, say_waiting
from benchmark.runs.options import Advance, Listener
from benchmark.runs.output.destination import check_ready, claimed, destination
from benchmark.runs.output.document import describe_environment
from benchmark.sweeps.design import chosen_design
from benchmark.sweeps.local import usable_cores, work_locally
from benchmark.sweeps.parameter import parse_parameter
from benchmark.sweeps.plan import SweepPlan, make_plan
from benchmark.sweeps.point import FAILED, OK, PointResult, Task, failed
from benchmark.sweeps.sensitivity import SweepFindings, keys_without_effect, sensitivity_columns, sweep_sensitivity
from benchmark.sweeps.sweep_folder import DOING, SweepFolder, open_folder
from benchmark.sweeps.sweep_page import sweep_page
from reports import extended_folder, write_csv, write_json, write_page
from reports.formatting import counted

MOST_SAID = 3
"""Failed points that are named on the terminal."""


@dataclass(frozen=True)
class SweepRequest:
    """What the command line asked for; see `python -m benchmark sweep --help`."""

    scenario: str
    vary: Sequence[str]
    settings: Mapping[str, str] = field(default_factory=dict)
    sample: str | None = None
    points: int | None = None
    sensitivity: bool = False
    out: Path | None = None
    seed: int = 0
    workers: int | None = None
    scheduler: str | None = None


@dataclass(frozen=True)
class SweepOutcome:
    """A finished sweep on disk: its folder, the object for programs, its headline, and whether any point succeeded."""

    folder: Path
    document: dict[str, Any]
    headline: str
    any_ok: bool


def run_sweep(request: SweepRequest, listener: Listener) -> SweepOutcome:
    """Compute the points of a sweep that are not there yet, then write its tables and report.

    Raises
    ------
    InputError
        A request that cannot be carried out, or a folder that is another's or in use; nothing is computed then. Or the
        file system refuses; finished points are kept.
    ClusterError
        The cluster is not there or is gone; finished points are kept.
    """
    plan = _plan(request)
    with claimed(request.out, DOING):
        return _swept(request, plan, listener)


def _swept(request: SweepRequest, plan: SweepPlan, listener: Listener) -> SweepOutcome:
    path = _folder(request, plan)
    with going_on(path), open_folder(path, plan) as folder:
        say_waiting(path, listener.say)
        _finish(folder, plan, request, listener)
        rows = [folder.finished[point] for point in sorted(folder.finished)]
        say_failures(rows, plan, listener.say)
        return _write(path, plan, rows, request)


def say_failures(rows: Sequence[PointResult], plan: SweepPlan, say: Callable[[str], None]) -> None:
    """Name the first points that failed, with their values and why."""
    failures = [row for row in rows if row.status == FAILED]
    for row in failures[:MOST_SAID]:
        say(f"point {row.point} ({_values_of(plan, row.point)}) failed: {row.reason}")
    if len(failures) > MOST_SAID:
        say(f"{counted(len(failures) - MOST_SAID, 'more point')} failed; the reasons are in the report")


def _values_of(plan: SweepPlan, point: int) -> str:
    """The values of a point with their keys."""
    varied = zip(plan.parameters, plan.points[point - 1], strict=True)
    return ", ".join(f"{parameter.key} {value}" for parameter, value in varied)


def _folder(request: SweepRequest, plan: SweepPlan) -> Path:
    """Where the sweep goes."""
    if request.out is None:
        return destination(None, f"{plan.scenario.name}-sweep")
    varied = [value.strip() for text in request.vary for value in text.partition("=")[2].split(",")]
    check_ready(request.out, (request.scenario, *request.settings.values(), *varied))
    return request.out


def _plan(request: SweepRequest) -> SweepPlan:
    """The points of a request."""
    if not request.vary:
        raise InputError('nothing varies; give at least one --vary, as in --vary tool.radius="2 mm,5 mm"')
    if request.workers is not None and request.scheduler is not None:
        raise InputError("--workers is for this machine: a cluster (--scheduler) has its own workers")
    parameters = [parse_parameter(text) for text in request.vary]
    design = chosen_design(request.sample, request.points, request.sensitivity, len(parameters), request.seed)
    return make_plan(request.scenario, request.settings, parameters, design)


def _finish(folder: SweepFolder, plan: SweepPlan, request: SweepRequest, listener: Listener) -> None:
    """Compute the missing points."""
    total, done = len(plan.points), len(folder.finished)
    missing = [point for point in range(1, total + 1) if point not in folder.finished]
    if done:
        listener.say(f"{folder.path}: {done} of {total} points are there already")
    if not missing:
        return
    for each in folder.changed:
        listener.say(each)
    say_unusable(missing, plan, listener.say)
    with listener.progress(f"{plan.scenario.name}: {len(missing)} points") as advance:
        progress = SweepProgress(total, done, advance)
        for row in _rows(plan, missing, request, folder.unfinished, listener):
            folder.add(row)
            progress.add(row)


def say_unusable(missing: Sequence[int], plan: SweepPlan, say: Callable[[str], None]) -> None:
    """Say at the start how many points no scenario can be made of, and why for the first: hours may follow."""
    reasons = {point: reason for point in missing if isinstance(reason := plan.scenarios[point - 1], str)}
    if reasons:
        first, count = min(reasons), f"{len(reasons)} of {len(plan.points)} points cannot be computed"
        say(f"{count}; the first is point {first} ({_values_of(plan, first)}): {reasons[first]}")


def _rows(
    plan: SweepPlan, missing: Sequence[int], request: SweepRequest, keep: Path, listener: Listener
) -> Iterator[PointResult]:
    """The missing points as they finish: first those that have no scenario, then the computed ones.

    A long point on this machine keeps its steps in a folder in `keep`; a cluster's workers may not reach it.
    """
    tasks = []
    for point in missing:
        scenario = plan.scenarios[point - 1]
        if isinstance(scenario, str):
            yield failed(point, scenario)
        else:
            folder = keep / f"point_{point:06d}" if request.scheduler is None else None
            tasks.append(Task(point, scenario, folder))
    if request.scheduler is None:
        yield from work_locally(tasks, request.workers or usable_cores())
    elif tasks:
        from benchmark.sweeps.cluster import work_on_cluster

        yield from work_on_cluster(tasks, request.scheduler, listener.say)


def _write(path: Path, plan: SweepPlan, rows: Sequence[PointResult], request: SweepRequest) -> SweepOutcome:
    """Write what a finished sweep leaves beside its points."""
    keys = [parameter.key for parameter in plan.parameters]
    found = SweepFindings(
        keys_without_effect(keys, plan.points, rows),
        sweep_sensitivity(keys, rows, seed=plan.design.seed) if request.sensitivity else None,
    )
    environment = describe_environment(seed=request.seed)
    page = sweep_page(plan, rows, found, environment)
    with extended_folder(path) as new:
        if found.sensitivity is not None:
            write_csv(new / "sensitivity.csv", sensitivity_columns(found.sensitivity))
        write_json(new / "environment.json", environment)
        write_page(new / "report.html", page)
    document = _document(plan, rows, found)
    return SweepOutcome(path, document, page.verdict.headline, any(row.status == OK for row in rows))


def _document(plan: SweepPlan, rows: Sequence[PointResult], found: SweepFindings) -> dict[str, Any]:
    """The sweep for programs."""
    failures = [{"point": row.point, "reason": row.reason} for row in rows if row.status == FAILED]
    document: dict[str, Any] = {
        "schema": 1,
        "name": plan.scenario.name,
        "points": len(rows),
        "ok": len(rows) - len(failures),
        "failed": failures,
        "vary": plan.document["vary"],
        "sample": plan.design.kind,
        "without_effect": list(found.without_effect),
        "results": list(dict.fromkeys(name for row in rows for name in row.values)),
    }
    if found.sensitivity is not None:
        document["sensitivity"] = {
            "base_samples": found.sensitivity.base_samples,
            "warnings": list(found.sensitivity.warnings),
            "indices": [vars(index) for index in found.sensitivity.indices],
        }
    return document


class SweepProgress:
    """Counts finished points; the estimate rests on those that finished since the start of this command."""

    def __init__(self, total: int, done: int, advance: Advance, clock: Callable[[], float] = time.monotonic):
        self._total, self._before, self._advance, self._clock = total, done, advance, clock
        self._now = self._failed = 0
        self._started = clock()

    def add(self, row: PointResult) -> None:
        """Count a point and say so."""
        self._now += 1
        self._failed += row.status == FAILED
        done = self._before + self._now
        remarks = [_duration(self.remaining()) + " left" if done < self._total else ""]
        remarks.append(f"{self._failed} failed" if self._failed else "")
        self._advance("points", done, self._total, ", ".join(filter(None, remarks)))

    def remaining(self) -> float:
        """Seconds that the missing points may take."""
        left = self._total - self._before - self._now
        return (self._clock() - self._started) / max(self._now, 1) * left


def _duration(seconds: float) -> str:
    """A duration as a person says it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
