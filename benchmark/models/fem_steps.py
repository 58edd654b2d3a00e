"""The steps of a long FEM run kept on disk, so that the same run goes on from there after it was killed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import fem
from benchmark.models.model_result import Keeping
from fem.analysis.checkpoint import Checkpoint, Progress
from fem.analysis.prepared import Model

STEPS, STEPS_AT_EDGE, MESH = "fem_steps.kept", "fem_steps_edge_{:g}.kept", "fem_mesh.kept"
LEAST_PAUSE = 2.0
"""Wall s between two writings, and before the first: a run that is shorter keeps nothing."""
SHARE = 0.02
"""Of the time, the most that writing takes."""


def kept_steps(keeping: Keeping, model: Model, load: fem.Load, edge: float) -> KeptSteps:
    """The steps of a load history, in a file of its own for each size of the elements at the tool's edge."""
    path = keeping.folder / (STEPS if edge == 1.0 else STEPS_AT_EDGE.format(edge))
    return KeptSteps(model.checkpoint(load, path), len(load.time), keeping.say)


def kept_mesh(keeping: Keeping) -> Path:
    """The file of a mesh that is made once; its folder is made."""
    keeping.folder.mkdir(parents=True, exist_ok=True)
    return keeping.folder / MESH


class KeptSteps:
    """Keeps a run's steps now and then, and never stops it: what cannot be read or written is said and left.

    Parameters
    ----------
    checkpoint : Checkpoint
        The file.
    total : int
        Steps of the load history.
    say : callable
        Told in a sentence what was found, and what went wrong.
    """

    def __init__(self, checkpoint: Checkpoint, total: int, say: Callable[[str], None]):
        self._checkpoint, self._total, self._say = checkpoint, total, say
        self._due = time.monotonic() + LEAST_PAUSE

    def read(self) -> Progress | None:
        """The steps of an earlier run; None where there are none to go on from."""
        try:
            found = self._checkpoint.read()
        except fem.CheckpointError as error:
            self._say(f"the FEM starts afresh: {error.problem}")
            self._checkpoint.path.unlink(missing_ok=True)
            return None
        if found is not None:
            self._say(f"the FEM goes on after step {len(found.steps)} of {self._total}, kept by an unfinished run")
        return found

    def write(self, progress: Progress) -> None:
        """Keep the steps if it is time to."""
        started = time.monotonic()
        if started < self._due:
            return
        try:
            self._checkpoint.path.parent.mkdir(parents=True, exist_ok=True)
            self._checkpoint.write(progress)
        except (OSError, fem.CheckpointError) as error:
            self._say(f"the FEM's steps are not kept: {error}")
            self._due = math.inf
            return
        now = time.monotonic()
        self._due = now + max(LEAST_PAUSE, (now - started) / SHARE)


WIDER = (2.0, 4.0, 8.0)
"""How much larger the elements at the edge are in each further try."""
MOST_APART = 3.5
"""Difference from the usual mesh in %, where both are known, beyond which a try is not believed."""

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
        apart = _apart(usual, other)
        if _reach(other) > _reach(found) and (apart is None or abs(apart.percent) <= MOST_APART):
            best, found = wider, replace(other, warnings=(*other.warnings, _remark(edge, usual, apart)))
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


@dataclass(frozen=True)
class _Apart:
    """How far another mesh is from the usual one in the deepest step that both know, in per cent, at a depth in m."""

    quantity: str
    percent: float
    depth: float


def _apart(usual: fem.Solution, other: fem.Solution) -> _Apart | None:
    """The difference in what the load leaves free; None where no step is known from both."""
    both = min(len(usual.time), len(other.time))
    if both == 0 or usual.failure is None:
        return None
    step = int(np.abs(usual.depth[:both]).argmax())
    quantity = "depth" if usual.failure.control == "force" else "force"
    percent = 100.0 * (getattr(other, quantity)[step] / getattr(usual, quantity)[step] - 1.0)
    return _Apart(quantity, float(percent), float(usual.depth[step]))


def _remark(edge: float, usual: fem.Solution, apart: _Apart | None) -> str:
    """What was done, and what it costs in accuracy as far as both meshes show."""
    stop = usual.failure
    where = "" if stop is None else f" beyond {stop.reached:.4g} {'N' if stop.control == 'force' else 'm'}"
    text = (
        f"the usual mesh could not follow the press{where}: the whole press was computed again with elements {edge:g} "
        "times larger at the tool's edge"
    )
    if apart is None:
        return text
    place = f"at {1e3 * apart.depth:.4g} mm, where both are known"
    return f"{text}, whose {apart.quantity} is {apart.percent:+.2f} % apart {place}"
