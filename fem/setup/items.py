"""From a problem to its interfaces that slip.

The nodes slide on the curve of the side that bends less: a curve follows the nodes of the other side only where they
stand, and a soft or thin side would fold between them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.scatter import Numbering, Scatter, widened
from fem.interactions.clamp import Sliding
from fem.interactions.interface import Curve, Slipping
from fem.mesh.quads import Mesh, ring_areas
from fem.problem.problem import Problem
from fem.setup.supports import on_the_plate

HOLD, GIVE = 1e2, 1e-5  # k in shear moduli over the thickness of the layer that gives more; what it gives
HALF_WAVE = 1.0 / 6.0  # length in tool radii over which a thin side is bent
OWN_UNKNOWNS = 3  # of a node, besides its displacements


def slipping_interfaces(problem: Problem, mesh: Mesh, numbering: Numbering) -> tuple[Slipping, ...]:
    """The interfaces that slip in finite strain; their unknowns follow those of the numbering."""
    found: list[Slipping] = []
    count = numbering.count
    for layer, limit in enumerate(problem.shear_limits):
        if limit is None:
            continue
        curve, nodes = _sides(problem, mesh, layer)
        nodes = nodes[1:-1]
        own = count + np.arange(OWN_UNKNOWNS * len(nodes)).reshape(OWN_UNKNOWNS, -1)
        count += own.size
        area = ring_areas(mesh.nodes[curve, 0])[1:-1]
        hold = HOLD * min(part.material.shear_modulus / part.thickness for part in problem.layers[layer : layer + 2])
        found.append(
            Slipping(
                Curve(mesh.nodes[curve, 0]),
                mesh.nodes[nodes, 0],
                np.concatenate((numbering.unknown[:, nodes], own)),
                numbering.unknown[:, curve],
                hold * area,
                GIVE,
                limit * area,
                np.zeros(len(nodes)),
            )
        )
    return tuple(found)


def with_interfaces(scatter: Scatter, count: int, interfaces: Sequence[Slipping]) -> Scatter:
    """A scatter whose pattern has the entries of the interfaces; count is the number of unknowns."""
    if not interfaces:
        return scatter
    rows, columns = (np.concatenate(side) for side in zip(*(part.entries for part in interfaces), strict=True))
    return widened(scatter, count, rows, columns)[0]


def _sides(problem: Problem, mesh: Mesh, layer: int) -> tuple[IntArray, IntArray]:
    """Nodes of the side that is the curve and of the side that slides, below a layer."""
    upper, lower = mesh.undersides[layer], mesh.interfaces[layer + 1]
    above, below = bending_modulus(problem, layer, -1), bending_modulus(problem, layer + 1, 1)
    return (upper, lower) if above >= below else (lower, upper)


def bending_modulus(problem: Problem, layer: int, step: int) -> float:
    """How much a side of an interface withstands waves: its shear modulus in Pa, less where it is a thin sheet.

    A thick side under waves of the wavenumber q has the stiffness 2 G q, a sheet of thickness h the stiffness
    G h^3 q^4 / 3 (incompressible).

    Parameters
    ----------
    problem
        The problem.
    layer
        The layer at the interface.
    step
        -1 for the side above, 1 for the one below; what is bonded to the layer on this side counts with it.
    """
    limits, last = problem.shear_limits, len(problem.layers) - 1
    thickness, at = problem.layers[layer].thickness, layer
    while 0 <= at + step <= last and limits[min(at, at + step)] is None:
        at += step
        thickness += problem.layers[at].thickness
    if step > 0 and at == last and problem.support.kind != "hole":
        thickness = math.inf
    share = (math.pi * thickness / (HALF_WAVE * problem.tool.radius)) ** 3 / 6.0
    return problem.layers[layer].material.shear_modulus * min(1.0, share)


STICK = 3e3  # stiffness against sliding below the limit, in shear moduli over the thickness of the lowest layer


def sliding_nodes(mesh: Mesh, problem: Problem) -> BoolArray:
    """Nodes (N,) that slide on the plate: all on it but those of the outer border."""
    if problem.support.clamp_shear_limit is None:
        return np.zeros(len(mesh.nodes), dtype=np.bool_)
    return on_the_plate(mesh, problem) & ~mesh.border


def clamp_sliding(mesh: Mesh, problem: Problem, numbering: Numbering) -> Sliding | None:
    """Friction between sheet and plate; None where the sheet does not slide."""
    limit = problem.support.clamp_shear_limit
    if limit is None:
        return None
    row = np.flatnonzero(on_the_plate(mesh, problem))
    row = row[np.argsort(mesh.nodes[row, 0])]
    moving = sliding_nodes(mesh, problem)[row]
    area: FloatArray = ring_areas(mesh.nodes[row, 0])[moving]
    last = problem.layers[-1]
    stick = STICK * last.material.shear_modulus / last.thickness * area
    return Sliding(numbering.unknown[0, row[moving]], stick, limit * area, np.zeros(len(area)))
