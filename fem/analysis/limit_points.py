"""Limit points: whether an equilibrium is stable and near the one before, and over them to the next one.

Under a tool without friction soft tissue slides out over the edge, and where it slips round, equilibrium ends in force
and mostly in depth. What the slip sets free is lost, as it would be to viscosity or in waves. Under a pressure the
surface folds at its edge: beyond its largest force Newton's method finds one of many unstable states, which mesh and
steps choose.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Literal, Self

import numpy as np

from fem.analysis.equilibrium import Equilibrium, NewtonResult, State
from fem.analysis.newton import NewtonSettings, solve_newton
from fem.analysis.prediction import along_tangent
from fem.arrays import FloatArray, IntArray
from fem.assembly.item import EquationItem, ItemForces
from fem.assembly.system import System

MOST_LOST = 0.02
"""Of the tool's work, that all ways over limit points together may lose."""
LEAST_GAIN = 1e-5
"""Of the tool's work, above which energy is taken for gained and not for unbalanced by a tolerance."""
GIVES_WAY = "the tissue gives way"
NONE_NEAR = "no stable equilibrium is near: the tissue folds or gives way"
TOO_FAR = "the next equilibrium lies too far off for a step"
BENT, LEAST_BENT, MORE_BENT = 0.3, 1e-3, 3.0
"""Energy unbalanced on the straight way between two states, over the work, above which one does not follow the other:
times the square of the step over the load, at least the second. Steps of a half to three quarters of the load, to 0.3
of a skin, have 0.2 times that square and less, sheets that stretch, whose force goes with the cube, once: where the way
from rest has so much, as many times that are let through. Jumps, whose step may be as short as one likes, have 0.008
and more."""
LOST = 0.75
"""Of the way from the last state, by which a prediction misses one to which the body has jumped: a jump stays as long
as it is however short the step, the way on does not. Steps that are followed miss by 0.3 and less; where a gel folds at
the edge of a pressure, jumps by 0.8 and more, and what lies behind them is as uncertain as what nothing holds."""
FIRST_DURATION = 1e-4
"""Of a creeping body's first step, in its own time (:func:`slowed`)."""
MOST_CREEP = 100  # steps
MOST_IN_CREEP, FEW = 15, 8  # corrections in a step, and up to which the next one is twice as long
AT_REST = 1e-2  # drag over the force, below which equilibrium without it is near
LEAST_WORK = 1e-6
"""Of the force times the whole displacement, up to which energy is unbalanced by rounding, as in a hold."""


@dataclass(frozen=True)
class Account:
    """Energy in J of a press up to a state.

    Attributes
    ----------
    work
        What the tool did, by the trapezoidal rule from state to state.
    most
        The largest it was.
    lost
        What of it the body did not take, from the first limit point on.
    crept
        How often the body crept over one.
    unstable
        How many of the equilibria on the way are known not to be stable.
    """

    work: float = 0.0
    most: float = 0.0
    lost: float = 0.0
    crept: int = 0
    unstable: int = 0

    def after(self, problem: Equilibrium, start: State, end: State, *, beyond: bool) -> Account:
        """The account after the way from one state to another; what is lost counts where that is beyond limits."""
        done = 0.5 * (start.force + end.force) * (problem.depth(end.y) - problem.depth(start.y))
        lost = done - problem.system.taken(start.y, end.y) if beyond else 0.0
        work = self.work + done
        return replace(self, work=work, most=max(self.most, work), lost=self.lost + lost)

    @property
    def row(self) -> FloatArray:
        """The five as numbers (5,); `Account.of_row` makes them an account again."""
        return np.array([self.work, self.most, self.lost, self.crept, self.unstable])

    @classmethod
    def of_row(cls, row: FloatArray) -> Account:
        """The account of numbers (5,)."""
        work, most, lost, crept, unstable = row.tolist()
        return cls(work, most, lost, int(crept), int(unstable))

    @property
    def share(self) -> float:
        """What is lost of the largest work."""
        return self.lost / self.most if self.most > 0.0 else 0.0

    @property
    def overdrawn(self) -> bool:
        """Whether more is lost than may be, or nobody knows."""
        return not self.lost <= MOST_LOST * self.most


def is_unstable(problem: Equilibrium, state: State, control: Literal["force", "depth"]) -> bool:
    """Whether a body without a memory, held by nothing but its supports, would leave an equilibrium by itself.

    Its tangent then has negative eigenvalues (Z. P. Bazant and L. Cedolin, Stability of Structures, 1991, section 4.4);
    one of them the tool takes away that goes to a given depth, where the force falls with it. False where the linear
    solver does not count them.

    Parameters
    ----------
    problem
        The equations; the solver's factors are those of the last correction.
    state
        In equilibrium.
    control
        What is prescribed.
    """
    if problem.system.items or problem.system.remembers or not problem.solver.negative:
        return False
    evaluation = problem.system.evaluate(state.y, state.pressure)
    if evaluation is None:
        return True
    problem.factorise(evaluation)
    negative = problem.solver.negative or 0
    if negative and control == "depth":
        sinking = problem.depth(problem.solve(problem.unit_load[:, None], 0.0)[:, 0])
        negative -= sinking < 0.0
    return negative > 0


def has_jumped(
    problem: Equilibrium, start: State, end: State, guess: State, control: Literal["force", "depth"], step: float
) -> bool:
    """Whether a state lies elsewhere than on the way on from the last one, in a body without a memory.

    Both a prediction and the tangent at the last state miss it. A prediction by the states before alone may miss the
    way on, too, however short the step: behind a first step of a thin sheet, whose force goes with the cube of its
    depth, the way on is a third of theirs.

    Parameters
    ----------
    problem
        The equations; the solver has other factors afterwards where the prediction misses.
    start, end
        The last equilibrium, and the one that may lie elsewhere.
    guess
        The prediction of the second.
    control, step
        What is prescribed, and how much more of it, in N or m.
    """
    allowed = LOST * np.linalg.norm(end.y - start.y)
    if np.linalg.norm(end.y - guess.y) <= allowed:
        return False
    onwards = along_tangent(problem, start, control, step)
    return onwards is None or bool(np.linalg.norm(end.y - onwards.y) > allowed)


def unbalanced_between(problem: Equilibrium, start: State, end: State) -> float:
    """Energy that is unbalanced on the straight way between two equilibria, over the work.

    On it the internal forces do the work of the tool, but for terms of the third order, where the second lies on the
    way on from the first, and not on another branch. Infinite where the way turns an element inside out.

    Parameters
    ----------
    problem
        The equations, of a body without a memory.
    start, end
        The equilibria.
    """
    system, way = problem.system, end.y - start.y
    work = 0.5 * (start.force + end.force) * float(problem.unit_load @ way)
    middle = system.element_displacement(start.y + 0.5 * way)
    halfway = system.elements.evaluate(middle, system.elements.rest_pressure)
    if halfway is None:
        return np.inf
    taken = float(np.sum(halfway.force * system.scatter.gather(way)))
    rounding = LEAST_WORK * abs(end.force * float(problem.unit_load @ end.y))
    over = max(abs(taken - work) - rounding, 0.0)
    return over / abs(work) if over > 0.0 else 0.0


@dataclass(frozen=True)
class ViscousDrag(EquationItem):
    """A drag against the way from one state, as if it were covered at an even speed; nothing is left of it at rest.

    Attributes
    ----------
    where
        Unknowns (k,) that it holds back.
    weight
        Its force (k,) in N per m of the way.
    start
        Where the unknowns (k,) come from, in m.
    """

    where: IntArray
    weight: FloatArray
    start: FloatArray
    in_small_strain: ClassVar[bool] = False

    @property
    def unknowns(self) -> IntArray:
        """See :class:`EquationItem`."""
        return self.where

    @property
    def entries(self) -> tuple[IntArray, IntArray]:
        """The diagonal."""
        return self.where, self.where

    @property
    def remembers(self) -> bool:
        """It knows one state only."""
        return False

    def respond(self, y: FloatArray) -> ItemForces:
        """Weight times way at unknowns y (n,)."""
        return ItemForces(self.weight * (y[self.where] - self.start), self.weight)

    def accepted(self, y: FloatArray) -> Self:
        """From there on it starts at unknowns y (n,)."""
        return replace(self, start=y[self.where])


def slowed(system: System, duration: float, y: FloatArray) -> tuple[System, ViscousDrag]:
    """The equations with a drag against the way from unknowns y (n,), and the drag.

    The body's viscosity is such that each element's shear modulus and volume, over the whole volume's size squared,
    hold its nodes back in a time of 1; the way is covered in `duration` of that unit.
    """
    elements, scatter = system.elements, system.scatter
    volume = elements.geometry.weight.sum(axis=0)
    share = elements.laws.shear_modulus * volume / (len(scatter.element_unknowns) * duration)
    held = scatter.vector(np.broadcast_to(share, scatter.element_unknowns.shape))
    where = np.flatnonzero(held > 0.0)
    drag = ViscousDrag(where, held[where] / float(volume.sum()) ** (2.0 / 3.0), y[where])
    diagonal: IntArray = scatter.indptr[where].astype(np.int64)
    return replace(system, items=(*system.items, drag), places=(*system.places, diagonal)), drag


def creep(
    problem: Equilibrium,
    start: State,
    control: Literal["force", "depth"],
    target: float,
    force_scale: float,
    settings: NewtonSettings,
    account: Account,
) -> tuple[NewtonResult, Account]:
    """Let a body without a memory creep from one equilibrium to another, against a drag that ends as it comes to rest.

    Viscous stabilisation by implicit Euler steps (P. Wriggers, Nonlinear Finite Element Methods, 2008, section 5.2).
    A step in which the body takes more than the tool gives leads to a state to which nothing creeps, and is made
    smaller.

    Parameters
    ----------
    problem, control, target, force_scale, settings
        See :func:`solve_newton`.
    start
        The equilibrium to begin from, at another load value.
    account
        Of the press up to there; the creep ends where it is overdrawn.

    Returns
    -------
    tuple
        The result, in equilibrium without any drag, and the account there.
    """
    state, duration, before, iterations = start, FIRST_DURATION, 0.0, 0
    account = replace(account, crept=account.crept + 1)
    few = replace(settings, iterations=MOST_IN_CREEP)
    for _ in range(MOST_CREEP):
        system, drag = slowed(problem.system, duration, state.y)
        found = solve_newton(replace(problem, system=system), state, control, target, force_scale, few)
        iterations += found.iterations
        now = account.after(problem, state, found.state, beyond=True) if found.success else account
        if not found.success or not now.lost >= account.lost - LEAST_GAIN * now.most:
            duration *= 0.25
            continue
        if now.overdrawn:
            return NewtonResult(start, iterations, GIVES_WAY), now
        pull = float(np.linalg.norm(drag.respond(found.state.y).force))
        state, account, duration = found.state, now, duration * (2.0 if found.iterations <= FEW else 1.0)
        if pull <= min(AT_REST * abs(state.force), before):
            last = solve_newton(problem, state, control, target, force_scale, settings)
            iterations += last.iterations
            then = account.after(problem, state, last.state, beyond=True) if last.success else account
            if last.success and then.lost >= account.lost - LEAST_GAIN * then.most:
                return replace(last, iterations=iterations), then
        before = pull
    return NewtonResult(start, iterations, "no equilibrium beyond a limit point"), account
