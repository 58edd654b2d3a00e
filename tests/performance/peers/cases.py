"""The problems the finite-element programs are compared on, meshed by this project's solver."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType

import numpy as np

import fem
from fem.assembly.solid import SOLID_ELEMENTS
from fem.mesh.grading import Feature, Sizing, graded_line
from fem.mesh.solid import DiscGrid, build_block
from fem.setup.layout import lay_out
from fem.setup.tool_faces import disc_load
from tests.performance.peers.case import LAYERS, POISSON, Case

TOOL_RADIUS = 5.0e-3
BORDER = 30.0e-3


def block_case(density: float) -> Case:
    """Quarter block of serendipity hexahedra with 8 Gauss points; density 1 gives about 9 000 unknowns."""
    depths = np.concatenate(([0.0], np.cumsum([thickness for thickness, _ in LAYERS])))
    size = TOOL_RADIUS / 12.0
    inner = 0.45 * TOOL_RADIUS
    line = graded_line((inner, TOOL_RADIUS, BORDER), Sizing((Feature(TOOL_RADIUS, size, 0.5),)), density)
    rings = line[(line == inner) | (line >= 1.4 * inner)]
    grid = DiscGrid(rings, max(2, round(2 * density)), 1, 0.0, TOOL_RADIUS, BORDER, TOOL_RADIUS)
    lines = graded_line(tuple(depths), Sizing((Feature(0.0, size, 0.5),)), density)
    mesh = build_block(grid, lines, depths[:-1], SOLID_ELEMENTS["hex20"].node_places, "hex20")
    held = mesh.base | mesh.border
    fixed = np.stack((held | mesh.mirror_x, held | mesh.mirror_y, held))
    load = 0.25 * disc_load(mesh, TOOL_RADIUS)
    return Case("linear", mesh.nodes, mesh.elements, SOLID_ELEMENTS["hex20"].vtk_order, mesh.layer, fixed, load, 1)


def axisymmetric_case(steps: int = 50, force: float = 2.5) -> Case:
    """The default axisymmetric mesh under a uniform dead pressure at large strain."""
    layers = tuple(fem.Layer(f"layer {n}", h, 1000.0, fem.NeoHookean(E, POISSON)) for n, (h, E) in enumerate(LAYERS))
    problem = fem.Problem(
        layers,
        fem.Tool(TOOL_RADIUS, "uniform_pressure"),
        fem.Support("bonded"),
        discretisation=fem.Discretisation(radius=BORDER),
    )
    mesh = lay_out(problem)
    held = mesh.base | mesh.border
    load = force * disc_load(mesh, TOOL_RADIUS)
    return Case(
        "hyperelastic",
        mesh.nodes,
        mesh.elements,
        np.arange(9),
        mesh.layer,
        np.stack((held | mesh.axis, held)),
        load,
        steps,
    )


CASES: Mapping[str, Callable[[], Case]] = MappingProxyType(
    {
        "linear 9k": partial(block_case, 1.3),
        "linear 21k": partial(block_case, 1.8),
        "linear 44k": partial(block_case, 2.4),
        "linear 97k": partial(block_case, 3.25),
        "hyperelastic": axisymmetric_case,
    }
)
"""By name: three-dimensional linear ones (C3D20R elsewhere), and fifty axisymmetric steps at large strain, Q2 with one
constant pressure (CalculiX: CAX8R, another element)."""
