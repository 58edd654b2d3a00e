"""What held-out trials and conditions say for a model against another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from benchmark.child_processes import Mapped
from benchmark.discovery import criteria
from benchmark.discovery.base.bent_form import straight
from benchmark.discovery.base.effect_model import Fit, fit, settled
from benchmark.discovery.base.trials_problem import only
from benchmark.discovery.discovery_result import Array
from benchmark.response.least_squares import descend
from benchmark.response.noise import whitener

FORETOLD: WeakKeyDictionary[Fit, Array] = WeakKeyDictionary()
"""What `held_out` gave for a fit, as long as it lives."""
REFITTED: WeakKeyDictionary[Fit, dict[bytes, Array]] = WeakKeyDictionary()
"""What fits without some trials say of these, by the mask of them."""


@dataclass(frozen=True, eq=False)
class Gain:
    """Held-out log density of each trial (R,) less another model's, with mean and standard error.

    `z` is the mean over its error of sign(g) ln(1 + |g|), so that a trial which gains a hundred times what the others
    do (one beyond a limit, the stiffest specimen) neither carries nor spoils it.
    """

    each: Array
    mean: float
    error: float
    z: float


@dataclass(frozen=True, eq=False)
class Scored:
    """A candidate with its evidence against the model `under` it, to which it adds."""

    fit: Fit
    slug: str
    gain: Gain
    transfer: Gain | None
    delta_bic: float
    under: Fit

    @property
    def slugs(self) -> tuple[str, ...]:
        """Effects of the candidate."""
        return tuple(effect.slug for effect in self.fit.model.effects)


def conditions(fitted: Fit) -> Array:
    """(R,) number of each trial's condition."""
    return np.array([trial.condition for trial in fitted.model.problem.trials])


def strain(fitted: Fit) -> float:
    """What the base's shape costs under its priors, in log density: it may bend to the data, but not for nothing."""
    first = fitted.model.shape_count
    moved = (fitted.vector - fitted.prior_mean)[:first]
    return 0.5 * float(np.sum(fitted.precision[:first] * moved**2))


def held_out(fitted: Fit) -> Array:
    """(R,) log density of each trial under the fit to the others, less its share of the base's strain.

    To first order, but where that step away from a trial costs the trial more than `TOO_FAR`: there the fit converges
    without it, since a curved effect, such as a limit that one trial reaches more than the others, is stepped over.
    Of a fit that is bent that is the fit with its forms as they are.
    """
    return foretold([fitted])[0]


def foretold(fits: Sequence[Fit], mapped: Mapped = map) -> list[Array]:
    """`held_out` of several fits: worked out once for each, since the same one is compared with many others."""
    new = [fit for fit in dict.fromkeys(fits) if fit not in FORETOLD]
    FORETOLD.update(zip(new, mapped(_foretold, new), strict=True))
    return [FORETOLD[fit] for fit in fits]


def _foretold(fitted: Fit) -> Array:
    """See `held_out`."""
    count = len(fitted.model.problem.trials)
    with_all, out = fitted.log_density(fitted.vector), np.empty(count)
    for index in range(count):
        left = np.arange(count) == index
        out[index] = fitted.log_density(fitted.without(left))[index]
        if with_all[index] - out[index] > criteria.TOO_FAR:
            out[left] = _refitted(fitted, left)
    return out - strain(fitted) / count


def held_out_conditions(fitted: Fit) -> Array:
    """(R,) log density of each trial under the fit to the other conditions, to first order; strain as in `held_out`."""
    groups = conditions(fitted)
    out = np.empty(groups.size)
    for number in np.unique(groups):
        left = groups == number
        out[left] = fitted.log_density(fitted.without(left))[left]
    return out - strain(fitted) / groups.size


def refitted_conditions(fitted: Fit) -> Array:
    """(R,) log density of each trial under the fit to the other conditions, converged; strain as in `held_out`.

    To first order a strongly curved effect, such as a bond that lets go at a height, may end far beyond what one
    condition tells of it.
    """
    groups = conditions(fitted)
    out = np.empty(groups.size)
    for number in np.unique(groups):
        left = groups == number
        out[left] = _refitted(fitted, left)
    return out - strain(fitted) / groups.size


def _refitted(fitted: Fit, left: NDArray[np.bool_]) -> Array:
    """Log density of the trials `left` (R,) under the fit to the others, converged.

    Each is made once, and shared by a fit and what is bent from it.
    """
    fitted = straight(fitted)
    known = REFITTED.setdefault(fitted, {})
    if left.tobytes() not in known:
        known[left.tobytes()] = _refitted_straight(fitted, left)
    return known[left.tobytes()]


def _refitted_straight(fitted: Fit, left: NDArray[np.bool_]) -> Array:
    """The same of a fit whose forms are as they are."""
    model, places = fitted.model, (np.flatnonzero(~left), np.flatnonzero(left))
    others, unseen = (replace(model, problem=only(model.problem, some.tolist())) for some in places)
    columns = fitted.columns.only(places[0])
    found = descend(others, fitted.vector, fitted.nuisance[~left], known=columns, around=fitted.prior_mean).at.vector
    own = settled(unseen, found, fitted.nuisance[left])
    return fit(unseen, found, own, most=0).log_density(found)


def gain(fitted: Array, other: Array, groups: Array) -> Gain:
    """Paired gain of held-out densities (R,) over another model's; the error from the scatter within conditions."""
    each = fitted - other
    even = np.sign(each) * np.log1p(np.abs(each))
    middle = float(even.mean())
    z = middle / max(_error(even, groups), 1e-9 + criteria.LEAST_ERROR * abs(middle))
    return Gain(each, float(each.mean()), _error(each, groups), z)


def tissue_gain(fitted: Fit, own: Mapping[str, Gain]) -> float:
    """Held-out log density that a fit's effects of the tissue gain over all trials, each over the others.

    Their forms are resemblances, and what such a form misses of the true one is a share of what it gains. Rig and
    sensors have their textbook forms.
    """
    tissue = [effect.slug for effect in fitted.model.effects if effect.description.acts_on == "body"]
    return float(sum(own[slug].each.sum() for slug in tissue))


def broad(gain: Gain) -> float:
    """Held-out log density gained in all trials but the one that gains most; 0 where others lose too much of it.

    What acts in the stiffest specimens alone scatters too much between trials for z. One trial may speak against it, as
    one with a spike does, at the price of having been picked out of all, and by less than all gain.
    """
    if gain.mean <= 0.0:
        return 0.0
    rest = np.sort(gain.each)[1:]
    return max(_gained(gain.each), _gained(rest) - float(np.log(gain.each.size)))


def _gained(each: Array) -> float:
    """Sum of gains (R,) but for the largest; 0 where others lose too much of it."""
    total = float(each.sum() - each.max()) if each.size else 0.0
    lost = float(-each[each < 0.0].sum())
    return total if lost < criteria.BROAD_LOST * total else 0.0


def _error(each: Array, groups: Array) -> float:
    """Standard error of a mean over trials (R,), from the scatter within conditions where they have replicates."""
    spread, freedom = 0.0, 0
    for number in np.unique(groups):
        mine = each[groups == number]
        spread += float(((mine - mine.mean()) ** 2).sum())
        freedom += mine.size - 1
    if freedom < 1:
        spread, freedom = float(((each - each.mean()) ** 2).sum()), max(each.size - 1, 1)
    return float(np.sqrt(spread / freedom / each.size))


def effective_size(fitted: Fit) -> float:
    """Independent samples that tell as much as all rows of all signals."""
    problem = fitted.model.problem
    total = 0.0
    for trial in problem.trials:
        for signal, memory in enumerate(problem.noise.memory):
            count = trial.count[:, signal]
            if (count > 0.0).any():
                total += float(np.sum(whitener(count, memory)(np.ones(count.size)) ** 2))
    return max(total, float(len(problem.trials)))


def informed(fitted: Fit) -> float:
    """Parameters of the effects that the data tell of, in number: those only priors hold do not count."""
    first = fitted.model.shape_count
    shares = 1.0 - np.diag(fitted.covariance) * fitted.precision
    return float(np.clip(shares[first:], 0.0, 1.0).sum())


def delta_bic(fitted: Fit, other: Fit, samples: float) -> float:
    """BIC of a model less another's: negative speaks for it."""
    return 2.0 * (fitted.objective - other.objective) + (informed(fitted) - informed(other)) * float(np.log(samples))


def score(current: Fit, fits: Sequence[Fit], mapped: Mapped = map) -> list[Scored]:
    """Candidates by their held-out gain over `current`, best first."""
    groups, samples = conditions(current), effective_size(current)
    before, *densities = foretold([current, *fits], mapped)
    several = np.unique(groups).size > 1
    before_conditions = held_out_conditions(current) if several else None
    out = []
    for made, density in zip(fits, densities, strict=True):
        transfer = gain(held_out_conditions(made), before_conditions, groups) if before_conditions is not None else None
        slug, bic = made.model.effects[-1].slug, delta_bic(made, current, samples)
        out.append(Scored(made, slug, gain(density, before, groups), transfer, bic, current))
    return sorted(out, key=lambda each: -each.gain.mean)
