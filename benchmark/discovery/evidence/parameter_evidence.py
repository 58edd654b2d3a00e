"""What data tell of the effects' parameters: intervals, whether a strength is determined, what each condition says."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from benchmark.comparison.percent_error import plain_percent
from benchmark.discovery import criteria
from benchmark.discovery.base.bent_form import added_by
from benchmark.discovery.base.effect_model import Fit, finely
from benchmark.discovery.base.setup_priors import shares
from benchmark.discovery.discovery_result import Array, ConditionEstimate, Estimate
from benchmark.discovery.evidence.gains import conditions
from benchmark.files.units import shown
from benchmark.physics import Effect, EffectParameter, Together
from benchmark.physics.setup_entry import effect_name, setup_key
from benchmark.response.least_squares import scaled_inverse


def effect_estimates(fitted: Fit) -> tuple[tuple[str, Estimate], ...]:
    """(slug, estimate) of every parameter of the effects."""
    first, half, fine = fitted.model.shape_count, half_widths(fitted), finely(fitted)
    values = fitted.model.values(fitted.vector)
    out = []
    for k, (slug, p) in enumerate(fitted.model.parameters, start=first):
        inner = (fitted.vector[k] - half[k], fitted.vector[k] + half[k]) if has_slope(fine, k) else walked(fitted, k)
        ends = _outer(p, inner[0]), _outer(p, inner[1])
        out.append((slug, Estimate(p.name, values[slug][p.name], p.unit, ends)))
    return tuple(out)


def has_slope(fitted: Fit, place: int) -> bool:
    """Whether the data tell of a number of the vector by a slope: a pull that lets go between two samples has none."""
    return bool(1.0 - fitted.covariance[place, place] * fitted.precision[place] > criteria.TOLD)


def walked(fitted: Fit, place: int) -> tuple[float, float]:
    """Numbers below and above one of the vector from which on the trials speak against it, all else as fitted.

    Its profile at the level of `determined`, in steps that double and are then halved; a bound where they never do.
    """
    value, bounds = float(fitted.vector[place]), (float(each[place]) for each in fitted.model.bounds)
    _, p = fitted.model.parameters[place - fitted.model.shape_count]
    least = FIRST_WALK * (1.0 if p.logarithmic else abs(value))
    below, above = (_walked_to(fitted, place, value, end, np.copysign(least, end - value)) for end in bounds)
    return below, above


def _walked_to(fitted: Fit, place: int, value: float, end: float, step: float) -> float:
    """One of the two, towards a bound."""
    allowed = chi2.ppf(criteria.DETERMINED, 1) + _misfit(fitted, place, value)
    inside, way = value, step
    while step and abs(way) < abs(end - value) and _misfit(fitted, place, value + way) <= allowed:
        inside, way = value + way, 2.0 * way
    outside = value + way if step and abs(way) < abs(end - value) else end
    if _misfit(fitted, place, outside) <= allowed:
        return outside
    for _ in range(WALK_HALVINGS):
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if _misfit(fitted, place, middle) <= allowed else (inside, middle)
    return outside


def _misfit(fitted: Fit, place: int, value: float) -> float:
    """Sum of squared white residuals with another number in the vector."""
    vector = fitted.vector.copy()
    vector[place] = value
    return float(sum(left @ left for left in fitted.model.evaluated(vector, fitted.nuisance).residuals))


def at_bounds(fitted: Fit) -> tuple[str, ...]:
    """A sentence for each effect with parameters as large as they may be (or a time, say, as small)."""
    values = fitted.model.values(fitted.vector)
    found: dict[str, list[str]] = {}
    for slug, p in fitted.model.parameters:
        value = values[slug][p.name]
        if value >= criteria.AT_BOUND * p.high or (p.logarithmic and value <= p.low / criteria.AT_BOUND):
            found.setdefault(slug, []).append(f"{p.name} = {value:.4g} {p.unit}".rstrip())
    return tuple(
        f"{effect_name(slug)} stands at the end of what its parameters may be ({', '.join(said)}): the data may ask "
        "for more of it, or for another form"
        for slug, said in found.items()
    )


def told_together(fitted: Fit) -> tuple[str, ...]:
    """A sentence for each effect whose strength may be none by its own interval, though what it does is told."""
    estimates, out = effect_estimates(fitted), []
    for effect in fitted.model.effects:
        open_ended = any(s == effect.slug and e.name == effect.amplitude and e.ci95[0] <= 0.0 for s, e in estimates)
        if effect.together is None or not open_ended:
            continue
        value, half = _together(fitted, effect.slug, effect.together)
        if half < value:
            unit = shown(value, effect.together.unit)[1]
            each, low, high = (shown(v, effect.together.unit)[0] for v in (value, value - half, value + half))
            out.append(
                f"{effect_name(effect.slug)}: these trials do not tell {effect.amplitude} by itself, but "
                f"{effect.together.words} of {each:.3g} {unit} ({low:.3g} to {high:.3g}); {effect.together.apart} "
                "would tell its parameters apart"
            )
    return tuple(out)


def _together(fitted: Fit, slug: str, together: Together) -> tuple[float, float]:
    """What an effect's parameters are told as, and the half width of its 95 % interval."""
    fine, model = finely(fitted), fitted.model
    around = max((each.around for each in model.problem.study.conditions), key=lambda around: around.peak_depth)
    value, slopes = together.of(model.values(fitted.vector)[slug], around), np.zeros(fitted.vector.size)
    for k, error in enumerate(np.sqrt(np.maximum(np.diag(fine.covariance), 0.0)).tolist()):
        moved = fitted.vector.copy()
        moved[k] += FINE_SHARE * error
        slopes[k] = (together.of(model.values(moved)[slug], around) - value) / max(FINE_SHARE * error, 1e-300)
    variance = max(float(slopes @ m @ slopes) for m in (fine.covariance, sandwich(fine)))
    return value, criteria.NORMAL_95 * math.sqrt(variance)


def moved_far(fitted: Fit) -> tuple[str, ...]:
    """A warning of what was told of the set-up and lies far off beside a fit's effects.

    A form that misses the true one bends the set-up at a cost that is small beside what the effect gains: no strain.
    """
    problem = fitted.model.problem
    free = [(k, name) for k, name in enumerate(problem.shapes) if name in problem.setup]
    away = {name: float(fitted.vector[k] - fitted.prior_mean[k]) for k, name in free}
    far = {key: change for key, change in away.items() if abs(change) > criteria.MOVED_FAR * problem.setup[key]}
    if not (far and fitted.model.effects):
        return ()
    said = ", ".join(
        f"{key} by {plain_percent(100.0 * share, sign=True)}, {abs(far[key]) / problem.setup[key]:.2g} standard "
        "deviations of what was told"
        for key, share in shares(far).items()
    )
    return (
        f"beside what is named the set-up lies far from what was told ({said}): it may make up for an effect whose "
        "form misses, whose size, and the modulus, are then off by more than their intervals",
    )


def _outer(parameter: EffectParameter, inner: float) -> float:
    """A number of the vector as the parameter's value, within its bounds."""
    value = np.exp(np.clip(inner, -700.0, 700.0)) if parameter.logarithmic else inner
    return float(np.clip(value, parameter.low, parameter.high))


def half_widths(fitted: Fit) -> Array:
    """(p,) half widths of the vector's 95 % intervals, widened to the trials' actual scatter (sandwich estimate)."""
    fine = finely(fitted)
    variance = np.maximum(np.diag(fine.covariance), np.diag(sandwich(fine)))
    return np.asarray(criteria.NORMAL_95 * np.sqrt(np.maximum(variance, 0.0)))


def sandwich(fitted: Fit) -> Array:
    """(p, p) covariance of the vector from how the trials' slopes scatter."""
    inner = fitted.covariance
    slopes = fitted.blocks.slope - fitted.blocks.slope.mean(axis=0)
    count = len(slopes)
    return np.asarray(inner @ (slopes.T @ slopes * count / max(count - 1, 1)) @ inner)


FIRST_WALK, WALK_HALVINGS = 0.01, 8
"""Of a number's size, the first step along its profile; and how often its end is halved."""
FINE_SHARE = 1e-6
"""Of a standard error, by which a smooth function of the parameters is differentiated."""
SLOPE_STEP = 0.005
"""By which, in standard errors, a parameter is changed for the slope of what an effect adds: one of which trials tell
nothing by a slope, as the reach of a pull, has its prior's, and what it adds is straight on a small part of that."""


@dataclass(frozen=True)
class _Strength:
    """A parameter by which an effect grows from nothing, and its place in the vector."""

    place: int
    parameter: EffectParameter
    value: float

    @property
    def absent(self) -> bool:
        """Whether it stands at none."""
        return bool(not self.parameter.logarithmic and self.value == max(self.parameter.low, 0.0))

    @property
    def free(self) -> bool:
        """Whether it stands within its range, off nothing and off a bound."""
        p = self.parameter
        if p.logarithmic:
            share = np.log(self.value / p.low) / np.log(p.high / p.low)
            return bool(1.0 - criteria.AT_BOUND < share < criteria.AT_BOUND)
        return bool(not self.absent and p.low < self.value / criteria.AT_BOUND < p.high)


def strengths(fitted: Fit, effect: Effect, names: tuple[str, ...] = ()) -> list[_Strength]:
    """The parameters by which an effect grows, or those of `names`."""
    wanted = names or (effect.amplitude, *effect.amplitudes)
    values = fitted.model.values(fitted.vector).get(effect.slug, {})
    return [
        _Strength(place, p, values[p.name])
        for place, (slug, p) in enumerate(fitted.model.parameters, start=fitted.model.shape_count)
        if slug == effect.slug and p.name in wanted
    ]


def determined(fitted: Fit, effect: Effect, names: tuple[str, ...] = ()) -> bool:
    """Whether the data tell how strong an effect is.

    Some strength must stand off its bounds (a share may be whole), and those that do must differ from none together
    with those that are at none, which cannot take their place: Wald's statistic on the larger of the model's covariance
    and the trials' own scatter, both with the effect's form as fitted. A logarithmic strength has no none: its interval
    must be narrower than its range. One without a slope is told by its profile.
    """
    found = strengths(fitted, effect, names)
    whole = [each for each in found if each.parameter.high == 1.0 and each.value > criteria.AT_BOUND]
    free = [each for each in found if each.free]
    if not free:
        return bool(whole)
    stepped = [each for each in free if not each.parameter.logarithmic and not has_slope(fitted, each.place)]
    if any(walked(fitted, each.place)[0] > max(each.parameter.low, 0.0) for each in stepped):
        return True
    if not all(each.parameter.logarithmic for each in free):
        free += [each for each in found if each.absent]
    places = [each.place for each in free]
    form = [each.place for each in strengths(fitted, effect, effect.form)] if effect.form else []
    covariance = max((_given(m, places, form) for m in (fitted.covariance, sandwich(fitted))), key=np.trace)
    if all(each.parameter.logarithmic for each in free):
        widths = 2.0 * criteria.NORMAL_95 * np.sqrt(np.diag(covariance))
        return all(w < np.log(e.parameter.high / e.parameter.low) for w, e in zip(widths, free, strict=True))
    plain = [k for k, each in enumerate(free) if not each.parameter.logarithmic]
    amount = np.array([free[k].value for k in plain])
    size = float(amount @ scaled_inverse(covariance[np.ix_(plain, plain)]) @ amount)
    return bool(size > chi2.ppf(criteria.DETERMINED, len(plain)))


def _given(covariance: Array, places: list[int], form: list[int]) -> Array:
    """(k, k) covariance of the parameters at some places, those of the form being held."""
    inner = covariance[np.ix_(places, places)]
    if not form:
        return inner
    across = covariance[np.ix_(places, form)]
    return np.asarray(inner - across @ scaled_inverse(covariance[np.ix_(form, form)]) @ across.T)


def told_parameters(fitted: Fit, effect: Effect) -> int:
    """How many parameters of an effect the data tell of: those that only show in markers count where there are some.

    A strength at none is a term that is not there.
    """
    shares = 1.0 - np.diag(fitted.covariance) * fitted.precision
    idle = {each.place for each in strengths(fitted, effect) if each.absent}
    return sum(
        bool(shares[place] > criteria.TOLD and place not in idle)
        for place, (slug, _) in enumerate(fitted.model.parameters, start=fitted.model.shape_count)
        if slug == effect.slug
    )


def undetermined(fitted: Fit) -> tuple[str, ...]:
    """Effects of a fit of which the data tell neither the strength nor what they add to the force.

    With a modulus that nobody knows a strength may be any large number, while its product with the modulus is known;
    a softening whose width is open may be weak and wide or strong and narrow, and take the same off the force.
    """
    effects = fitted.model.effects
    return tuple(each.slug for each in effects if not determined(fitted, each) and not adds_force(fitted, each))


def strength_told(fitted: Fit, effect: Effect) -> bool:
    """Whether an effect is strong enough to stand beside others: determined by itself or by what it adds to the force.

    A set-up entry has one number alone, which must be told.
    """
    return determined(fitted, effect) or (setup_key(effect.slug) is None and adds_force(fitted, effect))


def adds_force(fitted: Fit, effect: Effect) -> bool:
    """Whether what an effect adds to the force where that is most surely differs from none, by Wald's statistic.

    A share at its bound is no such strength, since it is another form's, nor are logarithmic ones: they have no none.
    """
    grown = strengths(fitted, effect)
    if any(each.parameter.logarithmic or (each.parameter.high <= 1.0 and not each.free) for each in grown):
        return False
    amount = _added_force(fitted, grown, fitted.vector)
    slopes = np.zeros(fitted.vector.size)
    errors = np.sqrt(np.maximum(np.diag(fitted.covariance), 0.0))
    for k, (error, highest) in enumerate(zip(errors, fitted.model.bounds[1], strict=True)):
        moved = fitted.vector.copy()
        step = SLOPE_STEP * error
        moved[k] += step if moved[k] + step <= highest else -step
        change = moved[k] - fitted.vector[k]
        slopes[k] = (_added_force(fitted, grown, moved) - amount) / change if change else 0.0
    variance = max(float(slopes @ m @ slopes) for m in (fitted.covariance, sandwich(fitted)))
    return bool(amount > 0.0 and amount**2 > chi2.ppf(criteria.DETERMINED, 1) * variance)


def _added_force(fitted: Fit, grown: Sequence[_Strength], vector: Array) -> float:
    """The most that strengths add to the force at a vector (p,), over its peak, in the mean of the trials."""
    none = vector.copy()
    for each in grown:
        none[each.place] = max(each.parameter.low, 0.0)
    pairs = zip(*(fitted.model.signals(at, fitted.nuisance) for at in (none, vector)), strict=True)
    most = [np.abs(whole - rest)[:, 0].max() / max(float(whole[:, 0].max()), 1e-300) for rest, whole in pairs]
    return float(np.mean(most))


def seen(fitted: Fit, effect: Effect) -> bool:
    """Whether the data resolve it in time and depth, and markers show it if it must show in them, if there are any."""
    if effect.like_delay and delay(fitted, effect) < criteria.NO_LATER:
        return False
    if not resolved(fitted, effect) or not material(fitted, effect):
        return False
    if not effect.seen_by or fitted.model.problem.study.layout is None:
        return True
    return determined(fitted, effect, (effect.seen_by,))


def resolved(fitted: Fit, effect: Effect) -> bool:
    """Whether the records are fine enough in depth and time for what an effect does."""
    if not (effect.in_depth or effect.acts_within):
        return True
    study, values = fitted.model.problem.study, fitted.model.values(fitted.vector)[effect.slug]
    if effect.in_depth and values[effect.in_depth] < criteria.DEPTH_STEPS * study.depth_step:
        return False
    if effect.acts_within is None:
        return True
    return max(effect.acts_within(values, each.around) for each in study.conditions) > study.raw_interval


def material(fitted: Fit, effect: Effect) -> bool:
    """Whether an effect that shows in the force alone adds more than finite elements and elastic laws are right to."""
    trials = fitted.model.problem.trials
    if fitted.model.problem.study.layout is not None or setup_key(effect.slug) is not None:
        return True
    pairs = zip(trials, added_by(fitted, effect.slug), strict=True)
    added = max(float(np.abs(part[trial.count[:, 0] > 0.0, 0]).max()) for trial, part in pairs)
    return added >= criteria.LEAST_FORCE * max(float(np.abs(trial.signals[:, 0]).max()) for trial in trials)


def delay(fitted: Fit, effect: Effect) -> float:
    """By how much later, in s, the force without an effect would change as much as by the effect."""
    model = fitted.model
    signals, more = model.signals(fitted.vector, fitted.nuisance), added_by(fitted, effect.slug)
    added = rate = 0.0
    for trial, whole, part in zip(model.problem.trials, signals, more, strict=True):
        rows = trial.count[:, 0] > 0.0
        count, force, time = trial.count[rows, 0], part[rows, 0], trial.motion.read.time[rows]
        added += float(count @ force**2)
        rate += float(count @ np.gradient(whole[rows, 0] - force, time) ** 2)
    return math.sqrt(added / rate) if rate > 0.0 else math.inf


def terms_told(fitted: Fit, plain: Effect) -> bool:
    """Whether the data tell the strength of each term that the last effect has more than its plain form.

    A power has no none, and is no strength.
    """
    effect = fitted.model.effects[-1]
    more = [p for p in effect.description.parameters if p.name not in plain.names]
    return all(determined(fitted, effect, (p.name,)) for p in more if not p.logarithmic and p.low <= 0.0)


def by_condition(fitted: Fit) -> tuple[tuple[str, ConditionEstimate], ...]:
    """(slug, estimate) of each parameter from each condition alone; empty with one condition.

    Each condition's own estimate is one step from the joint fit. It agrees where it differs by less than three standard
    errors or by less than a share of the value (`SAME_SHARE`; in the logarithm `SAME_LOG`).
    """
    groups = conditions(fitted)
    numbers = np.unique(groups)
    if numbers.size < 2:
        return ()
    fitted = finely(fitted)
    first, out = fitted.model.shape_count, []
    for number in numbers:
        own = fitted.without(groups != number)
        matrix = fitted.blocks.matrix[groups == number].sum(axis=0) + np.diag(fitted.precision)
        error = np.sqrt(np.maximum(np.diag(scaled_inverse(matrix)), 0.0))
        name = fitted.model.problem.study.conditions[number].name
        for k, (slug, p) in enumerate(fitted.model.parameters, start=first):
            size = criteria.SAME_LOG if p.logarithmic else criteria.SAME_SHARE * abs(fitted.vector[k])
            agrees = bool(abs(own[k] - fitted.vector[k]) < max(criteria.SAME_ERRORS * error[k], size))
            half = criteria.NORMAL_95 * error[k]
            ends = _outer(p, own[k] - half), _outer(p, own[k] + half)
            out.append((slug, ConditionEstimate(p.name, name, _outer(p, own[k]), p.unit, ends, agrees)))
    return tuple(out)


def constant(fitted: Fit) -> bool | None:
    """Whether the effects' parameters agree between conditions, each told from its own trials; None with one."""
    if np.unique(conditions(fitted)).size < 2 or not fitted.model.effects:
        return None
    return all(each.agrees for _, each in by_condition(fitted))


def steady(fitted: Fit, slug: str) -> bool:
    """Whether no condition alone speaks against an effect's parameters."""
    return all(each.agrees for of, each in by_condition(fitted) if of == slug)


def unsteady(fitted: Fit) -> tuple[str, ...]:
    """Effects of rig or sensor whose parameters differ between conditions."""
    instruments = {effect.slug for effect in fitted.model.effects if effect.description.acts_on != "body"}
    moved = dict.fromkeys(slug for slug, each in by_condition(fitted) if slug in instruments and not each.agrees)
    return tuple(moved)
