"""What trials can tell of free parameters, before a fit and after it: singular directions, and words for them.

The sensitivity is white and free of priors on what is free; touch, zero and gain of the trials, and what was told of
the set-up with an uncertainty, are eliminated.

A parameter is determined where its interval ends within a factor of two, and where at no point of the confidence
region the trials alone leave it a standard error beyond what such an interval has. The second is asked because a
likelihood may be steep at the estimate and flat beside it, where the true value may be: what the interval says there
rests on curvature alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import t as student

from benchmark.identification.model_error import COUNT, PLAIN, functions
from benchmark.identification.parameters.free_parameters import Parameter
from benchmark.identification.parameters.layer_fit import LayerFit
from benchmark.identification.parameters.layer_model import GAIN, MM, LayerModel
from benchmark.identification.parameters.mixed_effects import courses_left
from benchmark.identification.parameters.presses.press_surrogate import GRID
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import TrialsFit, scaled_inverse

KNOWN = math.log(2.0)
"""A parameter is determined where its interval ends within a factor of two, either way. Wider is said to be unknown."""
LARGEST_ERROR = KNOWN / 1.96
"""Standard error of a logarithm, by the trials alone, up to which a parameter can be determined: 35 %."""
LEFT_NOISES = 3.0
"""Times the noise of their records from which on what a law leaves of trials is told of."""
OVER_TIME = "one term of relaxation, or none, may be too few:"
LEFT_ALIKE = 3e-3
"""Share of the force from which on what trials leave alike is told of: a law may be 14 % off with that."""
SHARED_GAIN, SHARED_GAIN_P, LEAST_GAINS = 0.02, 1e-3, 3
"""Mean logarithm of the trials' gains from which on it is more than a law or a mesh is off by, the p below which it is
no chance, and how many trials it takes. First choices."""

SHOWN = 0.2
"""Parts of a direction smaller than this share of the largest are left out of its words."""
LEAST = 1e-12


@dataclass(frozen=True, eq=False)
class Direction:
    """A direction in the free parameters' coordinates.

    Attributes
    ----------
    keys : tuple of str
    parts : (f,) array
        Unit vector.
    deviation : float
        Standard deviation along it that the trials leave, as a share (logarithm); infinite where they say nothing.
    relative_information : float
        Its information over that of the best known direction.
    """

    keys: tuple[str, ...]
    parts: Array
    deviation: float
    relative_information: float

    @property
    def known(self) -> bool:
        """Whether its 95 % interval lies within a factor of two."""
        return 1.96 * self.deviation <= KNOWN

    @property
    def text(self) -> str:
        """The direction in words."""
        order = np.argsort(-np.abs(self.parts))
        largest = self.parts[order[0]]
        shown = [k for k in order if abs(self.parts[k]) >= SHOWN * abs(largest)]
        names = [self.keys[k] for k in shown]
        if len(shown) == 1:
            what = f"{names[0]} by itself"
        else:
            ratios = " : ".join(f"{self.parts[k] / largest:.2g}" for k in shown)
            what = f"{_joined(names)} trade {ratios}"
        if not math.isfinite(self.deviation) or self.deviation > 10.0:
            return f"{what}: the trials say nothing of this"
        said = f"told to {100 * self.deviation:.2g} %" if self.deviation < 1.0 else "told to no better than threefold"
        return f"{what}: {said} (standard error)"

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        deviation = self.deviation if math.isfinite(self.deviation) else None
        return {
            "text": self.text,
            "relative_information": self.relative_information,
            "standard_error": deviation,
            "known": self.known,
            "parts": dict(zip(self.keys, self.parts.tolist(), strict=True)),
        }


def _joined(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"


def information(fit: TrialsFit[LayerModel], numbers: Sequence[int]) -> Array:
    """(f, f) information of the trials on the free parameters, by their numbers, without priors on these."""
    free = np.array(numbers, dtype=int)
    total = fit.blocks.matrix.sum(axis=0) + np.diag(fit.precision)
    total[free, free] -= fit.precision[free]
    rest = np.setdiff1d(np.arange(total.shape[0]), free)
    across = total[np.ix_(rest, free)]
    inner = total[np.ix_(rest, rest)]
    return np.asarray(total[np.ix_(free, free)] - across.T @ np.linalg.solve(inner, across))


def errors_alone(fit: TrialsFit[LayerModel], numbers: Sequence[int]) -> Array:
    """(f,) standard errors of the free coordinates by the trials alone, without priors on what is free."""
    matrix = information(fit, numbers)
    sizes, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    floor = max(float(sizes[-1]), 1e-300) * LEAST
    return np.asarray(np.sqrt((vectors**2 / np.maximum(sizes, floor)).sum(axis=1)))


def directions(found: LayerFit) -> tuple[Direction, ...]:
    """Singular directions of what the trials tell, the least known first."""
    matrix = information(found.fit, found.problem.free)
    keys = tuple(found.problem.parameters[k].key for k in found.problem.free)
    sizes, vectors = np.linalg.eigh(0.5 * (matrix + matrix.T))
    best = max(float(sizes[-1]), LEAST)
    return tuple(
        Direction(
            keys,
            vector * np.sign(vector[np.argmax(np.abs(vector))]),
            1.0 / math.sqrt(size) if size > LEAST * best else math.inf,
            max(float(size), 0.0) / best,
        )
        for size, vector in zip(sizes, vectors.T, strict=True)
    )


def correlation_words(found: LayerFit, least: float = 0.8) -> tuple[str, ...]:
    """Pairs of free parameters whose estimates correlate strongly, in words."""
    free = np.array(found.problem.free, dtype=int)
    covariance = found.fit.covariance[np.ix_(free, free)]
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    unit = covariance / np.outer(spread, spread)
    keys = [found.problem.parameters[k].key for k in free]
    return tuple(
        f"{keys[i]} and {keys[j]} are estimated {'against each other' if unit[i, j] < 0.0 else 'together'} "
        f"(correlation {unit[i, j]:.2f}): a mistake in one is one in the other"
        for i in range(free.size)
        for j in range(i)
        if abs(unit[i, j]) >= least
    )


@dataclass(frozen=True)
class DiscrepancyUse:
    """What a discrepancy over depth took up in a fit.

    Attributes
    ----------
    percent : float
        Its prior standard deviation, % of the force.
    taken : tuple of (float, float, float)
        Of each press: the tool's radius and the depth, mm, at which it took most, and how much, % of the force.
    variance : mapping of key to float
        Share of each free parameter's variance that it makes.
    """

    percent: float
    taken: tuple[tuple[float, float, float], ...]
    variance: Mapping[str, float]

    @property
    def text(self) -> str:
        """In words, with what it is confounded with."""
        places = [f"{size:.2g} % under the {radius:.3g} mm tool at {at:.2g} mm" for radius, at, size in self.taken]
        parts = ", ".join(f"{100 * share:.0f} % of {key}" for key, share in self.variance.items())
        return (
            f"a discrepancy of {self.percent:.2g} % over depth was let into the model and took up to "
            f"{'; '.join(places)}. Of the variance it makes {parts}. It is confounded with every parameter that bends "
            "the force over depth alike: "
            "neither what it took nor what it left is a finding about the specimen"
        )

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        names = ("tool_radius_mm", "depth_mm", "percent")
        taken = [dict(zip(names, one, strict=True)) for one in self.taken]
        return {"percent": self.percent, "taken": taken, "share_of_variance": dict(self.variance), "text": self.text}


def discrepancy_use(found: LayerFit) -> DiscrepancyUse | None:
    """What the discrepancy took up; None where a fit has none."""
    problem = found.problem
    if not problem.discrepancy:
        return None
    count, taken, own_functions = len(problem.parameters), [], functions(GRID)
    for number, press in enumerate(problem.presses):
        own = found.vector[count + number * problem.block :][:COUNT]
        course = own[PLAIN:] @ own_functions[PLAIN:]
        at = int(np.argmax(np.abs(course)))
        taken.append((MM * press.setup[1].radius, MM * press.depth * at / (GRID - 1), 100.0 * float(course[at])))
    total = found.fit.blocks.matrix.sum(axis=0) + np.diag(found.fit.precision)
    places = np.arange(total.shape[0])
    place = (places - count) % problem.block
    kept = np.flatnonzero((places < count) | (place < PLAIN) | (place >= COUNT))
    known = scaled_inverse(total[np.ix_(kept, kept)])
    shares = {problem.parameters[k].key: 1.0 - known[k, k] / found.fit.covariance[k, k] for k in problem.free}
    return DiscrepancyUse(100.0 * problem.discrepancy, tuple(taken), {k: float(v) for k, v in shares.items()})


def unfollowed(found: LayerFit) -> list[str]:
    """A warning for each press whose trials leave alike what is much more than the noise of their records.

    The memory of the noise takes it for chance, and intervals are those of a law that does not hold.
    """
    problem, said = found.problem, []
    for number, course in enumerate(courses_left(found.fit)):
        left, noise = course.left, course.noise
        press, bend = problem.presses[number], problem.errors[number].bend
        force = np.median([np.ptp(one.data.force) for one in problem.trials if one.press == number])
        if left > max(LEFT_ALIKE * force, LEFT_NOISES * max(noise, bend * force)):
            said.append(
                f"the law does not follow the trials under the tool of {MM * press.setup[1].radius:.3g} mm"
                f"{' over time' if course.over_time else ''}: residual "
                f"{left:.2g} N, noise {noise:.2g} N ({100.0 * left / force:.2g} and {100.0 * noise / force:.2g} % of "
                "the force). The values are those of another law, and their intervals, which trust it, may be far too "
                f"narrow; {OVER_TIME if course.over_time else 'try another --law, or'} let the command discover say "
                "what is missing"
            )
    return said


def held_off(found: LayerFit, names: Sequence[str]) -> tuple[tuple[str, ...], str]:
    """Free parameters whose prior or bound keeps them off what the trials ask for, and a warning of it; none, "".

    What trials have in common free values take up. Where a prior or a bound holds these, the gains must, whose scatter
    then hides that the trials contradict it.
    """
    gain, places = shared_gain(found.fit.nuisance[:, GAIN]), zip(names, found.problem.free, strict=True)
    parameters = [(name, found.problem.parameters[k], float(found.vector[k])) for name, k in places]
    held = {name: by for name, one, at in parameters if (by := _held_by(one, at))}
    if gain is None or not held:
        return (), ""
    return tuple(held), (
        f"the forces of all trials are {math.exp(gain):.3g} times the model's, beyond their scatter, and it may not "
        f"follow them: {'; '.join(f'{name} is held by {by}' for name, by in held.items())}"
    )


def _held_by(parameter: Parameter, at: float) -> str:
    """What holds a parameter at a coordinate, its bound or else its prior, with the value; "" where nothing does."""
    if parameter.at_end(at):
        return f"its bound of {parameter.shown(parameter.value(at))} ([fit.bounds])"
    prior = parameter.prior
    return "" if prior is None else f"its prior of {parameter.shown(prior.value)} ([fit.priors])"


def shared_gain(gain: Array) -> float | None:
    """Mean of the trials' gains (R,), logarithms, where it surely is not none; None where that may be chance.

    By Student's t of their scatter about their own mean.
    """
    mean = float(gain.mean())
    if gain.size < LEAST_GAINS or abs(mean) <= SHARED_GAIN:
        return None
    error = max(float(gain.std(ddof=1)) / math.sqrt(gain.size), float(np.finfo(float).tiny))
    return mean if 2.0 * student.sf(abs(mean) / error, gain.size - 1) < SHARED_GAIN_P else None
