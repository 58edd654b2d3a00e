"""The discretisation error of a mesh, estimated from solutions with half as many elements in each direction.

With errors that go with the power p of the element size (L. F. Richardson, Philosophical Transactions of the Royal
Society A 210 (1911) 307) the finer of two solutions is off by their difference over 2^p - 1. Where a face is held up to
an edge, the energy's error goes with the element size at the edge: its order is twice the exponent of the displacement
there, which is 1/2 in small strain. In deep presses, where the material turns round the edge, it is lower. There
further solutions with larger elements at the edge alone tell it, and the share of the edge.

In a fan whose elements hold the square root of the distance, the order is that of smooth solutions. What they do not
hold is the region of large strain round the edge, where displacements are something else. Like the region of
small-scale yielding round a crack (J. R. Rice, Journal of Applied Mechanics 35 (1968) 379) it is ruled by the field
round it: where that is |u|^2 = l r at a distance r, it is some l wide, and its energy is some mu l^2 along each length
of the edge. Elements larger than l do not see it, so that no coarser mesh tells it, either. Where l is larger than the
elements, what is left is what straight ones leave: some mu l h with nodes at h from the edge.

A block has no fan: its elements at a stuck edge and at the rim of a hole are straight. With half as many elsewhere and
these as they are, and with half as many everywhere, two solutions tell their share, which is nearly all over a hole.
Its order is that of small strain: from a coarse mesh to one twice as fine it was 1.0 to 1.25 in five cases of six (1.8
where the error was least), from half as many elements to the mesh itself mostly 1.1 to 1.5.

How a state is found on a coarser mesh is in :mod:`fem.setup.coarser_state`.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fem.errors import FemError
from fem.load import Load
from fem.problem.parts import LARGEST_EDGE
from fem.problem.problem import Problem
from fem.results.solution import Solution
from fem.setup.coarser_state import MeshState, followed, found_near, has_state_nearby, kept_steps, remembers, shortened
from fem.setup.layout import holds_edge, tool_fan
from fem.setup.prepare import prepare

if TYPE_CHECKING:
    from fem.analysis.prepared import Model
    from fem.arrays import FloatArray

SINGULAR_ORDER = 1.0
LEAST_ORDER = 0.6  # seen in deep presses of two sheets, with up to five rings of elements at the edge
SMOOTH_ORDER = 2.0  # where no edge is stuck; a low one, with which the estimate is rather too large
WITHOUT_FAN = 1.75
"""Of a stuck edge whose elements are small and no fan: below all that were seen, so that the estimate is too large.

A third mesh showed orders of 2.1 to 4.9 under twelve stuck tools on thin first layers, closed forms of flat punches in
small strain (I. N. Sneddon, International Journal of Engineering Science 3 (1965) 47) orders of 3.2.
"""
AT_EDGE = 0.5
"""Derivative of the energy that the elements of a fan do not find by the logarithm of the depth, in shear moduli times
l min(l, h) times the length of the edge; from one sheet, presses of 0.9 to 1.8 mm with a tool of 5 mm."""
EDGES = (1.0, 2.0, 4.0)


@dataclass(frozen=True)
class MeshError:
    """What a second solution tells about the largest load of a run, or about half of it.

    Attributes
    ----------
    quantity
        "depth" or "force": what the load leaves free.
    load
        The load value (N or m) at which it is told: the largest, or half of it where larger elements have no state
        near the run's.
    value
        The quantity (m or N) in the run.
    halved
        The same with half as many elements in each direction.
    error
        Estimated value less limit of refinement (m or N).
    order
        Order of convergence that is assumed, at a stuck edge of straight elements that which was observed.
    unknowns
        Of the solution with half as many elements in each direction.
    seconds
        CPU time in s that the further solutions took.
    """

    quantity: str
    load: float
    value: float
    halved: float
    error: float
    order: float
    unknowns: int
    seconds: float

    @property
    def percent(self) -> float:
        """The estimated error in % of the value."""
        return 100.0 * self.error / self.value

    @property
    def extrapolated(self) -> float:
        """Estimated limit of refinement (m or N)."""
        return self.value - self.error


def estimate_mesh_error(model: Model, load: Load, solution: Solution, *, first_order: bool = False) -> MeshError | None:
    """Estimate the discretisation error of a run at its largest load, or at half of it.

    Parameters
    ----------
    model
        The model that ran.
    load
        The load history that it followed.
    solution
        What it found; of a run that stopped early what it reached.
    first_order
        Take the order of small strain at a stuck edge of straight elements instead of the observed one, and where there
        is no fan that of smooth solutions. Otherwise the order is rather too low, and the error too large by up to
        four: for a bound, not to correct by.

    Returns
    -------
    MeshError or None
        None without a loaded step, on a body from a surface, which has no like mesh with larger elements, where these
        cannot follow the press to half of its load either, and where on a block that is stuck or over a hole they are
        the softer ones: then other errors outweigh that of the edge, and the difference does not tell them.
    """
    reached = load.value[: len(solution.time)]
    if model.problem.geometry == "surface" or not np.abs(reached).any():
        return None
    began = clock.process_time()
    quantity = "depth" if load.control == "force" else "force"
    held, singular = holds_edge(model.problem), _is_singular_block(model.problem)
    edges = _edges(model.problem, held=held, first_order=first_order)
    for step, follow in _judged_steps(model, reached):
        kept = kept_steps(model.problem, step)
        along = [MeshState.of(solution, n) for n in kept]
        further = list(_coarser(model, shortened(model.problem, load, kept), along, edges, follow=follow))
        if len(further) >= (2 if singular else 1):
            break
    else:
        return None
    value = along[-1].value(load.control)
    error, order = _told(model.problem, value, [found for found, _ in further], held=held, first_order=first_order)
    if held:
        error += float(error_at_edge(model, solution)[step]) * (value if quantity == "force" else -value)
    halved, unknowns = further[-1 if singular else 0]
    found = MeshError(
        quantity, float(reached[step]), value, halved, error, order, unknowns, clock.process_time() - began
    )
    return None if singular and _is_hidden(model.problem, found) else found


def error_at_edge(model: Model, solution: Solution) -> FloatArray:
    """What elements that hold the edge of a stuck tool leave of the force at each step, without a further solution.

    The length l goes with the square of the depth: |u|^2 = l r is taken at the free node next to the edge.

    Parameters
    ----------
    model
        The model that ran.
    solution
        What it found.

    Returns
    -------
    ndarray
        Shares (n,) of the force; 0 without such elements and at rest.
    """
    work = np.abs(solution.depth * solution.force)
    out: FloatArray = np.zeros(len(work))
    if not holds_edge(model.problem):
        return out
    edge, nodes = np.array([model.problem.tool.radius, 0.0]), solution.mesh.nodes
    away = np.linalg.norm(nodes - edge, axis=1)
    at, free = int(away.argmin()), np.flatnonzero(model.mesh.top & (nodes[:, 0] > edge[0]))
    near = int(free[away[free].argmin()])
    moved = solution.displacement[:, near] - solution.displacement[:, at]
    length = (moved**2).sum(axis=1) / away[near]
    energy = AT_EDGE * model.problem.layers[0].material.shear_modulus * length * np.minimum(length, away[near])
    np.divide(2.0 * math.pi * edge[0] * energy, work, out=out, where=work > 0.0)
    return out


def _judged_steps(model: Model, reached: FloatArray) -> list[tuple[int, bool]]:
    """Steps at which to try, and whether the way there from rest may be followed: at last, since it costs most.

    That of the largest load, and without a memory that nearest to half of it.
    """
    peak = int(np.abs(reached).argmax())
    half = int(np.abs(reached[: peak + 1] - 0.5 * reached[peak]).argmin())
    steps = [peak] if remembers(model.problem) or half == peak else [peak, half]
    return [(step, follow) for follow in ((False, True) if has_state_nearby(model) else (True,)) for step in steps]


def _coarser(
    own: Model, load: Load, along: Sequence[MeshState], factors: Sequence[float], *, follow: bool
) -> Iterator[tuple[float, int]]:
    """What half as many elements give, and unknowns; at an edge also with elements larger there by the factors.

    The first is sought near the last state of those `along` the load history of the model's own mesh or, with `follow`,
    followed from rest; the others are if need be.
    """
    problem, before = own.problem, own
    discretisation = problem.discretisation
    edges = [edge for edge in (discretisation.edge * factor for factor in factors) if edge <= LARGEST_EDGE]
    for edge in edges:
        try:
            model = prepare(replace(problem, discretisation=replace(discretisation, halved=True, edge=edge)))
        except FemError:
            return
        if before is not own and model.unknowns == before.unknowns:
            return  # there is no fan
        first = before is own
        found = None if first and follow else found_near(model, load, along, before)
        if found is None and (follow or not first):
            end = followed(model, load, along)
            found = None if end is None else [end]
        if found is None:
            return
        yield found[-1].value(load.control), model.unknowns
        along, before = found, model


def _told(
    problem: Problem, value: float, coarser: list[float], *, held: bool, first_order: bool
) -> tuple[float, float]:
    """Estimated error of a value and the order, from what the coarser meshes of a problem give."""
    if _is_singular_block(problem):
        return _beside_edge(value, coarser), SINGULAR_ORDER
    stuck, fan = problem.is_stuck and not held, tool_fan(problem) is not None
    smooth = SMOOTH_ORDER if first_order or not stuck or fan else WITHOUT_FAN
    return _judged(value, coarser, smooth, stuck=stuck and fan)


def _judged(value: float, coarser: list[float], smooth: float, *, stuck: bool) -> tuple[float, float]:
    """Estimated error of a value and the order, from what the coarser meshes give; `smooth` is that off the edge.

    The elements at the edge, e of whose error is left, change the value by (2^p - 1) e when they alone are doubled.
    """
    halved, difference = coarser[0], coarser[0] - value
    if not stuck or len(coarser) == 1:
        order = SINGULAR_ORDER if stuck else smooth
        return difference / (2.0**order - 1.0), order
    first, order = coarser[1] - halved, SINGULAR_ORDER
    if len(coarser) == 3 and first * (coarser[2] - coarser[1]) > 0.0:
        order = float(np.clip(np.log2((coarser[2] - coarser[1]) / first), LEAST_ORDER, SINGULAR_ORDER))
    at_edge = first / 2.0**order
    return at_edge / (2.0**order - 1.0) + (difference - at_edge) / (2.0**smooth - 1.0), order


def _beside_edge(value: float, coarser: list[float]) -> float:
    """Estimated error of a value on a block from half as many elements but at an edge or a rim, and everywhere."""
    beside, halved = coarser
    at_edge, elsewhere = 2.0**SINGULAR_ORDER - 1.0, 2.0**SMOOTH_ORDER - 1.0
    return float((halved - beside) / at_edge + (beside - value) / elsewhere)


def _is_singular_block(problem: Problem) -> bool:
    """Whether a block has a stuck edge or a rim, with straight elements there."""
    return problem.geometry == "block" and (problem.is_stuck or problem.support.kind == "hole")


def _is_hidden(problem: Problem, found: MeshError) -> bool:
    """Whether a block comes out softer with larger elements, which those at an edge or a rim alone do not make it.

    A tool that touches, or lies aslant on the tissue, makes errors of either sign.
    """
    upright = not problem.touches and problem.tool.tilt == 0.0
    return upright and (found.percent < 0.0) == (found.quantity == "force")


def _edges(problem: Problem, *, held: bool, first_order: bool) -> tuple[float, ...]:
    """Factors on the size at an edge, of the further solutions."""
    if problem.geometry == "block":
        return EDGES[: 2 if _is_singular_block(problem) else 1]
    return EDGES[: 1 if held or not problem.is_stuck else 2 if first_order else 3]
