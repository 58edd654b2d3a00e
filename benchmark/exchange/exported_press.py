"""A scenario as another finite-element code gets it: our mesh, what is held, tied and loaded, and the history.

The mesh is our axisymmetric one, a step finer than the scenario's: the elements of other codes have no pressure field
of their own and are stiffer at sharp edges. What no such code can express is refused by name.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

import fem
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.fem_problem import with_stated_effects
from benchmark.models.model_result import Array, Drive, UncoveredError
from benchmark.models.prepare import scenario_drive
from fem.mesh.quads import Mesh
from fem.setup.contacts import CONTACT_MODELS
from fem.setup.supports import SUPPORT_MODELS

FINER: Mapping[str, Literal["default", "fine"]] = {"coarse": "default", "default": "fine", "fine": "fine"}
"""Mesh that is written, by the scenario's."""
FAN = 2.0
"""Elements round the edge of a tool stuck to a thick layer stay as large as ours: CalculiX's fold earlier."""
CORNERS, EIGHT = 4, 8

Nodes = NDArray[np.int64]
Mask = NDArray[np.bool_]
LawText = Callable[[Any], str]
Laws = Mapping[type[fem.Material], LawText]


@dataclass(frozen=True, eq=False)
class Element:
    """A quadrilateral, or a triangle where ours is collapsed.

    `nodes` are the corners around, then the mid-sides, beginning with that between the first two corners.
    """

    number: int
    nodes: tuple[int, ...]

    @property
    def corners(self) -> int:
        """Three or four."""
        return len(self.nodes) // 2


@dataclass(frozen=True, eq=False)
class ExportedPress:
    """What is written.

    Attributes
    ----------
    scenario : Scenario
    problem : fem.Problem
        With the mesh that is written.
    mesh : fem.mesh.quads.Mesh
        Nodes (r, z) in m, the surface at z = 0.
    drive : Drive
        Time (n,) s and force (n,) N or depth (n,) m.
    held, held_radially, tied : (N,) bool
        Nodes held in both directions, in the radial one alone, and those that move down as one, the tool's.
    load : (N,) array
        Nodal forces in z of a press of 1 N, N.
    """

    scenario: Scenario
    problem: fem.Problem
    mesh: Mesh
    drive: Drive
    held: Mask
    held_radially: Mask
    tied: Mask
    load: Array

    @property
    def axis_nodes(self) -> tuple[int, ...]:
        """Node on the axis of each layer's top face."""
        return tuple(int(row[0]) for row in self.mesh.interfaces)

    def elements(self, layer: int) -> list[Element]:
        """Elements of a layer."""
        return [self._element(int(number)) for number in np.flatnonzero(self.mesh.layer == layer)]

    def _element(self, number: int) -> Element:
        nodes = self.mesh.elements[:EIGHT, number]
        places = self.mesh.nodes[nodes[:CORNERS]]
        closed = [k for k in range(CORNERS) if np.array_equal(places[k], places[(k + 1) % CORNERS])]
        if not closed:
            return Element(number, tuple(int(node) for node in nodes))
        corners = [(closed[0] + turn) % CORNERS for turn in (1, 2, 3)]
        return Element(number, tuple(int(nodes[k]) for k in (*corners, *(CORNERS + k for k in corners))))


def exported_press(scenario: Scenario, *, memory: bool = False) -> ExportedPress:
    """The press of a scenario, for another code, which has Prony series (`memory`) or not.

    Raises
    ------
    InputError
        What cannot be expressed, by name.
    """
    try:
        stated = with_stated_effects(scenario).problem
    except (UncoveredError, fem.FemError) as error:
        raise InputError(f"--export: scenario {scenario.name}: {error}") from None
    _refuse(scenario, stated, memory)
    options = stated.discretisation
    finer = replace(options, density=FINER[options.density], edge=max(options.edge, FAN))
    problem = replace(stated, discretisation=finer)
    try:
        mesh = fem.prepare(problem).mesh
    except fem.FemError as error:
        raise InputError(f"--export: scenario {scenario.name}: {error}") from None
    if not isinstance(mesh, Mesh):
        raise _not("fem.geometry", problem.geometry, "axisymmetric")
    conditions = CONTACT_MODELS[problem.tool.contact].conditions(mesh, problem)
    held = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    radially = (mesh.axis | conditions.held) & ~held
    drive = scenario_drive(scenario)
    drive = replace(drive, value=scenario.support.pull * drive.value)
    return ExportedPress(scenario, problem, mesh, drive, held, radially, conditions.tied & ~held, conditions.load)


def _refuse(scenario: Scenario, problem: fem.Problem, memory: bool) -> None:
    """Refuse what has no counterpart in an axisymmetric input file."""
    if problem.geometry != "axisymmetric":
        raise _not("fem.geometry", problem.geometry, "axisymmetric")
    if problem.touches:
        raise _not("tool.contact", problem.tool.contact, "rigid_bonded, uniform_pressure")
    if problem.tool.contact == "uniform_pressure" and scenario.load.control == "depth":
        raise _not("load.control", "depth with contact uniform_pressure", "force")
    for layer in problem.layers:
        if layer.relaxation and not memory:
            raise _not(f"{layer.name}.relaxation", "Prony terms", "layers without relaxation (--set ...relaxation=[])")
    stated = {
        "physics.pretension": problem.pretension,
        "physics.interface_shear_limit": problem.interface_shear_limit,
        "physics.clamp_shear_limit": problem.support.clamp_shear_limit,
    }
    for key, value in stated.items():
        if value is not None and value != 0.0:
            raise _not(key, str(value), "scenarios without it")
    if problem.slides_on_plates:
        raise _not("tool.contact", "rigid_frictionless between plates", "rigid_bonded")
    if problem.support.kind == "half_space":
        raise _not("support.kind", "half_space", "bonded, hole, plates, grips")
    if (np.abs(scenario_drive(scenario).value) == 0.0).all():
        raise InputError(f"--export: scenario {scenario.name} presses nothing")


def _not(key: str, value: str, allowed: str) -> InputError:
    return InputError(f"--export: {key} = {value} cannot be expressed in the exported file; allowed: {allowed}")


def law_text(layer: fem.Layer, laws: Laws, code: str) -> str:
    """A layer's law in another code's words; raises InputError where that code has none like it."""
    for kind, text in laws.items():
        if isinstance(layer.material, kind):
            return text(layer.material)
    name = type(layer.material).__name__
    known = ", ".join(kind.__name__ for kind in laws)
    raise InputError(f"--export: layer {layer.name}: {code} has no law like {name}; allowed: {known}")


def refuse_linear(press: ExportedPress, code: str) -> None:
    """Refuse small strain, for a code that has none."""
    if press.problem.kinematics == "linear":
        raise InputError(f"--export: fem.kinematics = linear: {code} has finite strain only; allowed: finite")
