"""What the motion and the set-up of a session can show: an effect whose sign is not among it is not looked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.trials.study import ConditionData, Study
from benchmark.physics import Effect
from benchmark.physics.description import SIGNS, Sign

MARKERS = "markers on the lower face"


def shown(study: Study) -> frozenset[Sign]:
    """The signs that a session's trials have."""
    found: set[Sign] = set()
    for condition in study.conditions:
        if _travel(condition, "unload_high", "unload_low") >= criteria.LEAST_UNLOADED * condition.around.peak_depth:
            found.add("unloading")
        if _rows(condition, "hold").sum() >= criteria.LEAST_ROWS:
            found.add("hold")
        if _rows(condition, "after_lift_off").sum() >= criteria.LEAST_ROWS:
            found.add("lift_off")
        if len(condition.around.layers) > 1 or np.isfinite(condition.around.hole_radius):
            found.add("interface")
    speeds = [speed for condition in study.conditions for speed in _speeds(condition)]
    if speeds and max(speeds) >= criteria.SECOND_RATE * min(speeds):
        found.add("second_rate")
    return frozenset(found)


def missing(study: Study, effect: Effect) -> tuple[str, ...]:
    """What a session would need, in words, to show an effect; empty where it can."""
    have = shown(study)
    needed = [each for each in effect.description.needs if have.isdisjoint(each)]
    words = [" or ".join(SIGNS[sign] for sign in each) for each in needed]
    if effect.needs_markers and study.layout is None:
        words.append(MARKERS)
    return tuple(words)


def not_shown(study: Study, effects: Sequence[Effect]) -> dict[str, str]:
    """Effects that a session cannot show, and what it lacks, in words."""
    return {effect.slug: " and ".join(words) for effect in effects if (words := missing(study, effect))}


def _rows(condition: ConditionData, *phases: str) -> np.ndarray:
    """(n,) whether a row is in one of the phases."""
    return np.isin(condition.phase, [PHASES.index(phase) for phase in phases])


def _travel(condition: ConditionData, *phases: str) -> float:
    """How far the depth goes in these phases, m, in the middle one of the trials."""
    depth = condition.depth[:, _rows(condition, *phases)]
    return float(np.median(np.ptp(depth, axis=1))) if depth.size else 0.0


def _speeds(condition: ConditionData) -> list[float]:
    """Mean speed of each press while it loads, m/s, in the middle one of the trials."""
    loading, found = _rows(condition, "load"), []
    for cycle in np.unique(condition.cycle[loading]):
        rows = loading & (condition.cycle == cycle)
        if rows.sum() < criteria.LEAST_ROWS:
            continue
        travel, spent = (np.ptp(each[:, rows], axis=1) for each in (condition.depth, condition.time))
        speed = float(np.median(travel / np.maximum(spent, 1e-9)))
        if speed > 0.0 and np.median(travel) >= criteria.LEAST_UNLOADED * condition.around.peak_depth:
            found.append(speed)
    return found
