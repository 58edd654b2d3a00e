"""One point of a sweep: both models on its scenario, in whatever process the point ends up in."""

from __future__ import annotations

import shutil
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from benchmark.errors import TissuebenchError
from benchmark.files import Scenario
from benchmark.models import Keeping, ModelResult, UncoveredError, prepare, scenario_drive
from benchmark.sweep.results import point_values

OK, FAILED = "ok", "failed"
MODELS = {"fem": "FEM", "wave": "wave model"}

_ONE_AT_A_TIME = threading.Lock()
"""A Dask worker may have several threads; the solvers of one process take turns."""


@dataclass(frozen=True)
class Task:
    """A point to compute: its number, from 1, its scenario, and a folder for what a long one has so far."""

    point: int
    scenario: Scenario
    keep: Path | None = None


@dataclass(frozen=True)
class PointResult:
    """What became of a point.

    Attributes
    ----------
    point : int
        From 1.
    status : str
        "ok" or "failed".
    reason : str or None
        Why it failed, one line.
    warnings : str or None
        What a reader must know of it, one line.
    values : mapping of str to float
        Results by column name.
    """

    point: int
    status: str
    reason: str | None = None
    warnings: str | None = None
    values: Mapping[str, float] = field(default_factory=dict)


def failed(point: int, reason: str) -> PointResult:
    """A point without results."""
    return PointResult(point, FAILED, " ".join(reason.split()))


def evaluate(task: Task) -> PointResult:
    """Run both models on a point, with one thread; whatever goes wrong is its reason."""
    from threadpoolctl import threadpool_limits

    with _ONE_AT_A_TIME, threadpool_limits(1):
        answers = {model: _Answer.of(model, task.scenario, task.keep) for model in MODELS}
    if task.keep is not None:
        shutil.rmtree(task.keep, ignore_errors=True)
    results = {model: answer.result for model, answer in answers.items()}
    faults = [answer.fault for answer in answers.values() if answer.fault]
    warnings = [warning for answer in answers.values() for warning in answer.warnings]
    if all(result is None for result in results.values()) and not faults:
        faults = warnings
    return PointResult(
        point=task.point,
        status=FAILED if faults else OK,
        reason=_line(faults),
        warnings=_line(warnings),
        values=point_values(task.scenario, results, {model: answer.seconds for model, answer in answers.items()}),
    )


@dataclass(frozen=True)
class _Answer:
    """One model's part: its complete result, or its fault, or neither where it does not cover the scenario."""

    result: ModelResult | None = None
    fault: str = ""
    warnings: tuple[str, ...] = ()
    seconds: float = float("nan")

    @classmethod
    def of(cls, model: str, scenario: Scenario, keep: Path | None) -> _Answer:
        """Run one model."""
        name, said = MODELS[model], list[str]()
        keeping = None if keep is None else Keeping(keep, said.append)
        started = time.perf_counter()
        try:
            result = prepare(model, scenario, keeping=keeping).run(scenario_drive(scenario))
        except UncoveredError as error:
            return cls(warnings=(f"the {name} does not cover this scenario: {error}",))
        except TissuebenchError as error:
            return cls(fault=f"{name}: {error}")
        except Exception as error:
            return cls(fault=f"{name}: {type(error).__name__}: {error}")
        warnings = (*said, *(f"{name}: {warning}" for warning in result.warnings))
        if result.failure is not None:
            return cls(fault=f"{name} stopped early at {result.failure}", warnings=warnings)
        if result.resumed is not None:
            return cls(result, "", (*warnings, f"{name} {result.resumed}; its time is left out"))
        return cls(result, "", warnings, time.perf_counter() - started)


def _line(texts: list[str]) -> str | None:
    """Sentences as one line; None for none."""
    return " ".join("; ".join(texts).split()) or None
