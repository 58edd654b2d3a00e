"""Equilibria one after the other at rising loads, and the inverse of the rising curve through them.

What is in equilibrium (a stack at finite strain, a sheet over a hole), and how one state is found near another, the
body says; here are the steps of the load.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np

from wavemodel.arrays import FloatArray

REFINEMENTS = 50


@dataclass(frozen=True)
class EquilibriumState:
    """One state at rest.

    Attributes
    ----------
    load
        What is prescribed: a force (N), or the depth of a rigid tool (m).
    state
        Unknowns of the body, of any shape.
    """

    load: float
    state: FloatArray


Point = TypeVar("Point", bound=EquilibriumState)


class Loading(Protocol[Point]):
    """A body that is loaded step by step."""

    def next_load(self, path: Sequence[Point], step: float) -> float:
        """Load after the last equilibrium of a path, with a step of the load."""
        ...

    def advance(self, path: Sequence[Point], load: float) -> Point | None:
        """Equilibrium at a load near the last one of a path; None where there is none, or another branch."""
        ...

    def next_step(self, path: Sequence[Point], step: float) -> float:
        """Step of the load after one that ended at the last equilibrium of a path."""
        ...

    def reached(self, path: Sequence[Point]) -> bool:
        """Whether a path goes far enough."""
        ...


def follow(loading: Loading[Point], start: Sequence[Point], step: float, shortest: float) -> list[Point]:
    """Load a body until it says that it is enough, or until steps no shorter than `shortest` find no equilibrium.

    Parameters
    ----------
    loading
        The body.
    start
        Equilibria that are known, at least one.
    step, shortest
        Of the load: the first to be tried, and the shortest that halving may come to.
    """
    path = list(start)
    while not loading.reached(path):
        found = loading.advance(path, loading.next_load(path, step))
        if found is None:
            step *= 0.5
            if step < shortest:
                break
        else:
            path.append(found)
            step = loading.next_step(path, step)
    return path


def straight_on(path: Sequence[EquilibriumState], load: float) -> FloatArray:
    """State at a load on the straight line through the last two equilibria of a path."""
    last = path[-1]
    if len(path) == 1 or path[-2].load == last.load:
        return last.state
    share = (load - last.load) / (last.load - path[-2].load)
    return np.asarray(last.state + share * (last.state - path[-2].state))


@dataclass(frozen=True)
class RisingCurve:
    """A curve with m known points, rising from each to the next.

    Attributes
    ----------
    knots, values
        (m,) of the points, rising.
    value, slope
        The curve (...) at (...), and its derivative.
    """

    knots: FloatArray
    values: FloatArray
    value: Callable[[FloatArray], FloatArray]
    slope: Callable[[FloatArray], FloatArray]

    def inverse(self, wanted: FloatArray, close: float | FloatArray) -> FloatArray:
        """(...) where the curve has values (...), to `close`: Newton's method, kept between the points."""
        low = np.clip(np.searchsorted(self.values, wanted, side="right") - 1, 0, self.knots.size - 2)
        bottom, top = self.knots[low], self.knots[low + 1]
        at = np.asarray(np.interp(wanted, self.values, self.knots))
        for _ in range(REFINEMENTS):
            excess = self.value(at) - wanted
            there = np.abs(excess) <= close
            if np.all(there):
                break
            slope = self.slope(at)
            bottom, top = np.where(excess < 0.0, at, bottom), np.where(excess > 0.0, at, top)
            ahead = at - excess / np.where(slope > 0.0, slope, np.inf)
            there |= (ahead == at) & (slope > 0.0)  # no nearer than round-off; halving would leave it
            moved = np.where((ahead > bottom) & (ahead < top), ahead, 0.5 * (bottom + top))
            at = np.where(there, at, moved)
        return at
