"""Normal equations of trials that share a vector: nuisances eliminated, and steps that keep bounds.

A step within bounds is the exact minimum of the quadratic there: what would leave its bounds stops at their edge, the
others make up for it, and what stands at an edge is let go where the slope then leads inside (Nocedal and Wright,
Numerical Optimization, 2nd ed., 16.7).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.response.force_curve import Array

Bounds = tuple[Array, Array]
"""Lower and upper ones, of one shape."""

ROUNDS = 5
"""In which the edges that trials' nuisances stop at are found; each takes a step of the vector that knows the last."""
TURNS = 3
"""Times as many turns as numbers, within which a bounded step ends; where round-off keeps it going it is clipped."""
FLAT = 1e-10
"""Of a slope, below which round-off alone may have made it."""


@dataclass(frozen=True, eq=False)
class Eliminated:
    """What is left of a trial's equations for the vector: matrix (p, p), slope (p,).

    `solved` (q, p + 1) gives the trial's own step: its last column less the others times that of the vector.
    """

    matrix: Array
    slope: Array
    solved: Array


@dataclass(frozen=True, eq=False)
class TrialEquations:
    """Normal equations of one trial: its nuisances' (`inner`, `pull`), the vector's (`outer`, `slope`), and `side`.

    Shapes (q, q), (q,), (p, p), (p,) and (q, p); `inner` and `pull` hold the nuisances' priors.
    """

    inner: Array
    pull: Array
    outer: Array
    slope: Array
    side: Array

    def eliminated(self, moves: Array, held: NDArray[np.bool_]) -> Eliminated:
        """Without its nuisances; those that are `held` (q,) move by `moves` (q,), whatever the vector does."""
        solved = np.zeros((held.size, self.outer.shape[0] + 1))
        free, slope = ~held, self.slope
        right = np.column_stack([self.side, self.pull])
        if held.any():
            solved[held, -1] = moves[held]
            right = right[free]
            right[:, -1] -= self.inner[np.ix_(free, held)] @ moves[held]
            slope = slope - self.side[held].T @ moves[held]
        solved[free] = solve(self.inner[np.ix_(free, free)], right)
        side = self.side[free].T
        return Eliminated(self.outer - side @ solved[free, :-1], slope - side @ solved[free, -1], solved)


def trial_equations(vector: Array, nuisance: Array, residual: Array, own: Array, weight: Array) -> TrialEquations:
    """Of derivatives by the vector (N, p) and the nuisances (N, q), which stand at `own` (q,) with precisions (q,)."""
    return TrialEquations(
        nuisance.T @ nuisance + np.diag(weight),
        nuisance.T @ residual - weight * own,
        vector.T @ vector,
        vector.T @ residual,
        nuisance.T @ vector,
    )


def joint_step(
    trials: Sequence[TrialEquations],
    prior: tuple[Array, Array],
    damping: float,
    edges: Bounds,
    own_edges: Bounds | None,
    held: Sequence[NDArray[np.bool_]],
) -> tuple[Array, Array]:
    """Steps of the vector (p,) and of the trials' nuisances (R, q).

    Parameters
    ----------
    trials
        Their equations.
    prior
        Diagonal (p,) and slope (p,) of the vector's priors.
    damping
        Of the vector's step.
    edges, own_edges
        How far the vector and the nuisances (R, q) may step.
    held
        Nuisances (q,) of each trial that stand at an edge to begin with.
    """
    moves = np.zeros((len(trials), trials[0].pull.size))
    step = np.zeros(prior[1].size)
    for _ in range(ROUNDS):
        parts = [one.eliminated(move, stop) for one, move, stop in zip(trials, moves, held, strict=True)]
        matrix = np.diag(prior[0]).astype(float) + sum(part.matrix for part in parts)
        step = bounded_step(matrix, prior[1] + sum(part.slope for part in parts), edges, damping)
        if own_edges is None:
            return step, np.array([part.solved[:, -1] - part.solved[:, :-1] @ step for part in parts])
        limits = list(zip(*own_edges, strict=True))
        pulls = [one.pull - one.side @ step for one in trials]
        moves = np.array([bounded_step(*each) for each in zip([t.inner for t in trials], pulls, limits, strict=True)])
        stopped = [(move <= low) | (move >= high) for move, (low, high) in zip(moves, limits, strict=True)]
        if all((one == other).all() for one, other in zip(stopped, held, strict=True)):
            break
        held = stopped
    return step, moves


def bounded_step(matrix: Array, slope: Array, edges: Bounds, damping: float = 0.0) -> Array:
    """The damped step (p,) that lowers a quadratic most within edges."""
    low, high = edges
    damped = matrix + np.diag(damping * np.maximum(np.diag(matrix), 1e-12))
    side = np.zeros(slope.size, dtype=int)
    step = np.zeros(slope.size)
    for _ in range(TURNS * slope.size + TURNS):
        free = side == 0
        step = np.where(side < 0, low, np.where(side > 0, high, 0.0))
        step[free] = solve(damped[np.ix_(free, free)], slope[free] - damped[np.ix_(free, ~free)] @ step[~free])
        below, above = free & (step < low), free & (step > high)
        if below.any() or above.any():
            side = side - below + above
            continue
        pull = (slope - damped @ step) * -side
        pull[(pull < FLAT * np.abs(slope)) | (low == high)] = 0.0
        if not pull.any():
            return step
        side[np.argmax(pull / np.sqrt(np.maximum(np.diag(damped), 1e-300)))] = 0
    return np.asarray(np.clip(step, low, high))


def stepped(at: Array, step: Array, bounds: Bounds) -> Array:
    """Values after a step, exactly on the bound where it ends on one."""
    low, high = bounds
    return np.where(step <= low - at, low, np.where(step >= high - at, high, at + step))


def solve(matrix: Array, right: Array) -> Array:
    """The solution; the shortest one where the matrix is singular, so that what the data do not feel stays put."""
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right)[0])
