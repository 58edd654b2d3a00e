"""What keeps the search short: what a session can show, a one-step look at each effect, and the trials compared."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.candidate_fit import screened
from benchmark.discovery.base.effect_model import EffectModel, Fit, fit, settled
from benchmark.discovery.base.trials_problem import only
from benchmark.discovery.discovery_result import PHASES, Array
from benchmark.discovery.evidence.gains import effective_size
from benchmark.discovery.trials.study import ConditionData, Study
from benchmark.physics import Effect
from benchmark.physics.description import SIGNS, Sign

MARKERS = "markers on the lower face"
MOTION: frozenset[Sign] = frozenset({"unloading", "hold", "second_rate", "lift_off"})
"""Signs that another motion brings; a second layer or a clamp it does not."""


@dataclass(frozen=True, eq=False)
class Screened:
    """An effect, what one step towards it gains in log density over all trials, and the residual along its starts.

    `along` is (starts, R): one number a start and trial, of unit variance where there is nothing but noise.
    """

    effect: Effect
    won: float
    along: Array


def screen(current: Fit, effects: Sequence[Effect]) -> tuple[Screened, ...]:
    """Effects by what one step gains, best first."""
    out = []
    for effect in effects:
        model = EffectModel(current.model.problem, (*current.model.effects, effect))
        ranked = screened(current, model, effect)
        out.append(Screened(effect, ranked[0].won, np.array([start.along for start in ranked])))
    return tuple(sorted(out, key=lambda each: -each.won))


def promising(base: Fit, ranked: Sequence[Screened]) -> bool:
    """Whether one step towards some effect gains what BIC asks of one more parameter, so that it may be accepted.

    Then effects are looked for though the test of the base's residuals is silent: what unseen trials gain has a share
    of the level of its own.
    """
    asked = 0.5 * (float(np.log(effective_size(base))) - criteria.ACCEPT_BIC)
    return any(each.won > asked for each in ranked[:1])


def compared(base: Fit, most: int = criteria.MOST_TRIALS) -> list[int]:
    """Numbers of the trials on which candidates are compared; all where there are no more than `most`."""
    groups = np.array([trial.condition for trial in base.model.problem.trials])
    if groups.size <= most:
        return list(range(groups.size))
    each = max(most // np.unique(groups).size, 2)
    picked: list[int] = []
    for number in np.unique(groups):
        mine = np.flatnonzero(groups == number)
        places = np.linspace(0, mine.size - 1, min(each, mine.size)).round().astype(int)
        picked += mine[places].tolist()
    return picked


def on_some(fitted: Fit, trials: list[int]) -> Fit:
    """The same model fitted to some of its trials; the fit itself where these are all."""
    problem = fitted.model.problem
    if len(trials) == len(problem.trials):
        return fitted
    return fit(EffectModel(only(problem, trials), fitted.model.effects), fitted.vector, fitted.nuisance[trials], most=6)


def on_all(base: Fit, chosen: Fit) -> Fit:
    """Chosen effects fitted to all trials of `base`, from where the fit to some of them ended."""
    problem = base.model.problem
    if len(chosen.model.problem.trials) == len(problem.trials):
        return chosen
    if not chosen.model.effects:
        return base
    model = EffectModel(problem, chosen.model.effects)
    return fit(model, chosen.vector, settled(model, chosen.vector, base.nuisance), most=5)


def remark(count: int, total: int) -> tuple[str, ...]:
    """What a reader must know of it."""
    if count == total:
        return ()
    return (f"{total} trials: candidates are compared on {count} of them, test, fit and gap are of all",)


def shown(study: Study) -> frozenset[Sign]:
    """The signs that a session's trials have."""
    found: set[Sign] = set() if study.by_force else {"free_force"}
    for condition in study.conditions:
        back = _fallen(condition) if study.by_force else _travel(condition, "unload_high", "unload_low")
        if back >= criteria.LEAST_UNLOADED * condition.around.peak_depth:
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


def unseen(study: Study, effects: Sequence[Effect], more: AbstractSet[Sign] = frozenset()) -> tuple[str, ...]:
    """Slugs of effects that another motion would show, but neither these trials nor some with `more` signs do."""
    have = shown(study)
    return tuple(each.slug for each in effects if not _has(have | more, each) and _has(have | MOTION, each))


def _has(signs: AbstractSet[Sign], effect: Effect) -> bool:
    return all(not signs.isdisjoint(each) for each in effect.description.needs)


def _rows(condition: ConditionData, *phases: str) -> np.ndarray:
    """(n,) whether a row is in one of the phases."""
    return np.isin(condition.phase, [PHASES.index(phase) for phase in phases])


def _travel(condition: ConditionData, *phases: str) -> float:
    """How far the depth goes in these phases, m, in the middle one of the trials."""
    depth = condition.depth[:, _rows(condition, *phases)]
    return float(np.median(np.ptp(depth, axis=1))) if depth.size else 0.0


def _fallen(condition: ConditionData) -> float:
    """How far the depth comes back from what it had reached, m, in the middle one of the trials.

    A weight is off between two rows, so that no row is of the way back.
    """
    return float(np.median(np.max(np.maximum.accumulate(condition.depth, axis=1) - condition.depth, axis=1)))


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
