"""Which experiment separates the rivals of a discovery, weighed by separation per minute at the bench."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.planning.rivals import Rival, expected, rivals, separation
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.discovery.trials.study import ConditionData
from benchmark.discovery.workflow import Findings
from benchmark.errors import InputError
from benchmark.experiments.menu import (
    Experiment,
    Usual,
    menu,
    minutes,
    motion,
    protocol_toml,
    rigid_block,
    ruler_image,
    same_again,
)

ROWS = 400
"""Rows of a trial on which rivals are compared: about what a trial's autocorrelated samples are worth at most."""
DEPTH_READ = 0.02e-3
"""Standard deviation with which a rig's give under a rigid block is taken to be read, m."""
RULER_READ = 2e-3
"""Relative standard deviation of a scale read off a ruler's picture."""
GIVES = {"machine_compliance": "compliance"}
SCALES = {"marker_scale_error": "error"}


def propose(found: Findings) -> NextExperiment | None:
    """Return the experiment that separates the answer from its nearest look-alike; None where there is none.

    Entries that a model cannot follow are left out of the menu.
    """
    standing = rivals(found)
    if len(standing) < 2:
        return None
    first, second = standing[:2]
    study = found.calibrated.base.model.problem.study
    condition = max(study.conditions, key=lambda each: each.size)
    trials = condition.size
    weighed = _weighed(first, second, condition, trials)
    now = weighed.pop("same again", (None, 0.0, 1.0))[1]
    weighed = {name: each for name, each in weighed.items() if each[1] > now}
    if not weighed:
        return None
    best, size, cost = max(weighed.values(), key=lambda each: each[1] ** 2 / each[2])
    return NextExperiment(
        rivals=(_distinct(first, second), _distinct(second, first)),
        choice=best.name,
        words=best.words,
        separation_now=now,
        separation=size,
        minutes=cost,
        menu={name: (each[1], each[2]) for name, each in weighed.items()},
        toml=protocol_toml(best),
    )


def _weighed(
    first: Rival, second: Rival, condition: ConditionData, trials: int
) -> dict[str, tuple[Experiment, float, float]]:
    """Name to experiment, separation in standard deviations over all trials, and minutes."""
    usual = usual_press(condition)
    out = {}
    for experiment in (same_again(usual), *menu(usual)):
        size = _simulated(first, second, condition.name, experiment, trials)
        if size is not None:
            out[experiment.name] = (experiment, size, minutes(experiment, trials))
    for experiment, size in _calibrations(first, second, condition):
        out[experiment.name] = (experiment, size, minutes(experiment, 1))
    return out


def _simulated(first: Rival, second: Rival, condition: str, experiment: Experiment, trials: int) -> float | None:
    """Separation over all trials; None where a model does not follow the motion."""
    time, depth = motion(experiment, ROWS)
    try:
        a = expected(first, condition, time, depth)
        size = separation(
            a.signals,
            lambda vector: expected(second, condition, time, depth, vector).signals,
            second.vector,
            second.covariance,
            a.noise,
            time,
        )
    except (InputError, ValueError, ArithmeticError):
        return None
    return math.sqrt(trials * size) if math.isfinite(size) else None


def _calibrations(first: Rival, second: Rival, condition: ConditionData) -> Sequence[tuple[Experiment, float]]:
    """Measurements of the instrument alone, where only one of the rivals says that there is something to see."""
    force = float(condition.around.peak_force)
    found: list[tuple[Experiment, float]] = []
    give = abs(_only(first, second, GIVES)) * force / DEPTH_READ
    if give > 0.0:
        found.append((rigid_block(force), give))
    scale = abs(_only(first, second, SCALES)) / RULER_READ
    if scale > 0.0:
        found.append((ruler_image(), scale))
    return found


def _only(first: Rival, second: Rival, effects: dict[str, str]) -> float:
    """The parameter of an effect that one of the rivals has and the other has not; zero otherwise."""
    for slug, name in effects.items():
        having = [rival for rival in (first, second) if slug in rival.slugs]
        if len(having) == 1:
            return float(having[0].values[slug][name])
    return 0.0


def usual_press(condition: ConditionData) -> Usual:
    """What the trials of a condition did: depth, speed while loading, time held."""
    time, depth = np.median(condition.time, axis=0), np.median(condition.depth, axis=0)
    loading, holding = (_rows(condition, name) for name in ("load", "hold"))
    speeds = np.abs(np.diff(depth)) / np.maximum(np.diff(time), 1e-9)
    speed = float(np.median(speeds[loading[1:]])) if loading[1:].any() else 1e-3
    steps = np.diff(time, prepend=time[0])
    held = float(steps[holding].sum())
    limit = math.inf if condition.support.kind == "hole" else condition.around.thickness
    return Usual(float(depth.max()), max(speed, 1e-5), min(held, 3600.0), limit)


def _rows(condition: ConditionData, phase: str) -> np.ndarray:
    """(n,) whether a row is in a phase of the first press."""
    return np.asarray((condition.phase == PHASES.index(phase)) & (condition.cycle <= 1))


def _distinct(rival: Rival, other: Rival) -> str:
    """What a rival has that the other has not."""
    own = [slug for slug in rival.slugs if slug not in other.slugs]
    return "+".join(own or rival.slugs)
