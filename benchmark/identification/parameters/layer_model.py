"""What a fit of parameters says of its trials: force over time, with fading layers, and the derivatives of it.

Each trial has three nuisances: the depth at which it touches, the force's zero, and a gain, whose scatter over trials
is a random effect. A layer that fades takes its share of the force along: where its stiffness falls by the share g, the
force falls by 1 - (1 - g)^s, s the sensitivity of the force to that layer; this share fades with the layer's time
constant. That is exact at once and at last, and between them as far as the force follows the layer evenly.
The markers of a filmed trial move with the depth alone, each ring with a zero of its own in each trial.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from benchmark.identification.parameters.presses.marker_rings import MarkerRows
from benchmark.identification.parameters.presses.press_surrogate import VOLUME
from benchmark.identification.sheet_model import Relaxation, relaxed
from benchmark.identification.trial_data import TrialData, group_bounds, reduced, rows_of
from benchmark.identification.trial_features import ContactRange
from benchmark.response.force_curve import Array
from benchmark.response.noise import Whitener
from benchmark.response.trials_model import TrialColumns, TrialsEvaluation

TOUCH, ZERO, GAIN = 0, 1, 2
NUISANCES = 3
"""Before the zeros of the rings."""
MM = 1e3
"""Nuisances have the depth at touch, and the zeros of the markers' rings, in mm."""
RING_ZERO = 1.0
"""Standard deviation of a ring's zero, mm: no more than that it can be eliminated in trials without a film."""
TOUCH_STEP, COORDINATE_STEP = 1e-3, 1e-4
"""Steps of differences: mm, and of a time constant's logarithm."""
MOST_ROWS = 250
MOST_GAIN = 5.0
"""Logarithm, far beyond the factor of ten by which trials of one set-up differ: one at a bound would hold the rest."""
EASED = 2.0
"""Noise of the force over which it begins, at most, on either side of the touch."""
LEAST_EASED = 1e-12
"""m."""


class ForceTable(Protocol):
    """The elastic force of one press at any coordinates (p,), on a grid of depths (k,)."""

    @property
    def depth(self) -> Array:
        """(k,) m, even, from 0."""
        ...

    @property
    def layers(self) -> Mapping[str, Array]:
        """Derivatives (k,) of the force's logarithm by each relaxing layer's stiffness."""
        ...

    def force_at(self, vector: Array) -> Array:
        """(k,) N."""
        ...

    def by_at(self, vector: Array) -> Array:
        """(p, k) derivatives of the force's logarithm by the coordinates."""
        ...

    def rings_at(self, vector: Array) -> Array:
        """(s, k) m of the markers' rings."""
        ...

    def rings_by_at(self, vector: Array) -> Array:
        """(p, s, k) derivatives of the rings' motion by the coordinates, m."""
        ...

    def curve(self, grid: Array, depth: Array) -> Array:
        """(..., n) of quantities on the grid (..., k) at depths (n,), m."""
        ...


@dataclass(frozen=True, eq=False)
class FitTrial:
    """A trial as a fit of parameters takes it.

    Attributes
    ----------
    data : TrialData
        With few enough rows.
    count : (n,) array
        Measured rows in each.
    press : int
        Number of the press it belongs to.
    touch : ContactRange
        Where it may touch.
    onset : float
        Where it touches by the first fit, m.
    film : MarkerRows or None
        What its markers show, where they are fitted.
    """

    data: TrialData
    count: Array
    press: int
    touch: ContactRange
    onset: float = 0.0
    film: MarkerRows | None = None

    @staticmethod
    def of(trial: TrialData, press: int, touch: ContactRange, onset: float = 0.0) -> FitTrial:
        """A measured trial with rows averaged in groups."""
        count = np.ones(trial.rows)
        if trial.rows > MOST_ROWS:
            starts, ends = group_bounds(trial.depth, MOST_ROWS)
            count = (ends - starts).astype(np.float64)
        return FitTrial(reduced(trial, MOST_ROWS), count, press, touch, onset)

    @cached_property
    def gaps(self) -> Array:
        """(n,) m: how far a row's neighbours are in depth, the mean of both."""
        steps = np.abs(np.diff(self.data.depth))
        return np.convolve(np.concatenate([steps[:1], steps, steps[-1:]]), (0.5, 0.5), mode="valid")

    def below(self, touch: float, noise: float) -> Array:
        """(n,) m below the depth at touch (mm): from one row to the next, or what `noise` (N) hides, it begins evenly.

        With a sharp beginning the slope of the likelihood jumps where a row comes into touch. A fit of ten trials then
        ends in the next corner, by up to 3 in -2 log likelihood above the best, and a profile rises too early.
        """
        depth = self.data.depth - touch / MM
        hidden = EASED * noise * float(np.ptp(self.data.depth)) / max(float(np.ptp(self.data.force)), 1e-300)
        over = np.maximum(np.minimum(self.gaps, hidden), LEAST_EASED)
        return np.where(np.abs(depth) < over, (depth + over) ** 2 / (4.0 * over), np.maximum(depth, 0.0))

    def up_to(self, depth: float) -> FitTrial:
        """The trial without the rows that are deeper than `depth` (m) below where it touches."""
        kept = self.data.depth <= self.onset + depth
        film = None if self.film is None else self.film.up_to(self.onset + depth)
        return replace(self, data=rows_of(self.data, kept), count=self.count[kept], film=film)


@dataclass(frozen=True, eq=False)
class FilmNoise:
    """The noise of a film's rows: what whitens it, and the standard deviation (s,) m of each ring in a frame."""

    whitener: Whitener
    deviation: Array

    def white(self, rows: Array) -> Array:
        """(f, s, ...) rows to white ones."""
        own = self.deviation.reshape(-1, *[1] * (rows.ndim - 2))
        return np.asarray(self.whitener(rows) / own)


@dataclass(frozen=True)
class Fading:
    """A layer that fades in a press, or all of them (`layer` empty): where its share and time are in the vector."""

    press: int
    layer: str
    share: int
    time: int


@dataclass(frozen=True, eq=False)
class LayerModel:
    """Trials of presses as functions of coordinates; a `benchmark.response.trials_model.TrialsModel`.

    Attributes
    ----------
    surrogates : tuple of ForceTable
        One a press.
    trials : tuple of FitTrial
    fading : tuple of Fading
    limits : (p,) and (p,) array
        Bounds of the coordinates; equal ones fix them.
    prior_mean, prior_precision : (p,) array
        0 precision for none.
    gain_deviation : float
        Standard deviation of the trials' gains, as shares.
    white : tuple of Whitener
        Each trial's noise.
    noise : (R,) array
        Standard deviation of a measured row, N.
    film_noise : tuple of FilmNoise or None
        Each film's; empty where no markers are fitted.
    """

    surrogates: tuple[ForceTable, ...]
    trials: tuple[FitTrial, ...]
    fading: tuple[Fading, ...]
    limits: tuple[Array, Array]
    prior_mean: Array
    prior_precision: Array
    gain_deviation: float
    white: tuple[Whitener, ...]
    noise: Array
    film_noise: tuple[FilmNoise | None, ...] = ()

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Of the coordinates."""
        return self.limits

    @cached_property
    def trial_precision(self) -> Array:
        """Flat in touch and zero, normal in the gain; next to nothing of the rings' zeros."""
        return np.array([0.0, 0.0, self.gain_deviation**-2, *[RING_ZERO**-2] * self.rings])

    @property
    def rings(self) -> int:
        """Rings of markers."""
        return max((0 if one is None else one.deviation.size for one in self.film_noise), default=0)

    @cached_property
    def trial_bounds(self) -> tuple[Array, Array]:
        """Where each trial may touch, mm; the zero is free, and so is the gain but for what is out of reach."""
        ranges = [(MM * one.touch.low, MM * one.touch.high) for one in self.trials]
        free = [np.inf] * self.rings
        low = np.array([[low, -np.inf, -MOST_GAIN, *(-each for each in free)] for low, _ in ranges])
        high = np.array([[high, np.inf, MOST_GAIN, *free] for _, high in ranges])
        return low, high

    def prior(self, start: Array) -> tuple[Array, Array]:  # noqa: ARG002 - priors do not follow the start
        """Mean and precision of the coordinates' priors."""
        return self.prior_mean, self.prior_precision

    def evaluated(self, vector: Array, nuisance: Array) -> TrialsEvaluation:
        """White residuals; signals are predicted forces (n,) N."""
        grids = [one.force_at(vector) for one in self.surrogates]
        signals = [self._force(k, vector, own, grids) for k, own in enumerate(nuisance)]
        residuals = [self._whitened(k, one.data.force - signals[k]) for k, one in enumerate(self.trials)]
        for k, moved in enumerate(self.moved(vector, nuisance)):
            film, noise = self.trials[k].film, self.film_noise[k]
            if film is not None and noise is not None and moved is not None:
                residuals[k] = np.concatenate([residuals[k], noise.white(film.moved - moved).ravel()])
        return TrialsEvaluation(vector, nuisance, signals, residuals)

    def moved(self, vector: Array, nuisance: Array) -> list[Array | None]:
        """Motion (f, s) m of each trial's rings; None of one without a film, and an empty list without markers."""
        if not self.rings:
            return []
        grids = [one.rings_at(vector) for one in self.surrogates]
        return [self._moved(k, own, grids) for k, own in enumerate(nuisance)]

    def _moved(self, k: int, own: Array, grids: Sequence[Array]) -> Array | None:
        trial = self.trials[k]
        if trial.film is None:
            return None
        curve = self.surrogates[trial.press].curve(grids[trial.press], trial.film.depth - own[TOUCH] / MM)
        return np.asarray(curve.T + own[NUISANCES:] / MM)

    def columns(self, at: TrialsEvaluation, warm: TrialColumns | None = None) -> TrialColumns:  # noqa: ARG002
        """Derivatives of all trials."""
        grids = [one.force_at(at.vector) for one in self.surrogates]
        shares = [one.by_at(at.vector) for one in self.surrogates]
        vector = [self._vector_columns(k, at, grids, shares) for k in range(len(self.trials))]
        rings = [one.rings_by_at(at.vector) for one in self.surrogates] if self.rings else []
        for k, trial in enumerate(self.trials):
            if trial.film is not None and (noise := self.film_noise[k]) is not None:
                below = trial.film.depth - at.nuisance[k, TOUCH] / MM
                by = self.surrogates[trial.press].curve(rings[trial.press], below).transpose(2, 1, 0)
                vector[k] = np.vstack([vector[k], noise.white(by).reshape(-1, at.vector.size)])
        return TrialColumns(vector, self.nuisance_columns(at))

    def nuisance_columns(self, at: TrialsEvaluation) -> list[Array]:
        """By touch, zero and gain, and the rings' zeros."""
        grids = [one.force_at(at.vector) for one in self.surrogates]
        rings = [one.rings_at(at.vector) for one in self.surrogates] if self.rings else []
        out = []
        for k, own in enumerate(at.nuisance):
            plain = self._force_columns(k, at.vector, own, grids)
            force = self._whitened(k, np.column_stack([plain, np.zeros((len(plain), self.rings))]))
            out.append(np.vstack([force, self._film_columns(k, own, rings)]))
        return out

    def force_columns(self, vector: Array, nuisance: Array) -> list[Array]:
        """(n, 3) derivatives of each trial's force by touch, zero and gain: N/mm, 1 and N."""
        grids = [one.force_at(vector) for one in self.surrogates]
        return [self._force_columns(k, vector, own, grids) for k, own in enumerate(nuisance)]

    def _force_columns(self, k: int, vector: Array, own: Array, grids: Sequence[Array]) -> Array:
        step = _touch_step(own)
        more, less = (self._force(k, vector, own + sign * step, grids) for sign in (1.0, -1.0))
        pressing = self._force(k, vector, own, grids) - own[ZERO]
        return np.column_stack([(more - less) / (2.0 * TOUCH_STEP), np.ones_like(pressing), pressing])

    def _film_columns(self, k: int, own: Array, grids: Sequence[Array]) -> Array:
        """(f s, q) white derivatives of one trial's rings by its nuisances; no rows without a film."""
        step = _touch_step(own)
        more, less = (self._moved(k, own + sign * step, grids) if grids else None for sign in (1.0, -1.0))
        if more is None or less is None or (noise := self.film_noise[k]) is None:
            return np.zeros((0, own.size))
        by = np.zeros((*more.shape, own.size))
        by[:, :, TOUCH] = (more - less) / (2.0 * TOUCH_STEP)
        by[:, :, NUISANCES:] = np.eye(more.shape[1]) / MM
        return noise.white(by).reshape(-1, own.size)

    def fixed_at(self, index: int, value: float) -> LayerModel:
        """The model with one coordinate held at a value."""
        low, high = self.limits[0].copy(), self.limits[1].copy()
        low[index] = high[index] = value
        return replace(self, limits=(low, high))

    def within(self, low: Array, high: Array) -> LayerModel:
        """The model with other bounds (p,)."""
        return replace(self, limits=(low, high))

    def predicted(self, vector: Array, nuisance: Array) -> list[Array]:
        """Force (n,) N of each trial."""
        grids = [one.force_at(vector) for one in self.surrogates]
        return [self._force(k, vector, own, grids) for k, own in enumerate(nuisance)]

    def _whitened(self, k: int, rows: Array) -> Array:
        return np.asarray(self.white[k](rows) / self.noise[k])

    def _force(self, k: int, vector: Array, own: Array, grids: Sequence[Array]) -> Array:
        trial = self.trials[k]
        depth = trial.below(float(own[TOUCH]), float(self.noise[k]))
        elastic = self.surrogates[trial.press].curve(grids[trial.press], depth)
        faded = self._faded(trial, vector, depth, elastic)
        pressing = np.where(depth > 0.0, np.maximum(faded, 0.0), 0.0)
        return np.asarray(own[ZERO] + np.exp(own[GAIN]) * pressing)

    def _faded(self, trial: FitTrial, vector: Array, depth: Array, elastic: Array) -> Array:
        """A history of force (n,), or of a change of it, less what has faded of it."""
        for one in self._fading_of(trial):
            (share, time), held = np.exp(vector[[one.share, one.time]]), self._held(trial, one)
            slower = 1.0 - held * share
            weight = 1.0 - ((1.0 - share) / slower) ** self._sensitivity(trial, one, depth)
            part = weight * elastic
            kept = relaxed(trial.data.time, part, Relaxation(1.0, float(time / slower)))
            elastic = elastic - (part - kept)
        return elastic

    def _fading_of(self, trial: FitTrial) -> list[Fading]:
        return [one for one in self.fading if one.press == trial.press]

    def _sensitivity(self, trial: FitTrial, one: Fading, depth: Array) -> Array | float:
        """(n,) how the force's logarithm goes with the stiffness of what fades, its volume's among it."""
        if not one.layer:
            return 1.0
        table = self.surrogates[trial.press]
        both = (table.layers[name] for name in (one.layer, f"{one.layer}{VOLUME}") if name in table.layers)
        return np.asarray(np.interp(depth, table.depth, sum(both)))

    def _held(self, trial: FitTrial, one: Fading) -> float:
        """The share of what fades that is a volume, which does not, in series with a shape that does.

        Compliances that add, a of the whole without and 1 - a with relaxation g, tau, lose g (1 - a) / (1 - a g) of the
        stiffness, with tau / (1 - a g).
        """
        layers, names = self.surrogates[trial.press].layers, self._fading_in(trial, one)
        volume = sum(float(np.mean(layers[f"{name}{VOLUME}"])) for name in names if f"{name}{VOLUME}" in layers)
        whole = volume + sum(float(np.mean(layers[name])) for name in names)
        return min(max(volume / whole, 0.0), 0.99) if whole > 0.0 else 0.0

    def _fading_in(self, trial: FitTrial, one: Fading) -> list[str]:
        """The layers that fade by a share and a time: one, or all that the press knows of."""
        known = self.surrogates[trial.press].layers
        return [one.layer] if one.layer else [name for name in known if not name.endswith(VOLUME)]

    def _vector_columns(self, k: int, at: TrialsEvaluation, grids: Sequence[Array], shares: Sequence[Array]) -> Array:
        """(n, p) white derivatives of one trial's force by the coordinates."""
        trial, own, vector = self.trials[k], at.nuisance[k], at.vector
        table, grid, by = self.surrogates[trial.press], grids[trial.press], shares[trial.press]
        depth, gain = trial.below(float(own[TOUCH]), float(self.noise[k])), np.exp(own[GAIN])
        out = np.zeros((trial.data.rows, vector.size))
        pressing = at.signals[k] > own[ZERO]
        acting = np.flatnonzero(by.any(axis=1))
        moved = table.curve(grid * by[acting], depth)
        if self._fading_of(trial):
            moved = np.array([self._faded(trial, vector, depth, one) for one in moved])
        out[:, acting] = np.where(pressing, gain * moved, 0.0).T
        for one in self._fading_of(trial):
            for place in (one.share, one.time):
                out[:, place] = self._by_difference(k, vector, own, grids, place)
        return self._whitened(k, out)

    def _by_difference(self, k: int, vector: Array, own: Array, grids: Sequence[Array], index: int) -> Array:
        step = np.zeros_like(vector)
        step[index] = COORDINATE_STEP
        more, less = (self._force(k, vector + sign * step, own, grids) for sign in (1.0, -1.0))
        return np.asarray((more - less) / (2.0 * COORDINATE_STEP))


def _touch_step(own: Array) -> Array:
    """(q,) a step of the depth at touch alone."""
    step = np.zeros(own.size)
    step[TOUCH] = TOUCH_STEP
    return step
