"""A session's data with the base of each condition, the noise and the priors: all that a fit needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.base.setup_priors import is_modulus, is_setup
from benchmark.discovery.trials.study import ConditionData, Study
from benchmark.physics import Motion
from benchmark.response.elastic_table import ElasticTable
from benchmark.response.force_curve import Array
from benchmark.response.noise import Whitener, whitener

GRID_SCALE, LENS, CENTRE = "grid_scale", "lens", ("centre_x", "centre_y")
MARKER_SHAPES = ("width", "marker_exponent", "marker_size", "tilt_x", "tilt_y", "lens")
FOLLOWED = ("modulus", "exponent", "width")
OWN = ("gain", "zero", "shift", "height", "thickness")
"""What each trial has of its own whatever is measured; the zeros of its markers follow.

`height` is the depth at which the tool touches, `thickness` by which share its specimen is thicker than the session's.
"""


def followed(name: str) -> bool:
    """Whether a base may well be wrong in a nuisance; the others stand for its last per cent."""
    return name in FOLLOWED or is_setup(name)


@dataclass(frozen=True)
class TrialPrior:
    """Standard deviations over trials: log gain, force zero (N), time shift (s), touching depth, marker zeros (m).

    `offset` is of zeros that tell where the camera stands, `rest` of the others, where the layout has them; `thickness`
    is a share, 0 where all trials are of one specimen or of equal ones.
    """

    gain: float
    zero: float
    shift: float
    height: float
    offset: float
    rest: float = 1e-2
    thickness: float = 0.0


@dataclass(frozen=True, eq=False)
class TrialRef:
    """One trial of the study: where it is and what it measured; signals and samples in them (n, C).

    Frames are of other instants than the rows of force: `frame_row` (n,) and `frame_share` (n,) place them in time
    between two rows.
    """

    condition: int
    row: int
    number: int
    name: str
    motion: Motion
    signals: Array
    count: Array
    frame_row: NDArray[np.int64]
    frame_share: Array

    def at_frames(self, rows: Array) -> Array:
        """Values (n, ...) at the rows' times taken to the frames' times."""
        share = self.frame_share.reshape(-1, *[1] * (rows.ndim - 1))
        return np.asarray(rows[self.frame_row] * (1.0 - share) + rows[self.frame_row + 1] * share)


@dataclass(frozen=True, eq=False)
class NoiseModel:
    """Memory (C,) of each signal and the raw samples' scale (trials, C)."""

    memory: tuple[float, ...]
    scale: Array


@dataclass(frozen=True, eq=False)
class TrialsProblem:
    """What is fitted.

    Attributes
    ----------
    study : Study
    tables : tuple of ElasticTable
        One a condition.
    noise : NoiseModel
    prior : TrialPrior
    trials : tuple of TrialRef
        All trials, condition by condition.
    mask : tuple of (n, C) bool arrays or None
        Cells that count, by condition; None: all.
    setup : mapping of str to float
        Relative standard deviations of set-up parameters, by their keys.
    """

    study: Study
    tables: tuple[ElasticTable, ...]
    noise: NoiseModel
    prior: TrialPrior
    trials: tuple[TrialRef, ...]
    mask: tuple[np.ndarray, ...] | None = None
    setup: Mapping[str, float] = field(default_factory=dict)

    @property
    def shapes(self) -> tuple[str, ...]:
        """Names of the base's nuisances in use."""
        return tuple(self.shape_priors)

    @property
    def shape_priors(self) -> Mapping[str, float]:
        """Their standard deviations."""
        layout = self.study.layout
        moving = layout is not None and any(table.outward is not None for table in self.tables)
        forms = {k: size for k, size in criteria.SHAPE_PRIOR.items() if moving or k not in MARKER_SHAPES}
        if layout is not None and LENS in forms:
            forms[LENS] = layout.lens_within(forms[LENS])[1]
        printed = {GRID_SCALE: layout.scale_error} if layout is not None and layout.scale_error > 0.0 else {}
        if layout is not None and moving and layout.centre_error > 0.0:
            printed |= dict.fromkeys(CENTRE, layout.centre_error)
        return {"modulus": forms.pop("modulus"), **self.setup, **forms, **printed}

    @property
    def shape_means(self) -> Mapping[str, float]:
        """Where the base's nuisances lie by what was told or seen at rest; those that are not named at zero."""
        layout = self.study.layout
        if layout is None or LENS not in self.shape_priors:
            return {}
        return {LENS: layout.lens_within(criteria.SHAPE_PRIOR[LENS])[0]}

    @cached_property
    def moduli(self) -> tuple[str, ...]:
        """Keys of all layers' moduli, where a factor on all of them does nothing but scale the force; else none.

        Tables have no mixed terms. Along what all layers share of their changes these would undo the others, so that
        it is taken for that factor: of two layers the ratio then has its whole second order.
        """
        keys = tuple(key for key in self.setup if is_modulus(key))
        if len(keys) < 2 or any(key not in table.by for key in keys for table in self.tables):
            return ()
        shares = [sum(table.by[key].force[0, -1] for key in keys) / table.force[-1] for table in self.tables]
        return keys if np.allclose(shares, 1.0, atol=criteria.SCALES) else ()

    @property
    def zeros(self) -> tuple[str, ...]:
        """Marker combinations with a zero of their own in each trial."""
        return self.study.layout.zeros if self.study.layout is not None else ()

    def whiteners(self, index: int) -> list[Whitener]:
        """One a signal for a trial, its scale included."""
        trial = self.trials[index]
        out = []
        for signal, memory in enumerate(self.noise.memory):
            use = whitener(trial.count[:, signal], memory)
            out.append(replace(use, scale=use.scale * self.noise.scale[index, signal]))
        return out


def trial_refs(study: Study) -> tuple[TrialRef, ...]:
    """All trials of a study; cells without a value count no samples and are set to zero."""
    out = []
    for number, condition in enumerate(study.conditions):
        for row in range(condition.size):
            signals = condition.signals[row]
            count = np.where(np.isfinite(signals), condition.count[row], 0.0)
            known = np.nan_to_num(signals)
            place = (number, row, int(condition.numbers[row]), condition.trials[row])
            frames = _between(condition.time[row], condition.frame_time[row])
            out.append(TrialRef(*place, _motion(condition, row), known, count, *frames))
    return tuple(out)


def _motion(condition: ConditionData, row: int) -> Motion:
    """Of a trial, with the rows that its record has before it."""
    record = condition.records[row]
    first = slice(record.earlier)
    time = 0.5 * (record.borders[1:] + record.borders[:-1])[first]
    own = (condition.time[row], condition.depth[row], condition.acceleration[row])
    before = (time, record.given[first], np.zeros_like(time))
    rows = [np.concatenate(parts) for parts in zip(before, own, strict=True)]
    return Motion(rows[0], rows[1], rows[2], record)


def _between(time: Array, frames: Array) -> tuple[NDArray[np.int64], Array]:
    """Where times (n,) lie between rows: the row before and the share of the way to the next."""
    row = np.clip(np.searchsorted(time, frames) - 1, 0, time.size - 2)
    return row, np.clip((frames - time[row]) / (time[row + 1] - time[row]), 0.0, 1.0)


def replicates(problem: TrialsProblem) -> tuple[int, ...]:
    """(R,) numbers by which trials of one condition and one specimen are alike."""
    keys = [(t.condition, int(problem.study.conditions[t.condition].specimens[t.row])) for t in problem.trials]
    known = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    return tuple(known[key] for key in keys)


def only(problem: TrialsProblem, trials: Sequence[int]) -> TrialsProblem:
    """The problem of some of its trials, whose nuisances are then in the same order."""
    noise = NoiseModel(problem.noise.memory, problem.noise.scale[list(trials)])
    return replace(problem, trials=tuple(problem.trials[i] for i in trials), noise=noise)
