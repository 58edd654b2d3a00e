"""A press that folds the elements at a bonded tool's edge, tried again with larger ones there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import fem
from fem.model import Model

WIDER = (2.0, 4.0, 8.0)
"""How much larger the elements at the edge are in each further try."""

Run = Callable[[Model, float], fem.Solution]
"""Follows the load history on a model with elements so much larger at the edge."""


def follow_deeper(model: Model, run: Run) -> tuple[Model, fem.Solution]:
    """Follow a load history, and where the mesh cannot follow it once more with larger elements at the tool's edge.

    Parameters
    ----------
    model
        With the usual mesh.
    run
        How to follow the history.

    Returns
    -------
    tuple
        The model that came furthest, and its solution, which says how much its depth differs from the usual mesh's.
    """
    tried = best = model
    usual = found = run(model, 1.0)
    for edge in WIDER if _may_fold(model.problem) else ():
        if found.failure is None or found.failure.target <= found.failure.reached:
            break
        wider = _with_edge(model.problem, edge)
        if wider.unknowns == tried.unknowns:
            break  # there is no room for larger ones
        tried, other = wider, run(wider, edge)
        if _reach(other) > _reach(found):
            best, found = wider, replace(other, warnings=(*other.warnings, _remark(edge, usual, other)))
    return best, found


def _may_fold(problem: fem.Problem) -> bool:
    """Whether the mesh has elements of a chosen size round an edge that the surface sticks to."""
    stuck = problem.tool.contact == "rigid_bonded"
    return stuck and problem.kinematics == "finite" and problem.geometry == "axisymmetric"


def _with_edge(problem: fem.Problem, edge: float) -> Model:
    return fem.prepare(replace(problem, discretisation=replace(problem.discretisation, edge=edge)))


def _reach(solution: fem.Solution) -> tuple[float, float]:
    """How far a run came: steps, then the load on the way to the next."""
    stop = solution.failure
    return (len(solution.time), np.inf if stop is None else abs(stop.reached))


def _remark(edge: float, usual: fem.Solution, wider: fem.Solution) -> str:
    """What was done, and what it costs in accuracy as far as both runs show."""
    stop = usual.failure
    where = "" if stop is None else f" beyond {stop.reached:.4g} {'N' if stop.control == 'force' else 'm'}"
    text = (
        f"the usual mesh could not follow the press{where}: the whole press was computed again with elements {edge:g} "
        "times larger at the tool's edge"
    )
    both = min(len(usual.time), len(wider.time))
    if both == 0:
        return text
    step = int(np.abs(usual.depth[:both]).argmax())
    quantity, ours, other = ("depth", wider.depth, usual.depth)
    if stop is not None and stop.control == "depth":
        quantity, ours, other = ("force", wider.force, usual.force)
    apart = 100.0 * (ours[step] / other[step] - 1.0)
    return f"{text}, whose {quantity} is {apart:+.2f} % apart at {1e3 * usual.depth[step]:.4g} mm, where both are known"
