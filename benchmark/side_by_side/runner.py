"""FEM and wave model side by side: together for the results, then in turn for the timing.

The first execution of both runs at the same time, each in its own process on its own core, and gives the results; it
also warms caches, so it is not a timing repeat. The timed repeats follow one after the other, FEM, wave, FEM, wave...,
so that both models meet the same state of the machine.
"""

from __future__ import annotations

import itertools
import math
import os
import statistics
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from multiprocessing.connection import wait
from pathlib import Path

import numpy as np

from benchmark.files import Scenario
from benchmark.models import NOTHING, ModelResult, Own, StepProgress
from benchmark.side_by_side.process import ModelProcess
from benchmark.side_by_side.worker import Answer, Declined, Finished, Remark, Seconds

MODELS = ("fem", "wave")
NAMES = {"fem": "FEM", "wave": "wave model"}
OnProgress = Callable[[str, StepProgress], None]
OnRemark = Callable[[str], None]


@dataclass(frozen=True)
class Speedup:
    """FEM wall time over wave wall time of interleaved repeats.

    Attributes
    ----------
    median, ci95
        Of the load history alone, with the interval of `median_interval`.
    coverage
        With what probability that interval holds the median of all such pairs: 0.95 and more from six pairs on.
    with_setup
        Of one load history with the set-up before it, median.
    pays_from
        How many load histories of one set-up it takes until the wave model is ahead; None where it never is.
    repeats
        Pairs.
    """

    median: float
    ci95: tuple[float, float]
    coverage: float
    with_setup: float
    pays_from: int | None
    repeats: int

    @property
    def spread(self) -> str:
        """What the interval is: up to five pairs are too few for 95 % whatever their distribution."""
        return "95 %" if self.coverage >= COVERED else "range"


COVERED = 0.95


def median_seconds(repeats: Sequence[Seconds]) -> Seconds:
    """Median of each part over the repeats."""
    table = np.array([(r.setup, r.wall, r.cpu) for r in repeats])
    setup, wall, cpu = np.median(table, axis=0)
    return Seconds(float(setup), float(wall), float(cpu))


def median_interval(values: Sequence[float]) -> tuple[float, float, float]:
    """Narrowest interval between the k-th smallest and largest value that covers their median with 95 % or more.

    Whatever the distribution, it does with 1 - 2 P(B < k), B binomial of n and 1/2 (David and Nagaraja, Order
    Statistics, 3rd ed. 2003, section 7.1). Up to five values are too few: their range is returned.

    Returns
    -------
    (float, float, float)
        Both ends and the probability.
    """
    ordered, n = sorted(values), len(values)
    outside = list(itertools.accumulate(2 * math.comb(n, k) / 2**n for k in range(max(n // 2, 1))))
    inner = max(sum(share <= 1.0 - COVERED for share in outside), 1)
    return ordered[inner - 1], ordered[n - inner], max(1.0 - outside[inner - 1], 0.0)


def speedup(slow: Sequence[Seconds], fast: Sequence[Seconds]) -> Speedup:
    """Ratio of wall times, repeat by repeat, so that a drifting machine cancels."""
    ratios = [s.wall / f.wall for s, f in zip(slow, fast, strict=True)]
    low, high, coverage = median_interval(ratios)
    whole = [(s.setup + s.wall) / (f.setup + f.wall) for s, f in zip(slow, fast, strict=True)]
    return Speedup(
        float(np.median(ratios)),
        (low, high),
        coverage,
        float(np.median(whole)),
        _pays_from(median_seconds(slow), median_seconds(fast)),
        len(ratios),
    )


def _pays_from(slow: Seconds, fast: Seconds) -> int | None:
    """Load histories until the faster model has made up for its set-up; None where it is not faster."""
    if fast.wall >= slow.wall:
        return None
    return max(1, math.ceil((fast.setup - slow.setup) / (slow.wall - fast.wall)))


def unheard(_: str) -> None:
    """Let a remark pass."""


@dataclass(frozen=True)
class ModelRun:
    """One model's part: its result, or why there is none, and its timed repeats.

    `model` is its place, `"fem"` or `"wave"`; `own` what the user calls a model put there; `peak_memory` in bytes that
    of its process, with the libraries it loads; `frame` the wall s of a picture of all faces, median of the repeats.
    """

    model: str
    result: ModelResult | None
    declined: str | None
    repeats: tuple[Seconds, ...]
    own: str | None = None
    peak_memory: int | None = None
    frame: float | None = None

    @property
    def name(self) -> str:
        """What reports call it."""
        return self.own or NAMES[self.model]

    @property
    def key(self) -> str:
        """What the column `model` of tables calls it."""
        return self.own or self.model

    @property
    def seconds(self) -> Seconds | None:
        """Medians over the repeats, None where nothing was timed."""
        return median_seconds(self.repeats) if self.repeats else None


@dataclass(frozen=True)
class SideBySide:
    """Both models on one scenario."""

    fem: ModelRun
    wave: ModelRun
    speedup: Speedup | None


def cores(count: int) -> list[int | None]:
    """Return a core for each of `count` processes, or None where the system offers no choice."""
    available = sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else []
    if len(available) < count:
        return [None] * count
    return list(available[:count])


def run_side_by_side(
    scenario: Scenario,
    *,
    repeats: int,
    every_field: bool,
    on_progress: OnProgress,
    on_remark: OnRemark = unheard,
    own: Own = NOTHING,
    keep: Path | None = None,
) -> SideBySide:
    """Run both models on `scenario`; raises InputError or SolverError as `ModelProcess.receive`.

    Parameters
    ----------
    repeats
        Timed repeats of each model; none where one stopped early: a part of a history is not the job.
    every_field
        Keep the fields of each step instead of the peak's and the last one's.
    on_progress, on_remark
        Called with the model's name and its progress, and with what a person should know while it runs.
    own
        A user's own model in the wave's place, timed like it, or own FEA in the FEM's, which does not run.
    keep
        Where the execution for the results keeps its FEM steps and takes up an earlier run's; repeats are whole anyway.
    """
    with ExitStack() as stack:
        processes = [
            stack.enter_context(
                ModelProcess(model, scenario, every_field=every_field, core=core, own=own.place(model), keep=keep)
            )
            for model, core in zip(MODELS, cores(len(MODELS)), strict=True)
            if model == "wave" or own.reference is None
        ]
        first = _at_one_load(processes, _together(processes, on_progress, on_remark))
        repeated = _in_turn(processes, first, repeats)
    fem, wave = (_model_run(model, first.get(model), repeated.get(model, []), own) for model in MODELS)
    ratio = speedup(fem.repeats, wave.repeats) if fem.repeats and wave.repeats else None
    return SideBySide(fem, wave, ratio)


def _together(processes: list[ModelProcess], on_progress: OnProgress, on_remark: OnRemark) -> dict[str, Answer]:
    """Start every model at once and collect the answers as they come."""
    for process in processes:
        process.command(keep_result=True)
    waiting = {process.connection: process for process in processes}
    answers: dict[str, Answer] = {}
    while waiting:
        for connection in wait(list(waiting)):
            process = waiting[connection]  # type: ignore[index]
            message = process.receive()
            if isinstance(message, StepProgress):
                on_progress(process.model, message)
            elif isinstance(message, Remark):
                on_remark(message.text)
            else:
                answers[process.model] = message
                del waiting[connection]  # type: ignore[arg-type]
    return answers


def _at_one_load(processes: list[ModelProcess], first: Mapping[str, Answer]) -> dict[str, Answer]:
    """The answers, the wave's profile read at the last step of finite elements that stopped early.

    Two profiles at the loads that each came to are no comparison.
    """
    fem, wave = (first.get(model) for model in ("fem", "wave"))
    if not (isinstance(fem, Finished) and isinstance(wave, Finished) and fem.result and wave.result):
        return dict(first)
    reached = fem.result.time.size
    if not 0 < reached < wave.result.time.size:
        return dict(first)
    process = next(each for each in processes if each.model == "wave")
    process.command(keep_result=True, steps=reached)
    short = process.answer()
    if not isinstance(short, Finished) or short.result is None:
        return dict(first)
    there = replace(wave.result, profile=short.result.profile, peak_step=short.result.peak_step)
    return {**first, "wave": replace(wave, result=there)}


def _in_turn(processes: list[ModelProcess], first: Mapping[str, Answer], repeats: int) -> dict[str, list[Finished]]:
    """Timed repeats of the models that cover the scenario, in turn; none where a first answer stopped early."""
    timed = [process for process in processes if isinstance(first[process.model], Finished)]
    answers = [answer for answer in first.values() if isinstance(answer, Finished)]
    whole = all(answer.result is not None and answer.result.complete for answer in answers)
    found: dict[str, list[Finished]] = {process.model: [] for process in timed}
    for _ in range(repeats if whole else 0):
        for process in timed:
            process.command(keep_result=False)
            answer = process.answer()
            if isinstance(answer, Finished):
                found[process.model].append(answer)
    return found


SAME_ANSWER = 1e-6
"""How far repeats of a model may be apart, of its largest deflection: single precision and other orders of sums."""


def _doubted(first: ModelResult | None, repeats: Sequence[ModelResult]) -> ModelResult | None:
    """The first answer of a model, with a warning where its repeats are others: random numbers without a seed."""
    if first is None or not repeats:
        return first
    apart = max(float(np.abs(each.top_deflection - first.top_deflection).max()) for each in repeats)
    largest = float(np.abs(first.top_deflection).max())
    if apart <= SAME_ANSWER * largest:
        return first
    share = f", {100.0 * apart / largest:.3g} % of the largest," if largest else ""
    said = (
        f"it answers differently each time: repeats are up to {1e3 * apart:.3g} mm{share} off the first, which stands "
        "in this report; a model with random numbers needs a seed"
    )
    return replace(first, warnings=(*first.warnings, said))


def _model_run(model: str, answer: Answer | None, repeats: list[Finished], own: Own) -> ModelRun:
    """Join the first answer of a model with its timing; without an answer it is the user's reference."""
    name = own.name(model)
    if answer is None:
        return ModelRun(model, own.reference.result if own.reference else None, None, (), name)
    if isinstance(answer, Finished):
        frames = [each.frame for each in repeats if each.frame is not None]
        frame = statistics.median(frames) if frames else None
        seconds = tuple(each.seconds for each in repeats)
        result = _doubted(answer.result, [each.result for each in repeats if each.result is not None])
        return ModelRun(model, result, None, seconds, name, answer.peak_memory, frame)
    reason = answer.reason if isinstance(answer, Declined) else answer.message
    return ModelRun(model, None, reason, (), name)
