"""The answer of a fit of parameters: values with intervals, what is not determined, and why.

What is not determined (`identifiability`) is said so wherever it is quoted, whatever the fit's best value is.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from benchmark.identification.fitted_parameters import FittedParameter
from benchmark.identification.model_error import ModelError
from benchmark.identification.parameters.free_parameters import Parameter, Prior
from benchmark.identification.parameters.held_out import HeldOut, contradiction, held_out
from benchmark.identification.parameters.identifiability import (
    KNOWN,
    LARGEST_ERROR,
    LEFT_NOISES,
    Direction,
    correlation_words,
    directions,
    discrepancy_use,
    errors_alone,
    held_off,
    unfollowed,
)
from benchmark.identification.parameters.layer_fit import LayerFit
from benchmark.identification.parameters.layer_model import MM
from benchmark.identification.parameters.presses.marker_rings import TRUST
from benchmark.identification.parameters.presses.press_surrogate import Press
from benchmark.identification.parameters.profile_likelihood import Profile, largest_errors, verified_profiles
from benchmark.identification.pooling import counted_trials
from benchmark.identification.trial_features import sample_noise
from benchmark.response.force_curve import Array

NOT_DETERMINED = "not determined"
ONE_BY_ONE = (
    "See whether each has the units, specimen, tool and support that it was pressed with, fit each in a folder of its "
    "own, or let the command discover say which effect is missing. What the fit came to, not to be quoted"
)
PRIOR_ALONE = "on its prior alone"
FAR = 2.0
"""Standard uncertainties beyond which a told value of the set-up has moved far: one in twenty does by chance."""
LEFT = 0.02
"""Share of the force from which on what a law leaves is told of, where it is `LEFT_NOISES` times samples' scatter."""
CONTRADICTED = 5.0
"""Standard uncertainties beyond which the trials contradict what was told: one in two million does by chance."""


@dataclass(frozen=True)
class Estimate:
    """A free parameter's value and 95 % interval in `unit`; no interval where it is not determined.

    Attributes
    ----------
    key : str
        With the specimen's name in brackets where specimens have their own.
    value : float
    low, high : float or None
    unit : str
    identifiable : bool
        Whether the trials determine it, without its prior.
    prior : str or None
        The prior and its source.
    reason : str
        Why it is not determined; empty where it is.
    """

    key: str
    value: float
    low: float | None
    high: float | None
    unit: str
    identifiable: bool
    prior: str | None
    reason: str

    @property
    def standing(self) -> str:
        """Whether it is determined, by what: yes, on its prior alone, or not."""
        return "yes" if self.identifiable else NOT_DETERMINED if self.low is None else PRIOR_ALONE

    @property
    def warning(self) -> str:
        """Why the trials do not determine it, and what its interval rests on where it has one."""
        return f"{self.key} {'is' if self.low is None else 'rests'} {self.standing}: {self.reason}"

    @property
    def text(self) -> str:
        """Key, value and interval, or that there is none."""
        unit = f" {self.unit}" if self.unit else ""
        if not self.identifiable and self.low is None:
            return f"{self.key} {NOT_DETERMINED}"
        rests = "" if self.identifiable else f", {PRIOR_ALONE}"
        return f"{self.key} {self.value:.4g}{unit} (95 % {self.low:.4g} to {self.high:.4g}{rests})"

    @property
    def source(self) -> str:
        """Of the interval, or why there is none."""
        if self.identifiable:
            return "profile likelihood"
        return self.reason if self.low is None else f"{PRIOR_ALONE} ({self.prior}): {self.reason}"

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        interval = None if self.low is None else [self.low, self.high]
        return {
            "value": self.value,
            "unit": self.unit,
            "ci95": interval,
            "identifiable": self.identifiable,
            "interval": "profile likelihood" if interval is not None else NOT_DETERMINED,
            "prior": self.prior,
            **({"reason": self.reason} if self.reason else {}),
        }


@dataclass(frozen=True, eq=False)
class Identified:
    """A fit of parameters with its intervals.

    Attributes
    ----------
    found : LayerFit
    names : tuple of str
        Of the free parameters, as they are quoted.
    profiles : tuple of Profile
        One a free parameter.
    before : tuple of Direction
        What the trials could tell, with usual noise, where the fit began.
    held_out : tuple of HeldOut
    specimens : tuple of str
        Names of the sessions.
    others : tuple of LayerFit
        Answers away from this one that follow the trials as well.
    remarks : tuple of str
        What was changed of the presses, one sentence each.
    """

    found: LayerFit
    names: tuple[str, ...]
    profiles: tuple[Profile, ...]
    before: tuple[Direction, ...]
    held_out: tuple[HeldOut, ...]
    specimens: tuple[str, ...]
    others: tuple[LayerFit, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def free(self) -> tuple[Parameter, ...]:
        """The free parameters."""
        return tuple(self.found.problem.parameters[k] for k in self.found.problem.free)

    @cached_property
    def directions(self) -> tuple[Direction, ...]:
        """What the trials tell, the least known first."""
        return directions(self.found)

    @cached_property
    def estimates(self) -> tuple[Estimate, ...]:
        """Values and intervals."""
        largest = largest_errors(self.profiles)
        return tuple(self._estimate(place, float(largest[place])) for place in range(len(self.names)))

    def _estimate(self, place: int, largest: float) -> Estimate:
        index, own = self.found.problem.free[place], self.profiles[place]
        parameter, at = self.found.problem.parameters[index], float(self.found.vector[index])
        ends = own.determined(at)
        trusted = self.found.settled and not self.contradicted and not self.conflict
        identifiable = ends and largest <= LARGEST_ERROR and trusted
        quoted = ends and trusted and (identifiable or parameter.prior is not None)
        values = sorted(parameter.scale * parameter.value(each) for each in (own.low, own.high)) if quoted else ()
        low, high = values if values else (None, None)
        prior = None if parameter.prior is None else f"{_prior(parameter)}; {parameter.prior.source}"
        reason = "" if identifiable else self._reason(place, largest)
        value = parameter.scale * self.found.value(index)
        return Estimate(self.names[place], value, low, high, parameter.unit, identifiable, prior, reason)

    def _reason(self, place: int, largest: float) -> str:
        if not self.found.settled:
            return "the fit did not settle, so that its values are no answer"
        if self.conflict:
            return "one law does not follow all conditions, so that no value is right for all of them"
        if self.contradicted:
            return (
                f"the trials contradict what was told of {', '.join(self.contradicted)}, so that this value, the "
                "law, the contact or an effect that is not in the model is wrong"
            )
        parameter, at = self.free[place], float(self.found.vector[self.found.problem.free[place]])
        if parameter.at_end(at):
            ends = " to ".join(f"{parameter.scale * each:.4g}" for each in (parameter.low, parameter.high))
            return f"it stands at the end of what it may be ({ends} {parameter.unit}".rstrip() + "; [fit.bounds])"
        deviation = float(errors_alone(self.found.fit, self.found.problem.free)[place])
        if self.others and largest <= LARGEST_ERROR:
            return "two or more answers away from each other follow the trials equally well"
        if deviation <= LARGEST_ERROR < largest:
            return (
                f"the trials tell it to {100 * deviation:.2g} % at this value (standard error without priors), but to "
                f"{_no_better(largest)} at others that follow them as well; allowed {100 * LARGEST_ERROR:.0f} %"
            )
        weak = [one for one in self.directions if not one.known and abs(one.parts[place]) > 0.3]
        what = weak[0].text if weak else "its interval does not end within a factor of two"
        size = "nothing of it" if deviation > 10.0 else f"it to {100 * deviation:.0f} % alone"
        return f"the trials tell {size} (standard error without priors): {what}"

    @cached_property
    def markers(self) -> dict[str, float] | None:
        """What was fitted of markers: trials, rings, and the rms that is left of a ring (um); None without any."""
        found = self.found
        pairs = zip(found.problem.trials, found.model.moved(found.vector, found.fit.nuisance), strict=False)
        left = [one.film.moved - moved for one, moved in pairs if one.film is not None and moved is not None]
        if not left:
            return None
        rms = math.sqrt(float(np.mean(np.concatenate(left) ** 2)))
        return {
            "trials": len(left),
            "rings": found.problem.rings,
            "residual_um": 1e6 * rms,
            "trust_percent": 100.0 * TRUST,
        }

    @property
    def undetermined(self) -> tuple[Estimate, ...]:
        """Those that the trials do not determine."""
        return tuple(one for one in self.estimates if not one.identifiable)

    @property
    def headline(self) -> str:
        """The fit in one sentence."""
        trials = counted_trials(len(self.found.problem.trials))
        law = "" if self.found.problem.law is None else f", law {self.found.problem.law}"
        apart = "one law does not follow all conditions; " if self.conflict else ""
        return f"{trials}{law}: {apart}{'; '.join(one.text for one in self.estimates)}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know before a figure is quoted."""
        said = [*self.remarks, *([] if self.found.spread is None else [self.found.spread.text])]
        said += [f"{self.conflict}. {ONE_BY_ONE}: {self._values(self.found)}"] if self.conflict else []
        said += [one.warning for one in self.undetermined]
        said += [*self._leaves, *self._moved_far, *filter(None, self._held[1:])]
        use = discrepancy_use(self.found)
        said += [] if use is None else [use.text]
        said += [f"another answer follows the trials as well: {self._values(one)}" for one in self.others]
        said += [] if self.found.settled else [self._unsettled]
        if self.found.problem.freedom < 1:
            said.append("no set-up was pressed twice: the scatter of trials is assumed (1.5 %), not measured")
        return tuple(said)

    @cached_property
    def _left(self) -> tuple[Array, Array]:
        """(R,) what the fit leaves of each trial's force, and what its samples scatter by, over the force's range."""
        predicted = zip(self.found.problem.trials, self.found.predicted, strict=True)
        of = [(np.sqrt(np.mean((one.data.force - f) ** 2)), sample_noise(one.data.force), one) for one, f in predicted]
        left, noise = np.array([(rms / np.ptp(one.data.force), own / np.ptp(one.data.force)) for rms, own, one in of]).T
        return left, noise

    @cached_property
    def _unfollowed(self) -> list[str]:
        """A warning for each press whose trials leave alike what is no noise."""
        return unfollowed(self.found)

    @property
    def _leaves(self) -> list[str]:
        """A warning where the law leaves much of the force, and much more than noise."""
        left, noise = (float(np.median(each)) for each in self._left)
        if left <= max(LEFT, LEFT_NOISES * noise):
            return self._unfollowed
        return [
            f"the law leaves {100.0 * left:.2g} % of the force (median over trials of the root mean square), where "
            f"samples scatter by {100.0 * noise:.2g} %: the values are those of a law that does not follow these "
            "trials, and their intervals, which trust it, may be far too narrow; let the command discover say what is "
            "missing"
        ]

    @property
    def _moved_far(self) -> list[str]:
        """A warning for each told value of the set-up that the trials move beyond what it is known to."""
        return [
            f"the trials move {one.key} from {one.scale * prior.value:.4g} to "
            f"{one.scale * self.found.value(k):.4g} {one.unit}".strip()
            + f", {far:.2g} standard uncertainties ({prior.source}), and the free values go with it: measure it, look "
            "for another law or contact, or let the command discover say which effect is missing"
            for k, one, prior, far in self._moved
            if far > FAR
        ]

    @cached_property
    def conflict(self) -> str:
        """How conditions contradict each other under one law; "" where they do not, or several specimens scatter."""
        several = self.found.spread is not None or len(self.specimens) > 1
        return "" if several else contradiction(self.held_out)

    @cached_property
    def contradicted(self) -> tuple[str, ...]:
        """Told values that the trials move further than chance does, and free ones that are held off what they ask."""
        return (*(one.key for _, one, _, far in self._moved if far > CONTRADICTED), *self._held[0])

    @cached_property
    def _held(self) -> tuple[tuple[str, ...], str]:
        return held_off(self.found, self.names)

    @cached_property
    def _moved(self) -> tuple[tuple[int, Parameter, Prior, float], ...]:
        """Told values of the set-up, each with its place, prior, and standard uncertainties from it to the fit's."""
        return tuple(
            (k, one, prior, abs(float(self.found.vector[k]) - one.coordinate(prior.value)) / prior.deviation)
            for k, one in enumerate(self.found.problem.parameters)
            if one.told and (prior := one.prior) is not None
        )

    @property
    def _unsettled(self) -> str:
        fewer = "fewer free keys, " if len(self.free) > 1 else ""
        return (
            f"the fit did not settle in {self.found.rounds} rounds: pressed with the values where it stopped, the "
            f"model's force still differs by {100 * self.found.disagreement:.2g} % from the one that they were fitted "
            f"with (allowed {100 * self.found.problem.agrees:.2g} %). What may help: {fewer}told values nearer to the "
            "specimen's (--set), [fit.bounds], or trials that press less deep"
        )

    def _values(self, answer: LayerFit) -> str:
        """The free parameters of an answer in words."""
        free = zip(self.names, self.free, answer.problem.free, strict=True)
        return ", ".join(f"{name} {one.scale * answer.value(k):.4g} {one.unit}".strip() for name, one, k in free)

    @property
    def rows(self) -> tuple[FittedParameter, ...]:
        """Rows of `fitted_parameters.csv`: free parameters, then what was told with an uncertainty."""
        free = [
            FittedParameter(one.key, one.value, one.unit, one.low, one.high, one.identifiable, one.source, one.prior)
            for one in self.estimates
        ]
        told = [self._told_row(k, one) for k, one in enumerate(self.found.problem.parameters) if one.told]
        return (*free, *told)

    def _told_row(self, index: int, one: Parameter) -> FittedParameter:
        half = 1.96 * math.sqrt(float(self.found.fit.covariance[index, index]))
        at = float(self.found.vector[index])
        low, high = sorted(one.scale * one.value(at + sign * half) for sign in (-1.0, 1.0))
        source = "told" if one.prior is None else one.prior.source
        value = one.scale * self.found.value(index)
        said = f"{source}{self._whose(one)}; told, moved along by the fit"
        return FittedParameter(one.key, value, one.unit, low, high, False, said, source)

    def _whose(self, one: Parameter) -> str:
        """Of which tool or specimen something was told, where it was of several: their rows have one key."""
        alike = [other for other in self.found.problem.parameters if other.told and other.key == one.key]
        if len(alike) < 2:
            return ""
        if one.tool is not None:
            return f", tool of {MM * one.tool.radius:g} mm"
        names = [press.session.name for press in self.found.problem.presses if press.specimen == one.specimen]
        return f", {names[0]}" if names else ""

    def to_dict(self) -> dict[str, Any]:
        """What `fit.json` gains."""
        found, use, problem = self.found, discrepancy_use(self.found), self.found.problem
        return {
            "parameters": {one.key: one.to_dict() for one in self.estimates},
            "law": found.problem.law,
            "forward": found.problem.forward,
            "directions": [one.to_dict() for one in self.directions],
            "directions_before": [one.to_dict() for one in self.before],
            "determined_limits": {"factor": math.exp(KNOWN), "standard_error": LARGEST_ERROR},
            "correlations": list(correlation_words(found)),
            "told": [row.to_dict() for row in self.rows if row.name not in self.names],
            "residual_percent_of_peak": 100.0 * float(np.median(self._left[0])),
            "trial_scatter_percent": 100.0 * found.model.gain_deviation,
            "noise_memory": found.memory,
            "model_error": [
                _model_error(one, error) for one, error in zip(problem.presses, problem.errors, strict=True)
            ],
            **({} if found.spread is None else {"spread": found.spread.to_dict()}),
            **({} if use is None else {"discrepancy": use.to_dict()}),
            **({} if self.markers is None else {"markers": self.markers}),
            "rounds": found.rounds,
            "settled": found.settled,
            "other_answers": [self._values(one) for one in self.others],
            "held_out": {one.condition: one.to_dict() for one in self.held_out},
            "profiles": {name: _curve(self, k) for k, name in enumerate(self.names)},
        }


def _model_error(press: Press, error: ModelError) -> dict[str, float | None]:
    """How far the model is trusted in a press: entry of `fit.json`."""
    return {
        "tool_radius_mm": MM * press.setup[1].radius,
        "depth_mm": MM * press.depth,
        "mesh_percent": None if press.mesh_error is None else 100.0 * press.mesh_error,
        "size_percent": 100.0 * error.size,
        "slope_percent": 100.0 * error.slope,
        "bend_percent": 100.0 * error.bend,
    }


def _curve(identified: Identified, place: int) -> Mapping[str, list[float]]:
    """The profile of a parameter: values in its unit, and rises of -2 log likelihood."""
    parameter, own = identified.free[place], identified.profiles[place]
    values = [parameter.scale * parameter.value(float(x)) for x in own.coordinate]
    return {"value": values, "rise": own.rise.tolist()}


def _no_better(error: float) -> str:
    return f"{100 * error:.0f} %" if error < 1.0 else "no better than threefold"


def _prior(parameter: Parameter) -> str:
    prior = parameter.prior
    if prior is None:
        return ""
    unit = f" {parameter.unit}" if parameter.unit else ""
    return f"{parameter.scale * prior.value:.4g}{unit} +/- {100 * prior.deviation:.3g} %"


def identify(
    found: LayerFit,
    others: Sequence[LayerFit],
    before: Sequence[Direction],
    groups: Sequence[str],
    specimens: Sequence[str],
) -> Identified:
    """Intervals, directions and held-out predictions of a fit.

    Parameters
    ----------
    found : LayerFit
    others : sequence of LayerFit
        Answers that follow the trials as well.
    before : sequence of Direction
        Where the fit began.
    groups : sequence of str
        The group of each trial that is held out together.
    specimens : sequence of str
        Names of the sessions.
    """
    parameters = [found.problem.parameters[k] for k in found.problem.free]
    names = tuple(
        one.key if one.specimen is None or len(specimens) < 2 else f"{one.key} [{specimens[one.specimen]}]"
        for one in parameters
    )
    found, others, profiles = verified_profiles(found, others)
    return Identified(found, names, profiles, tuple(before), held_out(found, groups), tuple(specimens), tuple(others))
