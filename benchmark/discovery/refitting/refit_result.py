"""What a refit in the FEM or the wave model found: plain results in SI units for files and page."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from benchmark.discovery.discovery_result import Estimate, Trace, channel_unit
from benchmark.files.units import shown

HeldOutKind = Literal["nothing", "condition", "tool", "trials"]


@dataclass(frozen=True)
class CarriedEffect:
    """How a model carries an effect: in its own equations (`inside`), or on top of its elastic answer; in words."""

    slug: str
    inside: bool
    words: str


@dataclass(frozen=True)
class RefittedNumber:
    """A number of a refit beside the discovery's.

    Attributes
    ----------
    part : str
        Effect, or "base".
    estimate : Estimate
    found : Estimate or None
        The discovery's, where it is the same quantity.
    prior : float or None
        Standard deviation of what is known of a set-up's number.
    """

    part: str
    estimate: Estimate
    found: Estimate | None = None
    prior: float | None = None

    @property
    def of_prior(self) -> float | None:
        """How far a set-up's number is from told, in standard deviations of what is known of it."""
        return None if self.prior is None else self.estimate.value / self.prior

    @property
    def agrees(self) -> bool | None:
        """Whether the intervals overlap; None where the discovery has no such number."""
        if self.found is None:
            return None
        (low, high), (other_low, other_high) = self.estimate.ci95, self.found.ci95
        return low <= other_high and other_low <= high


@dataclass(frozen=True)
class Prediction:
    """How a model does on trials, without and with the effects.

    Attributes
    ----------
    held_out : str
        What the fit has not seen: "nothing" (the fit itself), a "condition", a "tool", or some "trials".
    name : str
        Of the conditions that were held out.
    channel : str
    before, after : float
        Root mean square of measured minus simulated, N or m.
    floor : float or None
        Of replicates among themselves; None where none tell it.
    explained : float or None
        Share of the mean square above the floor that is gone; None where there is nothing to explain.
    """

    held_out: HeldOutKind
    name: str
    channel: str
    before: float
    after: float
    floor: float | None
    explained: float | None

    def row(self, model: str) -> dict[str, Any]:
        """A row of `refitted.csv`: N or mm, and multiples of the floor."""
        unit, scale = channel_unit(self.channel)
        floor = self.floor or None
        return {
            "model": model,
            "held_out": self.held_out,
            "conditions": self.name,
            "channel": self.channel,
            "unit": unit,
            "rmse_before": scale * self.before,
            "rmse_after": scale * self.after,
            "noise_floor": None if floor is None else scale * floor,
            "before_in_noise": None if floor is None else self.before / floor,
            "after_in_noise": None if floor is None else self.after / floor,
            "explained": self.explained,
        }


@dataclass(frozen=True, eq=False)
class ModelRefit:
    """The effects in one model.

    Attributes
    ----------
    model : str
        "fem" or "wave".
    carried : tuple of CarriedEffect
    numbers : tuple of RefittedNumber
    predictions : tuple of Prediction
        The fit itself first.
    adds, found_adds : float
        Root mean square of what the effects add to the force of the trials, here and in the discovery, N.
    apart : float
        Largest relative difference between the model's force and its expansion where the refit ended.
    traces : tuple of Trace
        Held-out trials by this model.
    reason : str
        Why the model has no refit; empty where it has.
    """

    model: str
    carried: tuple[CarriedEffect, ...] = ()
    numbers: tuple[RefittedNumber, ...] = ()
    predictions: tuple[Prediction, ...] = ()
    adds: float = 0.0
    found_adds: float = 0.0
    apart: float = 0.0
    traces: tuple[Trace, ...] = ()
    reason: str = ""

    def document(self) -> dict[str, Any]:
        """Its part of `discovery.json`."""
        if self.reason:
            return {"reason": self.reason}
        return {
            "effects": [{"name": each.slug, "inside": each.inside, "how": each.words} for each in self.carried],
            "parameters": [_number(each) for each in self.numbers],
            "adds_N": self.adds,
            "discovery_adds_N": self.found_adds,
            "expansion_error": self.apart,
            "predictions": [
                {key: value for key, value in each.row(self.model).items() if key != "model"}
                for each in self.predictions
            ],
        }


def refit_rows(refits: Iterable[ModelRefit]) -> list[dict[str, Any]]:
    """All rows of `refitted.csv`."""
    return [each.row(refit.model) for refit in refits for each in refit.predictions]


def _number(number: RefittedNumber) -> dict[str, Any]:
    value, unit = shown(number.estimate.value, number.estimate.unit)
    ends = [shown(end, number.estimate.unit)[0] for end in number.estimate.ci95]
    found = None if number.found is None else shown(number.found.value, number.found.unit)[0]
    return {
        "part": number.part,
        "name": number.estimate.name,
        "value": value,
        "unit": unit,
        "ci95": ends,
        "discovery": found,
        "agrees": number.agrees,
        "of_prior": number.of_prior,
    }
