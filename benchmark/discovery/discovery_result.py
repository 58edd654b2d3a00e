"""What a discovery found: plain results in SI units, for the files, the report and the tests."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

VERDICTS = (
    "no_discrepancy",
    "cannot_tell",
    "named",
    "conditional",
    "lookalikes",
    "partly_explained",
    "outside_catalogue",
    "instrument_first",
)
CHANNELS = ("force_z", "marker_radial", "marker_tangential", "marker_x", "marker_y")
PHASES = ("approach", "load", "hold", "unload_high", "unload_low", "after_lift_off")


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter: value and 95 % interval in `unit` (an SI unit that pint reads; "" without dimension)."""

    name: str
    value: float
    unit: str
    ci95: tuple[float, float]


@dataclass(frozen=True)
class ConditionEstimate:
    """A parameter as one condition alone tells it: value and 95 % interval in `unit`; whether it agrees with all."""

    name: str
    condition: str
    value: float
    unit: str
    ci95: tuple[float, float]
    agrees: bool


@dataclass(frozen=True)
class LookAlike:
    """An effect in the place of a named one: its own parameters, and by how much it predicts unseen trials worse.

    Attributes
    ----------
    slug : str
    parameters : tuple of Estimate
    lacking : float
        Share of the named effect's gain in held-out log density that it lacks; negative where it gains more.
    errors : float
        The same in standard errors over trials; below two the data do not separate them.
    """

    slug: str
    parameters: tuple[Estimate, ...]
    lacking: float
    errors: float


@dataclass(frozen=True)
class NamedEffect:
    """An effect of the answer.

    Attributes
    ----------
    slug : str
        Of the catalogue.
    confidence : float
        0 to 1: how often such an answer was right in blind trials, shared with its look-alikes.
    lookalikes : tuple of str
        Effects that these data cannot rule out in its place.
    parameters : tuple of Estimate
    rivals : tuple of LookAlike
        The look-alikes with their own parameters.
    by_condition : tuple of ConditionEstimate
        Its parameters from each condition alone; empty with one condition.
    gain : float
        What it adds to the held-out log density of a trial, beside the other effects; NaN where that was not asked.
    """

    slug: str
    confidence: float
    lookalikes: tuple[str, ...]
    parameters: tuple[Estimate, ...]
    rivals: tuple[LookAlike, ...] = ()
    by_condition: tuple[ConditionEstimate, ...] = ()
    gain: float = math.nan


@dataclass(frozen=True)
class ChannelSize:
    """How large the misfit of a channel is, whatever its p.

    Attributes
    ----------
    channel : str
    before, after : float
        Root mean square over trials of the mean residual in a cell, the largest cell's, without and with the effects, N
        or m.
    tolerance : float
        Stated beforehand, N or m: a model that misses by more is never called good.
    """

    channel: str
    before: float
    after: float
    tolerance: float

    @property
    def within(self) -> bool:
        """Whether the model of the answer is within the tolerance."""
        return self.after <= self.tolerance


@dataclass(frozen=True)
class Place:
    """A cell in which model and measurement disagree.

    Attributes
    ----------
    channel, phase : str
        Of CHANNELS and PHASES.
    condition : str
    cycle : int
        From 1; 0 where it is no part of a cycle.
    depth : (low, high)
        m.
    size : float
        What the answer's effects add to the simulation there, N for the force and m for markers; without effects the
        residual.
    percent_of_signal : float
        Size of the residual as a share of the channel's largest signal.
    p : float
        Family-wise, by sign flips of whole trials.
    residual : float or None
        Mean of measured minus simulated without the effects over the trials, N or m; None where it is `size`. It may
        differ from what the effects add, even in sign: without them the base bends towards the data.
    either_way : bool
        Whether the residual changes its sign there, so that no cell's mean shows it: the size is then the root mean
        square of what trials share of it row by row.
    """

    channel: str
    phase: str
    condition: str
    cycle: int
    depth: tuple[float, float]
    size: float
    percent_of_signal: float
    p: float
    residual: float | None = None
    either_way: bool = False

    @property
    def missed(self) -> float:
        """Measured minus simulated without the effects, N or m."""
        return self.size if self.residual is None else self.residual

    @property
    def largest_percent(self) -> float:
        """Share of the channel's largest signal: of the residual, or of what the effects add where that is more.

        A base bends towards the data and may leave little where an effect acts most.
        """
        added = abs(self.size / self.residual) if self.residual else 1.0
        return abs(self.percent_of_signal) * max(1.0, added)

    @property
    def added(self) -> float | None:
        """What the effects add to the simulation, N or m; None without effects."""
        return None if self.residual is None else self.size


@dataclass(frozen=True)
class Contrast:
    """One physical question put to the residuals: its answer in words, size (N or m) and p."""

    question: str
    channel: str
    size: float
    p: float


@dataclass(frozen=True)
class ChannelGap:
    """How much of the gap closed in one channel on held-out data.

    Attributes
    ----------
    channel : str
    rmse_before, rmse_after : float
        N or m.
    noise_floor : float or None
        Pure error of replicates of one specimen, N or m; None (not known) where no trial was repeated on one.
    closed : float or None
        (before^2 - after^2) / (before^2 - floor^2); None where nothing was to be closed, or the floor is not known.
    ci95 : (low, high) or None
        By bootstrap over trials.
    held_out : str
        "condition" or "trial".
    """

    channel: str
    rmse_before: float
    rmse_after: float
    noise_floor: float | None
    closed: float | None
    ci95: tuple[float, float] | None
    held_out: str


@dataclass(frozen=True)
class Candidate:
    """A candidate and its evidence.

    Attributes
    ----------
    slugs : tuple of str
        The effects of this candidate together: one, or a set built on accepted ones.
    z : float
        Held-out gain in log density over its standard error, trials as the unit.
    gain, gain_standard_error : float
        Mean per trial and its standard error.
    delta_bic : float
        BIC with it minus BIC without, on the effective sample size: negative speaks for it.
    gap_closed : float or None
        On held-out data, all channels together.
    constant : bool or None
        Whether its parameters stay the same across conditions; None with one condition.
    """

    slugs: tuple[str, ...]
    z: float
    gain: float
    gain_standard_error: float
    delta_bic: float
    gap_closed: float | None
    constant: bool | None


@dataclass(frozen=True)
class SetupEstimate:
    """A set-up parameter with the answer's effects in the model.

    Attributes
    ----------
    key : str
        As in `--set`.
    change : float
        Share of the told value by which it is larger; of a modulus the natural logarithm of the factor, of a choice the
        share of the way to the other one.
    ci95 : (low, high)
    prior : float or None
        Standard deviation of what people know of it, in the same terms; None where the answer names it.
    named : bool
        Whether the answer names it.
    """

    key: str
    change: float
    ci95: tuple[float, float]
    prior: float | None
    named: bool

    @property
    def of_prior(self) -> float | None:
        """The change in standard deviations of its prior."""
        return None if self.prior is None else self.change / self.prior


@dataclass(frozen=True)
class TrialValues:
    """What one trial has of its own, SI.

    Attributes
    ----------
    trial : str
    gain : float
        Factor on its force.
    zero : float
        Force at rest, N.
    late : float
        By which force and frames are late against depth, s.
    touch : float
        Depth at which the tool touches, m.
    at_bound : tuple of str
        Names of those that stand as far off as physics allows.
    thicker : float
        Share by which its specimen is thicker than the session's; 0 where specimens do not differ.
    """

    trial: str
    gain: float
    zero: float
    late: float
    touch: float
    at_bound: tuple[str, ...] = ()
    thicker: float = 0.0


@dataclass(frozen=True, eq=False)
class Trace:
    """One channel of one trial for a picture: (n,) arrays; force in N, markers in m, NaN where nothing was measured.

    `before` is the base model fitted, `after` the model with the effects of the answer (the same where there are
    none), `noise` (n,) the standard deviation of replicates round their mean at each instant.
    """

    trial: str
    condition: str
    channel: str
    held_out: bool
    time: Array
    depth: Array
    measured: Array
    before: Array
    after: Array
    noise: Array


@dataclass(frozen=True, eq=False)
class Discovery:
    """The answer for one session.

    Attributes
    ----------
    verdict : str
        Of VERDICTS.
    statement : str
        The answer in one sentence.
    p : float or None
        Family-wise p of any disagreement; None under `cannot_tell`, and where nothing is random.
    effects : tuple of NamedEffect
        Best first; under `outside_catalogue` the nearest entries, which are not named.
    where : tuple of Place
        Significant cells, largest first.
    contrasts : tuple of Contrast
    gap : tuple of ChannelGap
    smallest_visible : mapping
        Channel to the smallest mean residual that these data would have shown, N or m.
    candidates : tuple of Candidate
        Best first, the base model not among them.
    base : tuple of Estimate
        Base parameters and shape nuisances with the answer's effects in the model.
    remains : tuple of str
        What is left unexplained, a sentence each.
    warnings : tuple of str
    traces : tuple of Trace
    conditions, channels, trials : tuple of str
    seconds : float
        Wall time.
    sizes : tuple of ChannelSize
        One a channel; empty where it was not asked.
    not_shown : mapping
        Effects that such trials cannot show, and what they lack, in words.
    worse : tuple of str
        Held-out conditions that the effects predict worse than the base does.
    undetermined : tuple of str
        Effects of the answer whose strength the data do not tell; they are not named.
    setup : tuple of SetupEstimate
        The set-up against what was told.
    own : tuple of TrialValues
        One a trial.
    """

    verdict: str
    statement: str
    p: float | None
    effects: tuple[NamedEffect, ...]
    where: tuple[Place, ...]
    contrasts: tuple[Contrast, ...]
    gap: tuple[ChannelGap, ...]
    smallest_visible: Mapping[str, float]
    candidates: tuple[Candidate, ...]
    base: tuple[Estimate, ...]
    remains: tuple[str, ...]
    warnings: tuple[str, ...]
    traces: tuple[Trace, ...]
    conditions: tuple[str, ...]
    channels: tuple[str, ...]
    trials: tuple[str, ...]
    seconds: float
    sizes: tuple[ChannelSize, ...] = ()
    not_shown: Mapping[str, str] = field(default_factory=dict)
    worse: tuple[str, ...] = ()
    undetermined: tuple[str, ...] = ()
    setup: tuple[SetupEstimate, ...] = ()
    own: tuple[TrialValues, ...] = ()

    @property
    def within_tolerance(self) -> bool:
        """Whether the model of the answer is within the stated tolerance in every channel."""
        return all(each.within for each in self.sizes)


def channel_unit(channel: str) -> tuple[str, float]:
    """Unit of a channel and the factor from SI to it."""
    return ("N", 1.0) if channel.startswith("force") else ("mm", 1e3)
