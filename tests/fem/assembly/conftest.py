"""A small two-layer system the assembly tests share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from fem import NeoHookean
from fem.assembly.axisymmetric import gauss_geometry
from fem.assembly.elements import make_elements
from fem.assembly.scatter import build_scatter, number_unknowns
from fem.assembly.system import System, make_system
from fem.materials.element_laws import element_laws
from fem.mesh.fan import Fan
from fem.mesh.quads import Mesh, build_mesh


@pytest.fixture
def block() -> Callable[..., Mesh]:
    """Cylinder of radius 1 and height 1 in two layers; unequal elements."""

    def make(n: int = 2, fan: bool = False) -> Mesh:
        if fan:
            lines = np.array([0.0, 0.4, 0.5, 0.6, 1.0])
            return build_mesh(lines, np.array([0.0, 0.1, 0.5, 1.0]), np.array([0.0, 0.5]), [Fan(0.5, 0.1, (1.0, 0.5))])
        r = np.linspace(0.0, 1.0, n + 1) ** 1.2
        return build_mesh(r, np.concatenate((np.linspace(0, 0.5, n + 1), [1.0])), np.array([0.0, 0.5]))

    return make


@pytest.fixture
def system_of() -> Callable[..., System]:
    """System of a mesh; base and axis held as asked, top tied if asked."""

    def make(mesh: Mesh, nu: float = 0.45, hold: bool = True, tie: bool = False, stabilisation: float = 0.0) -> System:
        base = mesh.base if hold else np.zeros_like(mesh.base)
        axis = mesh.axis if hold else np.zeros_like(mesh.axis)
        fixed = np.stack((base | axis, base))
        tied = mesh.top if tie else np.zeros_like(mesh.top)
        numbering = number_unknowns(fixed, tied)
        laws = element_laws((NeoHookean(1.0, nu), NeoHookean(5.0, nu)), mesh.layer)
        scatter = build_scatter(mesh.elements, numbering)
        return make_system(make_elements(gauss_geometry(mesh), laws, stabilisation), numbering, scatter)

    return make
