"""What a discovery found: plain results in SI units, for the files, the report and the tests."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

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
class NamedEffect:
    """An effect of the answer.

    Attributes
    ----------
    slug : str
        Of the catalogue.
    confidence : float
        0 to 1: the weight of this effect among the candidates within reach of the best.
    lookalikes : tuple of str
        Effects that these data cannot separate from it.
    parameters : tuple of Estimate
    """

    slug: str
    confidence: float
    lookalikes: tuple[str, ...]
    parameters: tuple[Estimate, ...]


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
        Mean residual (measured minus simulated) over the trials, N for the force and m for markers.
    percent_of_signal : float
        Its size as a share of the channel's largest signal.
    p : float
        Family-wise, by sign flips of whole trials.
    """

    channel: str
    phase: str
    condition: str
    cycle: int
    depth: tuple[float, float]
    size: float
    percent_of_signal: float
    p: float


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
        Pure error of the replicates, N or m; None where no trial was repeated.
    closed : float or None
        (before^2 - after^2) / (before^2 - floor^2), an unknown floor as 0; None where nothing was to be closed.
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


def channel_unit(channel: str) -> tuple[str, float]:
    """Unit of a channel and the factor from SI to it."""
    return ("N", 1.0) if channel.startswith("force") else ("mm", 1e3)
