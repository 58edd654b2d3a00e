"""From a problem to the items of its equations: slip on the clamp, slip of interfaces, contact of the tool.

The nodes of an interface slide on the curve of the side that bends less: a curve follows the nodes of the other side
only where they stand, and a soft or thin side would fold between them.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.item import EquationItem
from fem.assembly.scatter import Numbering
from fem.interactions.active_set import Friction
from fem.interactions.clamp import ClampFriction
from fem.interactions.interface import Curve, InterfaceFriction
from fem.interactions.punch import Punch
from fem.interactions.tool_contact import ToolContact
from fem.mesh.quads import Mesh, ring_areas
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem
from fem.setup.contacts import Conditions
from fem.setup.supports import on_the_plate

CLAMP_STICK = 6e3  # stiffness against sliding below the limit, in shear moduli over the thickness of the lowest layer
HOLD, GIVE = 1e2, 1e-5  # k in shear moduli over the thickness of the layer that gives more; what it gives
HALF_WAVE = 1.0 / 6.0  # length in tool radii over which a thin side is bent
INTERFACE_UNKNOWNS = 3  # of a node, besides its displacements
PENALTY = 1e5  # of the tool, in shear moduli of the surface layer over the punch's radius


def make_items(
    problem: Problem, mesh: AnyMesh, numbering: Numbering, conditions: Conditions
) -> tuple[Numbering, tuple[EquationItem, ...], int | None]:
    """Items of a problem.

    Parameters
    ----------
    problem, mesh, conditions
        What was asked, the mesh, and the conditions of the contact.
    numbering
        Unknown displacements of the nodes.

    Returns
    -------
    tuple
        The numbering with the items' own unknowns, the items, and the unknown of a tool that touches, or None.
    """
    items: list[EquationItem] = []
    if isinstance(mesh, Mesh):
        items += clamp_slip(problem, mesh, numbering)
    if isinstance(mesh, Mesh) and problem.kinematics == "finite":
        for layer, limit in enumerate(problem.shear_limits):
            if limit is not None:
                slip = interface_slip(problem, mesh, numbering, layer, limit)
                numbering = replace(numbering, count=numbering.count + INTERFACE_UNKNOWNS * len(slip.start))
                items.append(slip)
    if conditions.punch is None or conditions.area is None:
        return numbering, tuple(items), None
    contact = tool_contact(problem, mesh, numbering, conditions.punch, conditions.area)
    count = int(contact.own[-1, -1]) + 1
    return replace(numbering, count=count), (*items, contact), contact.tool


def sliding_nodes(mesh: Mesh, problem: Problem) -> BoolArray:
    """Nodes (N,) that slide on the plate: all on it but those of the outer border; of a cylinder that slides all."""
    if problem.slides_on_plates:
        return mesh.base
    if problem.support.clamp_shear_limit is None:
        return np.zeros(len(mesh.nodes), dtype=np.bool_)
    return on_the_plate(mesh, problem) & ~mesh.border


def clamp_slip(problem: Problem, mesh: Mesh, numbering: Numbering) -> tuple[ClampFriction, ...]:
    """Friction between sheet and plate; none where the sheet does not slide."""
    limit = problem.support.clamp_shear_limit
    if limit is None:
        return ()
    row = np.flatnonzero(on_the_plate(mesh, problem))
    row = row[np.argsort(mesh.nodes[row, 0])]
    moving = sliding_nodes(mesh, problem)[row]
    area: FloatArray = ring_areas(mesh.nodes[row, 0])[moving]
    last = problem.layers[-1]
    stick = CLAMP_STICK * last.material.shear_modulus / last.thickness * area
    return (ClampFriction(numbering.unknown[0, row[moving]], Friction(stick, limit * area, np.zeros(len(area)))),)


def interface_slip(problem: Problem, mesh: Mesh, numbering: Numbering, layer: int, limit: float) -> InterfaceFriction:
    """The interface below a layer with its limit in Pa; its own unknowns follow those of the numbering."""
    curve, nodes = _sides(problem, mesh, layer)
    nodes = nodes[1:-1]
    own = numbering.count + np.arange(INTERFACE_UNKNOWNS * len(nodes)).reshape(INTERFACE_UNKNOWNS, -1)
    area = ring_areas(mesh.nodes[curve, 0])[1:-1]
    hold = area * (
        HOLD * min(part.material.shear_modulus / part.thickness for part in problem.layers[layer : layer + 2])
    )
    return InterfaceFriction(
        Curve(mesh.nodes[curve, 0]),
        mesh.nodes[nodes, 0],
        np.concatenate((numbering.unknown[:, nodes], own)),
        numbering.unknown[:, curve],
        hold,
        GIVE,
        Friction(hold / GIVE, limit * area, np.zeros(len(nodes))),
    )


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


def tool_contact(problem: Problem, mesh: AnyMesh, numbering: Numbering, punch: Punch, area: FloatArray) -> ToolContact:
    """Contact with a punch of the nodes with an area (N,) in m2; its own unknowns follow those of the numbering.

    A node has a multiplier against the punch and, with friction, one for each direction on it.
    """
    nodes = np.flatnonzero(area > 0.0)
    kinds = 1 if punch.friction == 0.0 else len(numbering.unknown)
    tool = np.full((1, len(nodes)), numbering.count)
    multipliers = numbering.count + 1 + np.arange(kinds * len(nodes)).reshape(kinds, -1)
    place: FloatArray = mesh.nodes[nodes].T.copy()
    own = np.concatenate((numbering.unknown[:, nodes], tool, multipliers))
    gap = punch.gap(place)
    anchor = place[:-1] if gap is None else gap.path
    penalty = PENALTY * problem.layers[0].material.shear_modulus / punch.radius * area[nodes]
    first, second = (int(n) for n in np.argsort(place[0])[:2])
    axis = (first, second) if isinstance(mesh, Mesh) else None
    return ToolContact(punch, place, own, Friction(penalty, np.zeros(len(nodes)), anchor), axis=axis)
