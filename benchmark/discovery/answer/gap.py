"""How much of the gap closed on held-out data: channel by channel, of what trials share, and as curves for pictures.

The replicates' pure error is the floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import pure_errors
from benchmark.discovery.base.effect_model import EffectModel, Fit, settled
from benchmark.discovery.base.trials_problem import TrialsProblem, followed, only, replicates
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.disagreement import shared_misfit
from benchmark.discovery.discovery_result import Array, ChannelGap, Trace
from benchmark.discovery.evidence.gains import conditions, delta_bic, effective_size
from benchmark.response.least_squares import Search, least_squares

DECIMALS = 6
"""Of the share that is closed; what lies beyond is round-off, as in a channel that no effect touches."""
CONVERGED = Search(most=40, gain=0.03, share=1e-5)
"""Of a fit whose prediction is shown: few steps from where effects ended leave a base that no one would use."""
FOLDS = 5
"""Parts of a single condition that are held out in turn, each by a fit of its own."""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Residuals (n, C) of each trial by a fit that has not seen it, before and after; `kind` as in `ChannelGap`."""

    before: list[Array]
    after: list[Array]
    kind: str


def unbent(base: Fit, chosen: Fit) -> Fit:
    """The base fitted again, with bends and marker field as they are beside the effects.

    A missing effect bends the base; what it hides by that is part of the gap. It is fitted until it has converged, from
    where the base stands and from where the effects left it, and the better fit is taken.
    """
    names = chosen.model.problem.shapes
    pinned = tuple((n, float(v)) for n, v in zip(names, chosen.vector, strict=False) if not followed(n))
    model = EffectModel(chosen.model.problem, (), pinned)
    starts = (base, chosen)
    fits = [least_squares(model, f.vector[: len(names)], f.nuisance, search=CONVERGED) for f in starts]
    return min(fits, key=lambda each: each.objective)


def held_out_residuals(base: Fit, chosen: Fit) -> HeldOut:
    """Fit without each condition (or, with one, without each fifth of its trials); only their nuisances are settled."""
    groups = conditions(base)
    if np.unique(groups).size > 1:
        parts, kind = [groups == number for number in np.unique(groups)], "condition"
    else:
        turn = np.arange(groups.size) % min(FOLDS, groups.size)
        parts, kind = [turn == k for k in np.unique(turn)], "trial"
    known = [_without(base, left) for left in parts]
    before = _residuals(base, parts, known)
    if chosen is base:
        return HeldOut(before, before, kind)
    tried = [_without(chosen, left) for left in parts]
    return HeldOut(before, _residuals(chosen, parts, [_told(*fits) for fits in zip(known, tried, strict=True)]), kind)


def _residuals(fitted: Fit, parts: list[np.ndarray], known: list[Fit]) -> list[Array]:
    """Each part's trials alone are simulated with what the others gave."""
    problem = fitted.model.problem
    out: list[Array] = [np.zeros(0)] * len(problem.trials)
    for left, others in zip(parts, known, strict=True):
        mine = np.flatnonzero(left)
        model = replace(others.model, problem=only(problem, mine.tolist()))
        state = settled(model, others.vector, fitted.nuisance[mine])
        for index, signal in zip(mine, model.signals(others.vector, state), strict=True):
            out[index] = problem.trials[index].signals - signal
    return out


def _without(fitted: Fit, left: np.ndarray) -> Fit:
    """The fit to the other trials (mask (R,) of those left out), until it has converged."""
    kept = np.flatnonzero(~left)
    model = replace(fitted.model, problem=only(fitted.model.problem, kept.tolist()))
    columns = fitted.columns.only(kept)
    return least_squares(model, fitted.vector, fitted.nuisance[kept], known=columns, search=CONVERGED)


def _told(base: Fit, chosen: Fit) -> Fit:
    """Of two fits to the same trials the one that these would give: effects only where their BIC would be accepted.

    The limit of a sensor that none of them reaches would foretell a deeper press by any number.
    """
    return chosen if delta_bic(chosen, base, effective_size(base)) < criteria.ACCEPT_BIC else base


def floors(base: Fit) -> list[Array]:
    """Pure error (n, C) of each trial's replicates: trials of one condition and one specimen; NaN without any.

    Trials whose gains differ by more than a specimen's own do are of different ones, whatever is told.
    """
    alike = np.array(replicates(base.model.problem))
    gains = base.nuisance[:, 0]
    for number in np.unique(alike):
        mine = np.flatnonzero(alike == number)
        if mine.size > 1 and np.std(gains[mine], ddof=1) > criteria.ONE_SPECIMEN:
            alike[mine] = alike.max() + 1 + np.arange(mine.size)
    return pure_errors(base, tuple(alike.tolist()))


def gaps(base: Fit, held: HeldOut, settings: Settings) -> tuple[ChannelGap, ...]:
    """The gap in each channel."""
    draws = _draws(base, settings)
    tables = [_channel_squares(base, rows) for rows in (held.before, held.after, floors(base))]
    out = []
    for channel in tables[0]:
        before, after, floor = (table[channel] for table in tables)
        told = np.isfinite(floor)
        one, two = (float(np.sqrt(values.mean())) for values in (before, after))
        if not told.any():
            out.append(ChannelGap(channel, one, two, None, None, None, held.kind))
            continue
        floor = np.where(told, floor, np.median(floor[told]))
        closed = share_closed(before.mean(), after.mean(), floor.mean())
        interval = None if closed is None else _interval((before, after, floor), draws)
        out.append(ChannelGap(channel, one, two, float(np.sqrt(floor.mean())), closed, interval, held.kind))
    return tuple(out)


def grows(base: Fit, held: HeldOut, channels: Sequence[ChannelGap], settings: Settings) -> bool:
    """Whether the effects predict nothing: some channel's gap surely grows, and no channel is surely missed by less.

    A gap is what lies over the replicates' error. It grows where the mean square does by more than round-off, too.
    """
    gone = {each.channel for each in channels if each.ci95 is not None and each.ci95[1] < 0.0}
    before, after = (_channel_squares(base, rows) for rows in (held.before, held.after))
    larger = [after[each].mean() > (1.0 + criteria.WORSE) * before[each].mean() for each in gone]
    return any(larger) and not shrinks(base, held, settings)


def shrinks(base: Fit, held: HeldOut, settings: Settings) -> bool:
    """Whether some channel is surely missed by less where it is held out.

    That may be so where the replicates' error hides its gap: it is the same in both predictions of a trial, whose
    difference is free of it.
    """
    before, after = (_channel_squares(base, rows) for rows in (held.before, held.after))
    draws = _draws(base, settings)
    less = [before[channel] - after[channel] for channel in before]
    return any(np.quantile([each[draw].mean() for draw in draws], 0.025) > 0.0 for each in less)


def _channel_squares(base: Fit, rows: list[Array]) -> dict[str, Array]:
    """(R,) mean squares of each trial's rows (n, C) by channel."""
    table, channels = _squares(base, rows), np.array(base.model.problem.study.channels)
    return {str(each): table[:, channels == each].mean(axis=1) for each in dict.fromkeys(channels.tolist())}


def _draws(base: Fit, settings: Settings) -> list[Array]:
    """Resampled trials, condition by condition."""
    groups, generator = conditions(base), np.random.default_rng(settings.seed)
    return [_draw(groups, generator) for _ in range(settings.bootstraps)]


def _interval(squares: tuple[Array, Array, Array], draws: list[Array]) -> tuple[float, float] | None:
    """95 % of the share closed over resampled trials; None where none has anything to close."""
    resampled = (share_closed(*(each[draw].mean() for each in squares)) for draw in draws)
    kept = [value for value in resampled if value is not None]
    if not kept:
        return None
    low, high = np.quantile(kept, [0.025, 0.975]).tolist()
    return low, high


def _draw(groups: Array, generator: np.random.Generator) -> Array:
    parts = [np.flatnonzero(groups == number) for number in np.unique(groups)]
    return np.concatenate([generator.choice(part, part.size) for part in parts])


def _squares(base: Fit, rows: list[Array]) -> Array:
    """(R, C) mean squares of each trial."""
    return mean_squares(base.model.problem, rows)


def mean_squares(problem: TrialsProblem, rows: list[Array]) -> Array:
    """(R, C) mean squares of each trial's rows (n, C), weighted by their samples."""
    out = []
    for trial, residual in zip(problem.trials, rows, strict=True):
        weight = trial.count
        total = np.maximum(weight.sum(axis=0), 1e-12)
        out.append(np.sum(weight * residual**2, axis=0) / total)
    return np.array(out)


def share_closed(before: float, after: float, floor: float) -> float | None:
    """Share of the gap over the floor that is gone, all three mean squares; None where there is nothing to close."""
    open_before = before - floor
    if open_before <= criteria.LEAST_GAP * floor:
        return None
    return float(min(round((before - after) / open_before, DECIMALS) + 0.0, 1.0))  # + 0.0: no minus zero


def closed_overall(base: Fit, held: HeldOut) -> float | None:
    """The gap closed in all channels together, each in units of its noise; None where no replicates tell the noise."""
    floor = _squares(base, floors(base))
    if not np.isfinite(floor).any():
        return None
    known = np.where(np.isfinite(floor), floor, np.nanmedian(floor, axis=0))
    unit = np.maximum(known.mean(axis=0), 1e-300)
    before, after = (float((_squares(base, rows) / unit).mean()) for rows in (held.before, held.after))
    return share_closed(before, after, float((known / unit).mean()))


def worse(base: Fit, held: HeldOut) -> tuple[str, ...]:
    """Conditions that the effects, fitted to the others, predict worse than the base does, in units of the noise.

    With one condition, its name where its held-out trials are predicted worse. Force and markers count alike, each
    channel by the noise with which fits weigh it.
    """
    problem, groups = base.model.problem, conditions(base)
    before, after = (_misfits(base, rows) for rows in (held.before, held.after))
    names = []
    for number in np.unique(groups):
        mine = groups == number
        if after[mine].mean() > (1.0 + criteria.WORSE) * before[mine].mean():
            names.append(problem.study.conditions[number].name)
    return tuple(names)


def _misfits(base: Fit, rows: list[Array]) -> Array:
    """(R,) mean square of each trial's residual (n, C) in units of its signals' noise, the mean of channel means."""
    problem = base.model.problem
    squares = _squares(base, rows) / np.median(problem.noise.scale, axis=0) ** 2
    channels = np.array(problem.study.channels)
    each = [squares[:, channels == channel].mean(axis=1) for channel in dict.fromkeys(problem.study.channels)]
    return np.asarray(np.mean(each, axis=0))


def share_left(before: Fit, after: Fit) -> float:
    """Share of the misfit that trials share which a model with effects surely leaves of the one without; 0 to 1.

    What is left is taken one standard deviation lower than it was found, as if of as many free numbers as rows.
    """
    opened, problem = shared_misfit(before), after.model.problem
    rows = sum(condition.signals[0].size for condition in problem.study.conditions)
    sure = shared_misfit(after) - np.sqrt(2.0 * rows)
    return float(np.clip(sure / opened, 0.0, 1.0)) if opened > 0.0 else 0.0


def traces(base: Fit, held: HeldOut) -> tuple[Trace, ...]:
    """One trace a trial and channel; of a channel's marker combinations the liveliest."""
    problem = base.model.problem
    errors, groups, shown = floors(base), conditions(base), _shown(base)
    out = []
    for index, trial in enumerate(problem.trials):
        mates = np.flatnonzero(groups == trial.condition)
        noise = np.nan_to_num(np.sqrt(np.mean([errors[k] ** 2 for k in mates], axis=0)))
        measured = np.where(trial.count > 0.0, trial.signals, np.nan)
        before, after = (trial.signals - rows[index] for rows in (held.before, held.after))
        name = problem.study.conditions[trial.condition].name
        for channel, k in shown.items():
            curves = (measured[:, k], before[:, k], after[:, k], noise[:, k])
            out.append(Trace(trial.name, name, channel, True, trial.motion.read.time, trial.motion.read.depth, *curves))
    return tuple(out)


def _shown(base: Fit) -> dict[str, int]:
    """The signal that stands for each channel."""
    study = base.model.problem.study
    size = np.max([np.ptp(trial.signals, axis=0) for trial in base.model.problem.trials], axis=0)
    out: dict[str, int] = {}
    for k, channel in enumerate(study.channels):
        if channel not in out or size[k] > size[out[channel]]:
            out[channel] = k
    return out
