"""Bounds that physics gives to what each trial has of its own, and remarks on those that are large.

A tool touches where the force has not yet risen over its noise, a sensor's zero is what it shows at rest, and a clock
is late by a sample or two. Gain and marker zeros have priors alone.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import kendalltau, studentized_range

from benchmark.discovery import criteria
from benchmark.discovery.base.trials_problem import OWN, TrialRef, TrialsProblem
from benchmark.discovery.discovery_result import PHASES, TrialValues
from benchmark.discovery.trials.study import ConditionData
from benchmark.response.force_curve import Array

APPROACH, LOAD = PHASES.index("approach"), PHASES.index("load")


def trial_bounds(problem: TrialsProblem) -> tuple[Array, Array]:
    """Lower and upper bounds (R, q) of the trials' nuisances."""
    count = len(OWN) + len(problem.zeros)
    low, high = np.full((len(problem.trials), count), -np.inf), np.full((len(problem.trials), count), np.inf)
    thicker = (-criteria.FAR_SETUP, criteria.FAR_SETUP)
    late = max(criteria.LATEST, criteria.LATE_ROWS * problem.study.raw_interval)
    for index, trial in enumerate(problem.trials):
        noise = float(problem.noise.scale[index, 0])
        zero, touch = zero_range(problem, trial, noise), touch_range(problem, trial, noise)
        for name, ends in (("zero", zero), ("shift", (-late, late)), ("height", touch), ("thickness", thicker)):
            low[index, OWN.index(name)], high[index, OWN.index(name)] = ends
    return low, high


def zero_range(problem: TrialsProblem, trial: TrialRef, noise: float) -> tuple[float, float]:
    """Between which forces, N, a sensor's zero lies by the rows in air before the press, give or take its noise."""
    resting = _resting(problem, trial)
    if not resting.any():
        wide = criteria.UNSEEN_ZERO * problem.study.conditions[trial.condition].around.peak_force
        return -wide, wide
    force, spare = trial.signals[resting, 0], criteria.OVER_NOISE * noise
    return float(force.min()) - spare, float(force.max()) + spare


def touch_range(problem: TrialsProblem, trial: TrialRef, noise: float) -> tuple[float, float]:
    """Between which depths, m, a tool touches: not beyond the row in which the force has risen over its noise.

    Where depth is counted from a touch that a force told, the tool had touched before: by the same depth and a share of
    the press, or the share of its peak that the force has reached before the touch, where that is more.
    """
    resting, force, depth = _resting(problem, trial), trial.signals[:, 0], trial.motion.read.depth
    rest = float(np.median(force[resting])) if resting.any() else float(force[:2].min())
    highest = zero_range(problem, trial, noise)[1] if resting.any() else rest
    most = float(depth.max())
    risen = np.flatnonzero((force > rest + criteria.RISEN * noise) & (depth > 0.0))
    reach = max(float(depth[risen[0]]) if risen.size else most, criteria.LEAST_TOUCH * most)
    early = max(criteria.EARLY_TOUCH, (highest - rest) / max(float(force.max()) - rest, 1e-300))
    return -reach - early * most, reach


def _resting(problem: TrialsProblem, trial: TrialRef) -> Array:
    """Mask (n,) of the rows in air before the first press."""
    return np.asarray((problem.study.conditions[trial.condition].phase == APPROACH) & (trial.motion.read.depth <= 0.0))


def trial_values(problem: TrialsProblem, nuisance: Array) -> tuple[TrialValues, ...]:
    """The fitted nuisances (R, q) of the trials, and which stand at their bounds."""
    low, high = trial_bounds(problem)
    stuck = (nuisance <= low) | (nuisance >= high)
    out = []
    for index, trial in enumerate(problem.trials):
        gain, zero, shift, height, thickness = nuisance[index, : len(OWN)].tolist()
        names = tuple(name for name, at in zip(OWN, stuck[index], strict=False) if at)
        out.append(TrialValues(trial.name, float(np.exp(gain)), zero, shift, height, names, thickness))
    return tuple(out)


def large_remarks(problem: TrialsProblem, nuisance: Array) -> tuple[str, ...]:
    """A warning of zeros, time shifts and depths at touch that are large: at a bound, or a share of peak or press.

    And of a trial that is much stiffer or softer than the others, beyond their scatter.
    """
    found, odd = [], _folds(nuisance[:, OWN.index("gain")])
    for trial, own, fold in zip(problem.trials, trial_values(problem, nuisance), odd, strict=True):
        if fold != 1.0:
            found.append(f"{own.trial}: {fold:.2g} times as stiff as the others (another specimen, or a wrong unit?)")
        around = problem.study.conditions[trial.condition].around
        if abs(own.zero) > criteria.LARGE_SHARE * around.peak_force or "zero" in own.at_bound:
            found.append(f"{own.trial}: {own.zero:.3g} N at rest")
        if abs(own.touch) > criteria.LARGE_SHARE * around.peak_depth or "height" in own.at_bound:
            found.append(f"{own.trial}: touches at {1e3 * own.touch:.3g} mm")
        if "shift" in own.at_bound:
            found.append(f"{own.trial}: force and frames late by {1e3 * own.late:.3g} ms, as far as allowed")
    together = (
        *_late_together(problem, nuisance[:, OWN.index("height")]),
        *_clocks_together(problem, nuisance[:, OWN.index("shift")]),
        *_gains_in_order(problem, np.exp(nuisance[:, OWN.index("gain")])),
        *_gains_between(problem, nuisance[:, OWN.index("gain")]),
    )
    if not found:
        return together
    shown = "; ".join(found[: criteria.MOST_LARGE])
    more = f"; and {len(found) - criteria.MOST_LARGE} more" if len(found) > criteria.MOST_LARGE else ""
    return (f"trials have large values of their own, which may hide an effect: {shown}{more}", *together)


def _folds(gain: Array) -> Array:
    """(R,) times the median that trials of log gains (R,) are as stiff, 1 where that is within their scatter."""
    away = gain - np.median(gain)
    scatter = float(np.median(np.abs(away))) / 0.6745
    return np.where(np.abs(away) > max(np.log(criteria.ODD_FOLD), criteria.ODD_SCATTER * scatter), np.exp(away), 1.0)


def _late_together(problem: TrialsProblem, touch: Array) -> tuple[str, ...]:
    """A warning of touches (R,), m, that are late in the mean and scatter: one trial foretells no gap of another."""
    press = float(np.median([problem.study.conditions[trial.condition].around.peak_depth for trial in problem.trials]))
    mean, error = float(touch.mean()), float(np.std(touch, ddof=1)) / np.sqrt(touch.size) if touch.size > 1 else np.inf
    if mean <= max(criteria.TOGETHER * error, criteria.FREE_TRAVEL * press):
        return ()
    return (
        f"the tool touches {1e3 * mean:.2g} mm behind its zero in the mean of the trials, give or take "
        f"{1e3 * error:.1g} mm: either the zeros are early, or there is a gap before contact that their scatter hides",
    )


def _clocks_together(problem: TrialsProblem, shift: Array) -> tuple[str, ...]:
    """A warning of time shifts (R,), s, that trials share, or that go with the speed."""
    by_speed = late_by_speed(problem, shift)
    if by_speed is not None:
        (slow, at_slow), (fast, at_fast) = by_speed
        looks = "play at each turn" if at_slow > at_fast else "friction"
        return (
            f"force and frames are late by {1e3 * at_slow:.2g} ms at {1e3 * slow:.2g} mm/s and by "
            f"{1e3 * at_fast:.2g} ms at {1e3 * fast:.2g} mm/s: no clock is, but {looks} looks so, and these time "
            "shifts, which are fitted beside every answer, would hide it",
        )
    groups = np.array([trial.condition for trial in problem.trials])
    together, error = float(shift.mean()), _scatter(shift, groups) / np.sqrt(shift.size)
    if abs(together) <= max(criteria.TOGETHER * error, criteria.NO_LATER):
        return ()
    looks = "play at each turn" if together > 0.0 else "friction or damping"
    return (
        f"force and frames are late by {1e3 * together:.2g} ms in the mean of the trials, give or take "
        f"{1e3 * error:.1g} ms: a sensor's filter, or, since {looks} looks so at one speed, an effect that these time "
        "shifts hide; trials at a second speed tell",
    )


def late_by_speed(problem: TrialsProblem, shift: Array) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Speed, m/s, and mean of the time shifts (R,), s, of the slowest and of the fastest condition, if these differ.

    A clock's shift is the same at each speed. Play at each turn is a delay that goes as 1 / speed, friction an advance.
    """
    groups, kinds = _repeated(problem)
    if len(kinds) < 2:
        return None
    speeds = [_loading_speed(problem.study.conditions[k]) for k in kinds]
    slow, fast = (kinds[int(place)] for place in (np.argmin(speeds), np.argmax(speeds)))
    mean = {k: float(shift[groups == k].mean()) for k in (slow, fast)}
    sure = criteria.TOGETHER * _error(shift, groups, (slow, fast))
    if max(speeds) <= criteria.OTHER_SPEED * min(speeds):
        return None
    if abs(mean[slow] - mean[fast]) <= max(sure, criteria.NO_LATER):
        return None
    return (min(speeds), mean[slow]), (max(speeds), mean[fast])


def _repeated(problem: TrialsProblem) -> tuple[Array, list[int]]:
    """(R,) condition of each trial, and the conditions that have two and more."""
    groups = np.array([trial.condition for trial in problem.trials])
    return groups, [k for k in range(len(problem.study.conditions)) if np.sum(groups == k) > 1]


def _error(values: Array, groups: Array, pair: tuple[int, int]) -> float:
    """Standard error of the difference of two conditions' means of values (R,)."""
    return _scatter(values, groups) * float(np.sqrt(sum(1.0 / np.sum(groups == k) for k in pair)))


def _scatter(values: Array, groups: Array) -> float:
    """Standard deviation of values (R,) within conditions; endless where none has two trials."""
    left = values - np.array([values[groups == group].mean() for group in groups])
    freedom = values.size - np.unique(groups).size
    return float(np.sqrt(np.sum(left**2) / freedom)) if freedom > 0 else np.inf


def _loading_speed(condition: ConditionData) -> float:
    """Median over trials of the first loading's way over its time, m/s; 0 without any."""
    rows = np.flatnonzero((condition.phase == LOAD) & (condition.cycle <= 1))
    if rows.size < 2:
        return 0.0
    way, lasted = (np.ptp(each[:, rows], axis=1) for each in (condition.depth, condition.time))
    return float(np.median(way / np.maximum(lasted, 1e-9)))


def _gains_in_order(problem: TrialsProblem, gain: Array) -> tuple[str, ...]:
    """A warning of gains (R,) that go one way from trial to trial of a condition, beyond chance (Kendall's tau)."""
    found = []
    groups = np.array([trial.condition for trial in problem.trials])
    order = np.array([trial.number for trial in problem.trials])
    for number, condition in enumerate(problem.study.conditions):
        mine = np.flatnonzero(groups == number)
        mine = mine[np.argsort(order[mine])]
        if mine.size < criteria.ENOUGH_TRIALS or kendalltau(order[mine], gain[mine]).pvalue > criteria.IN_ORDER:
            continue
        third = mine.size // 3
        change = float(np.median(gain[mine[-third:]]) / np.median(gain[mine[:third]])) - 1.0
        if abs(change) > criteria.LARGE_SHARE:
            way = "rise" if change > 0.0 else "fall"
            found.append(
                f"the trials' own gains {way} by {100.0 * abs(change):.2g} % from the first to the last of "
                f"{condition.name}: softening, preconditioning or a drift from press to press is in them, and is not "
                "looked for"
            )
    return tuple(found)


def _gains_between(problem: TrialsProblem, gain: Array) -> tuple[str, ...]:
    """A warning of log gains (R,) that part conditions."""
    parted = gains_between(problem, gain)
    if parted is None:
        return ()
    stiff, soft, apart = parted
    return (
        f"the trials' own gains are {100.0 * np.expm1(apart):.2g} % larger in {stiff} than in {soft}: what makes one "
        "condition stiffer beside the other, as a rig that gives way, another size of a tool, or a specimen that dries "
        "from trial to trial does, is in them, and is not looked for",
    )


def gains_between(problem: TrialsProblem, gain: Array) -> tuple[str, str, float] | None:
    """The stiffest and the softest condition by log gains (R,), and how far apart, where that is no scatter of trials.

    Tukey's range of the conditions' means, or gains that go one way through the session (a specimen that dries, a gain
    that drifts), whose trend within conditions is no scatter; and a share by which told tools may be off.
    """
    groups, kinds = _repeated(problem)
    if len(kinds) < 2:
        return None
    mean = {k: float(gain[groups == k].mean()) for k in kinds}
    least, most = min(kinds, key=mean.__getitem__), max(kinds, key=mean.__getitem__)
    apart, freedom = mean[most] - mean[least], gain.size - np.unique(groups).size
    if apart <= np.log1p(criteria.PARTED):
        return None
    error = max(_error(gain, groups, (least, most)), np.finfo(float).tiny)
    by_range = float(studentized_range.sf(np.sqrt(2.0) * apart / error, len(kinds), freedom))
    by_order = float(kendalltau([trial.number for trial in problem.trials], gain).pvalue)
    if min(by_range, by_order) > criteria.PARTED_P:
        return None
    names = [problem.study.conditions[k].name for k in (most, least)]
    return names[0], names[1], apart
