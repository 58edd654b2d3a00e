"""All set-ups of a fit pressed by the model: as deep as it follows, anew where a fit leads, and against the tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmark.errors import SolverError
from benchmark.identification.model_error import COUNT, functions, taken
from benchmark.identification.parameters.fit_problem import FitProblem, relaxing_layers
from benchmark.identification.parameters.layer_model import ForceTable
from benchmark.identification.parameters.presses.press_atlas import PressAtlas
from benchmark.identification.parameters.presses.press_surrogate import PressSurrogate, StopsError, surrogate
from benchmark.response.force_curve import Array

RETRIES = 4
LEAST_REACH, SAFE_REACH = 0.5, 0.95
"""A press that the model follows to half its depth at least is fitted to this share of what it follows."""


def followed(problem: FitProblem, start: Array) -> tuple[FitProblem, tuple[PressSurrogate, ...]]:
    """The presses where a fit begins, as deep as the model follows them, with the trials' rows so deep.

    The model estimates the error of its mesh there, which the problem's presses then have; the usual part of it is
    taken off the force of these presses and of all further ones (Richardson's extrapolation), and what goes with the
    depth as it does.
    """
    surrogates = []
    for number in range(len(problem.presses)):
        for _ in range(RETRIES):
            try:
                surrogates.append(_surrogate(problem, number, start, judge_mesh=True))
                break
            except StopsError as stop:
                if stop.reach < LEAST_REACH * problem.presses[number].depth:
                    raise
                problem = _shallower(problem, number, SAFE_REACH * stop.reach)
        else:
            surrogates.append(_surrogate(problem, number, start))
    pairs = zip(problem.presses, surrogates, strict=True)
    judged = tuple(replace(press, mesh_error=pressed.mesh_error) for press, pressed in pairs)
    return replace(problem, presses=judged), tuple(surrogates)


def _shallower(problem: FitProblem, number: int, depth: float) -> FitProblem:
    """The problem with one press less deep."""
    press = replace(problem.presses[number], depth=depth)
    presses = (*problem.presses[:number], press, *problem.presses[number + 1 :])
    trials = tuple(one.up_to(depth) if one.press == number else one for one in problem.trials)
    return replace(problem, presses=presses, trials=trials)


def press_all(problem: FitProblem, vector: Array) -> tuple[PressSurrogate, ...]:
    """All presses at coordinates (p,), with the model's own error; raises SolverError or InputError."""
    return tuple(_surrogate(problem, number, vector) for number in range(len(problem.presses)))


def _surrogate(problem: FitProblem, number: int, vector: Array, *, judge_mesh: bool = False) -> PressSurrogate:
    press, count = problem.presses[number], len(problem.parameters)
    relaxing, values = relaxing_layers(problem, press), vector[:count]
    found = surrogate(press, problem.parameters, values, problem.law, relaxing, problem.forward, judge_mesh=judge_mesh)
    wrong = found.mesh_error if judge_mesh else press.mesh_error
    found = replace(found, force=found.force * (1.0 - taken(wrong, found.at_edge)))
    own, first = np.zeros((problem.size - count, found.depth.size)), number * problem.block
    own[first : first + COUNT] = functions(found.depth.size)
    at = np.concatenate([found.at, np.zeros(own.shape[0])])
    return replace(_with_rings(problem, found, first), by=np.vstack([found.by, own]), at=at)


def _with_rings(problem: FitProblem, found: PressSurrogate, first: int) -> PressSurrogate:
    """The press with its rings' motion by all coordinates; `first` is that of its own error."""
    if not problem.rings:
        return found
    count, grid = len(problem.parameters), found.depth.size
    rings = found.rings if len(found.rings) else np.zeros((problem.rings, grid))
    by = np.zeros((problem.size, problem.rings, grid))
    by[:count] = 0.0 if found.rings_by is None else found.rings_by
    for ring, moved in enumerate(rings):
        by[count + first + COUNT + ring, ring] = moved
    return replace(found, rings=rings, rings_by=by)


def pressed_anew(problem: FitProblem, vector: Array, before: Array) -> tuple[tuple[PressSurrogate, ...], Array]:
    """All presses at new coordinates, or nearer to the old ones where the model does not follow them."""
    for _ in range(RETRIES):
        try:
            return press_all(problem, vector), vector
        except SolverError:
            vector = 0.5 * (vector + before)
    return press_all(problem, before), before


def disagreement(old: Sequence[ForceTable], new: Sequence[PressSurrogate], vector: Array, count: int) -> float:
    """Largest difference of the force that the old tables foretold and the new one, as a share.

    The model's own error, the coordinates beyond the first `count`, is left out.
    """
    deep = slice(old[0].depth.size // 8, None)
    own = np.where(np.arange(vector.size) < count, vector, 0.0)
    return max(
        float(np.abs(np.log(one.force_at(own)[deep] / two.force[deep])).max())
        for one, two in zip(old, new, strict=True)
    )


def joined(tables: Sequence[ForceTable], pressed: Sequence[PressSurrogate]) -> tuple[ForceTable, ...]:
    """Tables with one more press each."""
    pairs = zip(tables, pressed, strict=True)
    return tuple(one.with_press(new) if isinstance(one, PressAtlas) else new for one, new in pairs)
