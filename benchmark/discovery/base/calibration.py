"""Noise and trial-to-trial spread of a session, estimated from what replicates do not share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import EffectModel, Fit, fit, nuisance_count
from benchmark.discovery.base.setup_priors import setup_priors, table_keys, unused
from benchmark.discovery.base.thickness_spread import thickness_spread, unlike_in_thickness
from benchmark.discovery.base.trials_problem import OWN, NoiseModel, TrialPrior, TrialRef, TrialsProblem, trial_refs
from benchmark.discovery.trials.marker_layout import PLACED
from benchmark.discovery.trials.study import Study
from benchmark.files import Session
from benchmark.response.elastic_table import ElasticTable, TableOf
from benchmark.response.fem_table import fem_or_wave_table
from benchmark.response.force_curve import Array
from benchmark.response.noise import fit_memory, scales

WIDE = TrialPrior(2.0, 10.0, 0.2, 1e-3, 1e-2)
"""Of trials before anything is known of them."""


@dataclass(frozen=True, eq=False)
class Calibrated:
    """A problem with noise and priors, its base model fitted, and what was left out."""

    problem: TrialsProblem
    base: Fit
    warnings: tuple[str, ...]


def calibrate(session: Session, study: Study, table_of: TableOf | None = None) -> Calibrated:
    """Fit the base and estimate noise and spreads, twice over."""
    setup = setup_priors(session)
    tables = _tables(study, table_of or fem_or_wave_table(session, table_keys(session)))
    setup = {key: size for key, size in setup.items() if any(key in table.by for table in tables)}
    problem = TrialsProblem(study, tables, _first_noise(study), _wide(study), trial_refs(study), setup=setup)
    vector, state = first_guess(problem)
    model = EffectModel(problem, ())
    start = fit(model, vector, state, most=6)
    problem, warnings = _estimated(start)
    second = fit(EffectModel(problem, ()), start.vector, _kept_state(start, problem), most=6)
    second_signals = second.model.signals(second.vector, second.nuisance)
    if unlike_in_thickness(second, second_signals, unlike_mates(second, second_signals)):
        second = _with_thicknesses(second)
    problem = _estimated(second)[0]
    base = fit(EffectModel(problem, ()), second.vector, _kept_state(second, problem), most=8)
    notes = [*(table.note for table in tables if table.note), *unused(session, tables)]
    return Calibrated(problem, base, tuple(dict.fromkeys([*notes, *warnings])))


def _with_thicknesses(fitted: Fit) -> Fit:
    """The fit with a thickness of each trial's own."""
    problem = fitted.model.problem
    problem = replace(problem, prior=replace(problem.prior, thickness=criteria.MOST_THICKNESS))
    return fit(EffectModel(problem, ()), fitted.vector, fitted.nuisance, most=6)


def _tables(study: Study, table_of: TableOf) -> tuple[ElasticTable, ...]:
    """The table of each condition; those with the same set-up share one."""
    setups = [condition.setup for condition in study.conditions]
    deepest = dict.fromkeys(setups, 0.0)
    for setup, condition in zip(setups, study.conditions, strict=True):
        deepest[setup] = max(deepest[setup], condition.around.peak_depth)
    made = {setup: table_of(*setup, depth).compact() for setup, depth in deepest.items()}
    return tuple(made[setup] for setup in setups)


def _kept_state(before: Fit, problem: TrialsProblem) -> Array:
    names = [(t.condition, t.name) for t in before.model.problem.trials]
    return np.array([before.nuisance[names.index((t.condition, t.name))] for t in problem.trials])


def _ranges(study: Study) -> Array:
    """(C,) largest range of each signal."""
    each = [np.nanmax(c.signals, axis=(0, 1)) - np.nanmin(c.signals, axis=(0, 1)) for c in study.conditions]
    ranges = np.nanmax(each, axis=0)
    if ranges.size > 1:
        ranges[1:] = np.nanmax(ranges[1:])
    return np.asarray(np.maximum(ranges, 1e-9))


def _first_noise(study: Study) -> NoiseModel:
    scale = np.tile(criteria.FIRST_NOISE * _ranges(study), (study.trial_count, 1))
    return NoiseModel((criteria.FIRST_MEMORY,) * len(study.names), scale)


def _wide(study: Study) -> TrialPrior:
    peak = max(c.around.peak_force for c in study.conditions)
    interval = study.raw_interval
    return replace(WIDE, zero=0.5 * peak, shift=max(0.02, 2.0 * interval), offset=WIDE.offset)


def first_guess(problem: TrialsProblem) -> tuple[Array, Array]:
    """Vector (p,) and nuisances (R, q) to begin with: modulus and gains by the ratio of peaks."""
    model = EffectModel(problem, ())
    vector = np.zeros(model.size)
    state = np.zeros((len(problem.trials), nuisance_count(problem)))
    signals = model.signals(vector, state)
    ratio = [
        np.ptp(trial.signals[:, 0]) / max(np.ptp(signal[:, 0]), 1e-12)
        for trial, signal in zip(problem.trials, signals, strict=True)
    ]
    logs = np.log(np.maximum(ratio, 1e-9))
    vector[0] = np.median(logs)
    state[:, 0] = logs - vector[0]
    state[:, 1] = [trial.signals[:3, 0].mean() for trial in problem.trials]
    return vector, state


def pure_errors(fitted: Fit, alike: Sequence[int] | None = None) -> list[Array]:
    """What each trial's residual (n, C) does not share with its mates', its own nuisances taken out.

    Mates are the trials of its condition, or those of the same number in `alike` (R,). Scaled so that the variance is
    the noise's; NaN for a trial without mates.
    """
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    rows = unlike_mates(fitted, signals, alike)
    return [_less_nuisances(each, signal) for each, signal in zip(rows, signals, strict=True)]


def unlike_mates(fitted: Fit, signals: Sequence[Array], alike: Sequence[int] | None = None) -> list[Array]:
    """The same with what the trial's own nuisances could take up of it still in; `signals` (n, C) are the model's."""
    problem = fitted.model.problem
    groups = [trial.condition for trial in problem.trials] if alike is None else list(alike)
    out: list[Array] = [np.zeros(0)] * len(groups)
    for number in dict.fromkeys(groups):
        mine = [i for i, group in enumerate(groups) if group == number]
        if len(mine) < 2:
            out[mine[0]] = np.full_like(problem.trials[mine[0]].signals, np.nan)
            continue
        gains = np.ones((len(mine), 1, problem.trials[mine[0]].signals.shape[1]))
        gains[:, 0, 0] = np.exp(fitted.nuisance[mine, 0])
        rows = np.array([problem.trials[i].signals - signals[i] for i in mine]) / gains
        counts = np.array([problem.trials[i].count for i in mine]) > 0.0
        mean = np.sum(rows * counts, axis=0) / np.maximum(counts.sum(axis=0), 1)
        factor = np.sqrt(len(mine) / (len(mine) - 1.0))
        own = (rows - mean) * counts * gains * factor
        for k, i in enumerate(mine):
            out[i] = own[k]
    return out


def _less_nuisances(rows: Array, signals: Array) -> Array:
    """Rows (n, C) less what a gain, a zero and a time shift of the trial explain, channel by channel."""
    out = rows.copy()
    for k in range(rows.shape[1]):
        shape = signals[:, k]
        columns = np.column_stack([np.ones_like(shape), shape, np.gradient(shape)])[:, : 3 if k == 0 else 1]
        out[:, k] -= columns @ np.linalg.lstsq(columns, rows[:, k], rcond=None)[0]
    return out


def _estimated(fitted: Fit) -> tuple[TrialsProblem, list[str]]:
    """The problem with noise and spreads from a fit, and remarks on noisy trials, which count for less."""
    problem = fitted.model.problem
    errors = pure_errors(fitted)
    known = [i for i, error in enumerate(errors) if np.isfinite(error).all()]
    if not known:
        errors = [_rough(trial.signals, signal) for trial, signal in _pairs(fitted)]
        known = list(range(len(errors)))
    memory, columns = [], []
    for signal in range(errors[0].shape[1]):
        pick = [errors[i][:, signal] for i in known]
        counts = [problem.trials[i].count[:, signal] for i in known]
        memory.append(_pooled_memory(pick, counts))
        columns.append(_shrunk(pick, counts, memory[-1], known, len(errors)))
    scale = np.column_stack(columns)
    noise = NoiseModel(tuple(memory), scale)
    worst = (scale / _usual(scale, [trial.condition for trial in problem.trials])).max(axis=1)
    lively = _spread(fitted.nuisance[:, 0]) > 0.3
    bad = (worst > criteria.NOISY) & (not lively)
    warnings = [
        f"trial {problem.trials[i].name}: {worst[i]:.3g} times as noisy as the others" for i in np.flatnonzero(bad)
    ]
    return replace(problem, noise=noise, prior=_spreads(fitted, scale)), warnings


def _usual(scale: Array, condition: Sequence[int]) -> Array:
    """(R, C) medians over the trials of the same condition: a quick protocol leaves more than a slow one."""
    numbers = np.array(condition)
    out = np.broadcast_to(np.median(scale, axis=0), scale.shape).copy()
    for number in np.unique(numbers):
        mine = numbers == number
        if mine.sum() >= criteria.ENOUGH_ALIKE:
            out[mine] = np.median(scale[mine], axis=0)
    return out


def _pairs(fitted: Fit) -> list[tuple[TrialRef, Array]]:
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    return list(zip(fitted.model.problem.trials, signals, strict=True))


def _rough(measured: Array, simulated: Array) -> Array:
    """Errors of a trial without replicates: what a running mean of its residual leaves."""
    rows = measured - simulated
    kernel = np.ones(9) / 9.0
    smooth = np.column_stack([np.convolve(rows[:, k], kernel, mode="same") for k in range(rows.shape[1])])
    return np.asarray(rows - smooth)


def _pooled_memory(errors: list[Array], counts: list[Array]) -> float:
    sizes = {error.size for error in errors}
    groups = [[k for k, error in enumerate(errors) if error.size == size] for size in sizes]
    votes = [fit_memory(np.array([errors[k] for k in g]), np.array([counts[k] for k in g])) for g in groups]
    return float(np.average(votes, weights=[len(g) for g in groups]))


def _shrunk(errors: list[Array], counts: list[Array], memory: float, known: list[int], total: int) -> Array:
    """(total,) scales, each halfway (in logarithm) to the median's; the median's where nothing is known."""
    own = np.array([scales(e[None], c[None], memory)[0] for e, c in zip(errors, counts, strict=True)])
    own = np.where(np.isfinite(own), own, np.nanmedian(own))
    own = np.maximum(own, 1e-3 * np.median(own) + 1e-12)
    middle = float(np.median(own))
    out = np.full(total, middle)
    out[known] = np.sqrt(own * middle)
    far = own / middle > 2.0
    out[np.array(known)[far]] = own[far]
    return out


def _spread(values: Array) -> float:
    return float(np.std(values, ddof=1)) if values.size > 1 else 0.0


def _gain_spread(problem: TrialsProblem, gain: Array) -> float:
    """Standard deviation of log gains (R,) on one specimen under one tool, give or take what is told of the tools.

    Between tools a ratio of stiffness is no scatter of trials: a machine that gives way makes one.
    """
    setups = [problem.study.conditions[trial.condition].setup for trial in problem.trials]
    kinds = list(dict.fromkeys(setups))
    freedom = len(setups) - len(kinds)
    if len(kinds) < 2 or freedom < len(kinds) or len({tissue for tissue, *_ in kinds}) > 1:
        return _spread(gain)
    groups = np.array([kinds.index(setup) for setup in setups])
    left = gain - np.array([gain[groups == group].mean() for group in groups])
    return float(np.hypot(np.sqrt(left @ left / freedom), criteria.TOOLS_APART))


def _size(values: Array) -> float:
    """Root mean square: what all trials share, such as a late sensor, is no less likely than what they do not."""
    return float(np.sqrt(np.mean(values**2)))


def _early(touch: Array) -> float:
    """Root mean square round zero of touches (R,) that are all early, as by a force, and else round their mean.

    A touch that all trials have late is free travel: an effect.
    """
    return float(np.hypot(np.std(touch), min(float(touch.mean()), 0.0)))


def _spreads(fitted: Fit, scale: Array) -> TrialPrior:
    state = fitted.nuisance
    noise = float(np.median(scale[:, 0]))
    zeros = fitted.model.problem.zeros
    placed = np.array([name in PLACED for name in zeros], dtype=bool)
    offset = _spread(state[:, len(OWN) :][:, placed].ravel()) if zeros else 1.0
    rest = float(np.mean(np.std(state[:, len(OWN) :][:, ~placed], axis=0, ddof=1))) if not placed.all() else 1.0
    deepest = max(condition.around.peak_depth for condition in fitted.model.problem.study.conditions)
    floor = float(np.median(scale[:, 1:])) if scale.shape[1] > 1 else 1.0
    return TrialPrior(
        gain=max(_gain_spread(fitted.model.problem, state[:, 0]), 3e-3),
        zero=max(_size(state[:, 1]), 0.2 * noise, 1e-9),
        shift=max(_size(state[:, 2]), 0.05 * fitted.model.problem.study.raw_interval, 1e-4),
        height=max(_early(state[:, 3]), criteria.LEAST_HEIGHT * deepest),
        offset=max(offset, 0.3 * floor, 1e-9),
        rest=max(rest, 0.3 * floor, 1e-9),
        thickness=thickness_spread(fitted),
    )
