"""What a model predicts of trials that its fit has not seen: a condition, a tool, or a fifth of the only condition."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.answer.gap import FOLDS, floors, mean_squares, share_closed
from benchmark.discovery.base.effect_model import Fit, settled
from benchmark.discovery.base.trials_problem import only
from benchmark.discovery.discovery_result import Array, Trace
from benchmark.discovery.evidence.gains import conditions
from benchmark.discovery.refitting.press_model import EffectsInModel, PressFit, Stand
from benchmark.discovery.refitting.refit_result import HeldOutKind, Prediction

MOST_SPLITS = 6
"""Held-out parts of a session. Cost."""


@dataclass(frozen=True, eq=False)
class Split:
    """Trials that a fit has not seen.

    Attributes
    ----------
    left : (R,) bool
    kind : str
        As in `Prediction.held_out`.
    name : str
        Of their conditions.
    """

    left: NDArray[np.bool_]
    kind: HeldOutKind
    name: str


@dataclass(frozen=True, eq=False)
class Refitted:
    """Effects in a model, its fit to all trials, and where that stands."""

    work: EffectsInModel
    fit: PressFit
    stand: Stand

    def residuals(self) -> list[Array]:
        """Measured minus simulated (n, C) of each trial that was fitted."""
        model = self.fit.model
        signals = model.signals(self.fit.vector, self.fit.nuisance)
        return [trial.signals - each for trial, each in zip(model.problem.trials, signals, strict=True)]

    def unseen(self, left: NDArray[np.bool_]) -> list[Array]:
        """Those of the trials of a mask (R,) by a fit to the others; only their own nuisances are settled.

        The fit is that of the expansion where the refit stands; what it predicts is pressed where it ended.
        """
        problem, nuisance = self.fit.model.problem, self.fit.nuisance
        kept, mine = np.flatnonzero(~left), np.flatnonzero(left)
        stand = self.work.stand(self.work.once(only(problem, kept.tolist()), self.stand, nuisance[kept]))
        model = self.work.pressed(only(problem, mine.tolist()), stand)
        vector = self.work.vector(model, stand)
        signals = model.signals(vector, settled(model, vector, nuisance[mine]))
        return [trial.signals - each for trial, each in zip(model.problem.trials, signals, strict=True)]


def splits(chosen: Fit) -> Iterator[Split]:
    """What is held out in turn: each condition, each tool of several conditions; of one condition parts of its trials.

    A condition whose tool no other condition has is an unseen tool.
    """
    groups, study = conditions(chosen), chosen.model.problem.study
    numbers = np.unique(groups)
    if numbers.size == 1:
        turn = np.arange(groups.size) % min(FOLDS, groups.size)
        yield from (Split(turn == k, "trials", study.conditions[0].name) for k in np.unique(turn))
        return
    tools = {int(number): study.conditions[number].tool for number in numbers}
    alike = {tool: [number for number, other in tools.items() if other == tool] for tool in tools.values()}
    several = len(alike) > 1
    for number, tool in tools.items():
        alone = several and len(alike[tool]) == 1
        yield Split(groups == number, "tool" if alone else "condition", study.conditions[number].name)
    for mine in alike.values():
        if several and len(mine) > 1:
            yield Split(np.isin(groups, mine), "tool", ", ".join(study.conditions[number].name for number in mine))


Rows = list[tuple[list[Array], list[Array]]]
"""Of each split: residuals of its trials without and with the effects."""


def unseen_rows(parts: Sequence[Split], plain: Refitted, repaired: Refitted) -> Rows:
    """Residuals of every split by both; raises TissuebenchError where a model does not cover a set-up."""
    return [(plain.unseen(part.left), repaired.unseen(part.left)) for part in parts]


def predictions(
    chosen: Fit, plain: Refitted, repaired: Refitted, parts: Sequence[Split], rows: Rows
) -> list[Prediction]:
    """Of the fit itself and of every held-out part, a channel each; the parts of one condition count together."""
    floor = floors(chosen)
    every = np.ones(len(chosen.model.problem.trials), dtype=bool)
    out = _of_part(chosen, floor, Split(every, "nothing", "all"), (plain.residuals(), repaired.residuals()))
    if parts and parts[0].kind == "trials":
        order = np.argsort(np.concatenate([np.flatnonzero(part.left) for part in parts]))
        together = [[each for pair in rows for each in pair[side]] for side in (0, 1)]
        pair = ([together[0][k] for k in order], [together[1][k] for k in order])
        return out + _of_part(chosen, floor, Split(every, "trials", parts[0].name), pair)
    for part, pair in zip(parts, rows, strict=True):
        out += _of_part(chosen, floor, part, pair)
    return out


def _of_part(chosen: Fit, floor: list[Array], part: Split, pair: tuple[list[Array], list[Array]]) -> list[Prediction]:
    """One prediction a channel."""
    mine = np.flatnonzero(part.left)
    some = only(chosen.model.problem, mine.tolist())
    before, after, least = (mean_squares(some, each) for each in (*pair, [floor[k] for k in mine]))
    channels = chosen.model.problem.study.channels
    out = []
    for channel in dict.fromkeys(channels):
        pick = [k for k, other in enumerate(channels) if other == channel]
        one, two, noise = (float(table[:, pick].mean()) for table in (before, after, least))
        known = bool(np.isfinite(noise))
        explained = share_closed(one, two, noise) if known else None
        sizes = (float(np.sqrt(one)), float(np.sqrt(two)), float(np.sqrt(noise)) if known else None)
        out.append(Prediction(part.kind, part.name, channel, *sizes, explained))
    return out


def traces(chosen: Fit, parts: Sequence[Split], rows: Rows) -> Iterator[Trace]:
    """The force of the middle trial of every held-out part, with the scatter of replicates as noise."""
    errors, groups = floors(chosen), conditions(chosen)
    for part, (before, after) in zip(parts, rows, strict=True):
        mine = np.flatnonzero(part.left)
        at = mine.size // 2
        trial = chosen.model.problem.trials[mine[at]]
        mates = np.flatnonzero(groups == trial.condition)
        noise = np.nan_to_num(np.sqrt(np.mean([errors[k] ** 2 for k in mates], axis=0)))[:, 0]
        measured = np.where(trial.count > 0.0, trial.signals, np.nan)[:, 0]
        curves = (measured, trial.signals[:, 0] - before[at][:, 0], trial.signals[:, 0] - after[at][:, 0], noise)
        yield Trace(
            trial.name,
            f"{part.kind}: {part.name}",
            "force_z",
            True,
            trial.motion.read.time,
            trial.motion.read.depth,
            *curves,
        )
