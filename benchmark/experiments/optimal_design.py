"""What to measure next: experiments weighed by what they would tell of free parameters, per minute at the bench.

D-optimal is the largest fall of the log determinant of the free parameters' covariance, A-optimal the largest fall of
its trace, both over the minutes that an experiment takes (Atkinson, Donev and Tobias, Optimum Experimental Designs,
2007, chapter 10). Coordinates are logarithms, so that the trace is in shares. Linear round the fit: what is determined
there may not be so elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any, TypeAlias

import numpy as np

from benchmark.errors import InputError, SolverError
from benchmark.experiments.menu import Experiment, Usual, menu, minutes, motion, protocol_toml, same_again
from benchmark.files import Tool
from benchmark.identification.model_error import COUNT
from benchmark.identification.parameters.fit_problem import FitProblem
from benchmark.identification.parameters.identifiability import LARGEST_ERROR
from benchmark.identification.parameters.identified import Identified
from benchmark.identification.parameters.layer_fit import LOOKED_UP
from benchmark.identification.parameters.layer_model import MM, Fading, FitTrial, LayerModel
from benchmark.identification.parameters.pressed_set_ups import press_all
from benchmark.identification.parameters.presses.press_surrogate import Press, PressSurrogate, StopsError
from benchmark.identification.trial_data import TrialData
from benchmark.identification.trial_features import ContactRange
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import Blocks, least_squares
from benchmark.response.noise import whitener

TRIALS = 5
"""Trials of a proposed experiment."""
ROWS = 250
OTHER_RADII = (0.4, 2.5)
"""Other tools, over the smallest and over the largest radius that was pressed with."""
SMALLEST_RADIUS = 0.5e-3
OTHER_TOOL_MINUTES = 5.0
SHALLOWER = 0.7
"""A press that the model does not follow is tried so much shallower, twice."""


@dataclass(frozen=True, eq=False)
class Proposal:
    """An experiment with what it would tell.

    Attributes
    ----------
    experiment : Experiment
    tool : Tool
    minutes : float
        Of `TRIALS` trials at the bench.
    errors : (f,) array
        Standard errors of the free coordinates after it, without priors on them.
    determinant, trace : float
        By how much the log determinant and the trace of the covariance fall.
    """

    experiment: Experiment
    tool: Tool
    minutes: float
    errors: Array
    determinant: float
    trace: float

    @property
    def determines(self) -> int:
        """How many free parameters would then be determined."""
        return int((self.errors <= LARGEST_ERROR).sum())

    def to_dict(self, names: Sequence[str]) -> dict[str, Any]:
        """Entry of `fit.json`."""
        return {
            "name": self.experiment.name,
            "words": self.experiment.words,
            "tool_radius_mm": MM * self.tool.radius,
            "minutes": self.minutes,
            "standard_errors": dict(zip(names, self.errors.tolist(), strict=True)),
            "log_determinant_falls_by": self.determinant,
            "trace_falls_by": self.trace,
        }

    def toml(self) -> str:
        """The protocol file."""
        return protocol_toml(self.experiment)


@dataclass(frozen=True)
class OptimalDesign:
    """Experiments weighed, the D-optimal and the A-optimal one per minute among them, and errors as they are now."""

    proposals: tuple[Proposal, ...]
    best_d: Proposal
    best_a: Proposal
    errors_now: Array


def designed(answer: Identified) -> OptimalDesign | None:
    """Weigh the menu for the first specimen; None where no experiment can be worked out."""
    found = answer.found
    presses = [one for one in found.problem.presses if one.specimen == 0]
    now = _covariance(found.fit.blocks.matrix.sum(axis=0) + np.diag(_told(answer)), found.problem)
    proposals = []
    for press, tool, prefix in _tools(presses):
        under = replace(press, setup=(press.setup[0], tool, press.setup[2]))
        pressed = cache(partial(_pressed, answer, under))
        for experiment in _entries(answer, press, tool, prefix):
            made = _weighed(answer, under, pressed, experiment, now)
            if made is not None:
                proposals.append(made)
    if not proposals:
        return None
    able = _able(proposals, {one.setup[1].radius for one in presses})
    best_d = max(able, key=lambda one: one.determinant / one.minutes)
    best_a = max(able, key=lambda one: one.trace / one.minutes)
    return OptimalDesign(tuple(proposals), best_d, best_a, np.sqrt(np.diag(now)))


def _able(proposals: Sequence[Proposal], radii: Collection[float]) -> list[Proposal]:
    """Proposals that determine the most; where one tool has pressed, of these those with another tool, if there are.

    Under one tool layers are told apart by the bend of force over depth alone, in which finite-element codes differ by
    0.2 to 0.4 %: a deeper press then narrows intervals more than it should.
    """
    most = max(one.determines for one in proposals)
    able = [one for one in proposals if one.determines == most]
    if len(radii) > 1:
        return able
    return [one for one in able if one.tool.radius not in radii] or able


def _tools(presses: Sequence[Press]) -> Iterator[tuple[Press, Tool, str]]:
    """Tools that were pressed with, and others, each with the press it is like and words for it."""
    for press in presses:
        yield press, press.setup[1], ""
    small, large = (pick(presses, key=lambda one: one.setup[1].radius) for pick in (min, max))
    for press, factor in zip((small, large), OTHER_RADII, strict=True):
        told = press.setup[1]
        radius = float(f"{factor * told.radius:.2g}")
        hole = press.setup[2].hole_radius
        if radius >= SMALLEST_RADIUS and (hole is None or press.setup[2].kind != "hole" or radius < 0.6 * hole):
            edge = None if told.edge_radius is None else told.edge_radius * radius / told.radius
            yield press, told.model_copy(update={"radius": radius, "edge_radius": edge}), f"{MM * radius:.2g} mm tool, "


def _entries(answer: Identified, press: Press, tool: Tool, prefix: str) -> Iterator[Experiment]:
    """The menu under one tool; another tool is something that a person must put in first.

    A smaller tool than any before presses no deeper: the same depth is more of its radii already, and beyond two of
    them the finite elements at its edge waver by more than a fit settles to.
    """
    usual = _usual(answer, press)
    for one in (same_again(usual), *menu(usual, deeper=tool.radius >= press.setup[1].radius)):
        if prefix:
            words = f"Put in a tool of {MM * tool.radius:.2g} mm radius. {one.words}"
            setup = {"tool_radius": f"{MM * tool.radius:.2g} mm"}
            one = replace(one, name=prefix + one.name, words=words, setup=setup, setup_minutes=OTHER_TOOL_MINUTES)
        yield one


def _usual(answer: Identified, press: Press) -> Usual:
    """What the trials of a press did."""
    trials = [one.data for one in answer.found.problem.trials if answer.found.problem.presses[one.press] is press]
    deep, speeds, holds = [], [], []
    for one in trials:
        depth = one.depth
        pace = np.abs(np.gradient(depth, one.time))
        moving = pace > 0.2 * pace.max()
        still = (depth > 0.9 * depth.max()) & ~moving
        deep.append(depth.max())
        speeds.append(np.median(pace[moving]))
        holds.append(np.gradient(one.time)[still].sum())
    tissue, _, support = press.setup
    endless = support.kind == "hole" or math.isinf(tissue.thickness)
    thickness = math.inf if endless else tissue.thickness
    return Usual(float(np.median(deep)), max(float(np.median(speeds)), 1e-5), float(np.median(holds)), thickness)


Pressed: TypeAlias = Callable[[float], tuple[FitProblem, PressSurrogate]]
"""A press to a depth, m, once for all motions that go so deep."""


def _weighed(answer: Identified, press: Press, pressed: Pressed, experiment: Experiment, now: Array) -> Proposal | None:
    """What an experiment would tell; None where the model does not follow it."""
    time, depth = motion(experiment, ROWS)
    try:
        block = _information(answer, press, pressed, time, depth)
    except (SolverError, InputError):
        return None
    found, size = answer.found, answer.found.vector.size
    total = np.zeros((block.shape[0], block.shape[0]))
    total[:size, :size] = found.fit.blocks.matrix.sum(axis=0) + np.diag(_told(answer))
    total[size:, size:] = np.diag(found.problem.errors[_like(found.problem, press)].deviations ** -2.0)
    then = _covariance(total + TRIALS * block, found.problem)
    determinant = float(np.linalg.slogdet(now)[1] - np.linalg.slogdet(then)[1])
    trace = float(np.trace(np.minimum(now, _MOST)) - np.trace(np.minimum(then, _MOST)))
    return Proposal(experiment, press.setup[1], minutes(experiment, TRIALS), np.sqrt(np.diag(then)), determinant, trace)


_MOST = 4.0
"""A variance counts as no more: what is not known at all is not known a thousandfold less."""


def _told(answer: Identified) -> Array:
    """(p,) precisions of what was told and of the model's own error; what is free has a bare minimum."""
    precision = answer.found.fit.precision.copy()
    for k in answer.found.problem.free:
        precision[k] = 1.0 / _MOST
    return precision


def _covariance(matrix: Array, problem: FitProblem) -> Array:
    """(f, f) of the free coordinates."""
    free = np.array(problem.free, dtype=int)
    return np.asarray(np.linalg.pinv(matrix, hermitian=True)[np.ix_(free, free)])


def _information(answer: Identified, press: Press, pressed: Pressed, time: Array, depth: Array) -> Array:
    """(p + m, p + m) what one trial of a motion tells of the fit's coordinates and of the new press's own error."""
    found = answer.found
    problem, surrogate = pressed(round(float(depth.max()), 6))
    trial = _trial(answer, time, np.minimum(depth, problem.presses[0].depth))
    fading = tuple(_moved(one) for one in _first_fading(found.model, found.problem, press))
    count = len(found.problem.parameters)
    size = found.vector.size + COUNT
    by = np.zeros((size, surrogate.depth.size))
    own = next((k for k, one in enumerate(found.problem.presses) if _alike(one, press)), None)
    place = size - COUNT if own is None else count + found.problem.block * own
    by[:count], by[place : place + COUNT] = surrogate.by[:count], surrogate.by[count:]
    vector = np.append(found.vector, np.zeros(COUNT))
    table = replace(surrogate, by=by, at=vector)
    noise = np.array([float(np.median(found.model.noise))])
    white = (whitener(trial.count, found.memory),)
    free = (np.full(size, -np.inf), np.full(size, np.inf))
    none = np.zeros(size)
    model = LayerModel((table,), (trial,), fading, free, none, none, found.model.gain_deviation, white, noise)
    blocks: Blocks = least_squares(model, vector, np.zeros((1, 3)), search=LOOKED_UP).blocks
    return np.asarray(blocks.matrix[0])


def _alike(one: Press, other: Press) -> bool:
    """Whether two presses share the model's own error: specimen, tool and support."""
    return one.specimen == other.specimen and one.setup[1:] == other.setup[1:]


def _pressed(answer: Identified, press: Press, depth: float) -> tuple[FitProblem, PressSurrogate]:
    """The press to a depth, or less deep where the model does not follow it; raises SolverError."""
    found = answer.found
    count = len(found.problem.parameters)
    vector = np.concatenate([found.vector[:count], np.zeros(COUNT)])
    for _ in range(3):
        problem = replace(found.problem, presses=(replace(press, depth=1.02 * depth, rings=None),))
        try:
            return problem, press_all(problem, vector)[0]
        except StopsError:
            depth *= SHALLOWER
    raise SolverError(f"the model does not follow a press to {MM * depth:.3g} mm")


def _trial(answer: Identified, time: Array, depth: Array) -> FitTrial:
    """A trial of a motion without forces, whose rows hold as many samples as the session's would."""
    first = answer.found.problem.trials[0]
    raw = float(np.median(np.diff(first.data.time)) / np.median(first.count))
    count = np.full(time.size, max((time[1] - time[0]) / raw, 1.0))
    data = TrialData("proposed", "proposed", time, depth, np.zeros_like(depth), first.data.curve)
    return FitTrial(data, count, 0, ContactRange(-1e-3, 1e-3, float(depth.min()), -1.0, 1.0))


def _first_fading(model: LayerModel, problem: FitProblem, press: Press) -> list[Fading]:
    """What fades in the presses of the same specimen."""
    like = _like(problem, press)
    return [one for one in model.fading if one.press == like]


def _like(problem: FitProblem, press: Press) -> int:
    """The number of the first press of the same specimen."""
    return next(k for k, one in enumerate(problem.presses) if one.specimen == press.specimen)


def _moved(one: Fading) -> Fading:
    return replace(one, press=0)
