"""Collects the accepted steps of a run and makes the solution of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fem.analysis.equilibrium import Equilibrium, State
from fem.arrays import FloatArray
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.system import System
from fem.mesh.solid import AnyMesh
from fem.results.fields import FieldRecovery
from fem.results.solution import Failure, Resumed, Solution


def largest_element_strain(strain: FloatArray, geometry: ElementGeometry) -> float:
    """Largest principal strain of the elements' mean strains.

    Parameters
    ----------
    strain
        Components (components, q, E) at the points of the geometry.
    geometry
        Gauss points with weights.

    Returns
    -------
    float
        Largest absolute value. Means over elements keep the singular edge of a sharp tool from deciding alone.
    """
    weight = geometry.weight / geometry.weight.sum(axis=0)
    return float(geometry.components.largest_principal(np.einsum("kqe,qe->ke", strain, weight)).max())


@dataclass
class Record:
    """Accepted steps of a run.

    Attributes
    ----------
    mesh, equilibrium, recovery
        What the states belong to.
    layer_names
        Names of the layers.
    time
        Times in s so far.
    states
        States so far.
    reactions
        Reactions in N so far.
    strains
        Largest strains so far.
    resumed
        What was taken over from a checkpoint; None in a run from rest.
    """

    mesh: AnyMesh
    equilibrium: Equilibrium
    recovery: FieldRecovery
    layer_names: tuple[str, ...]
    time: list[float] = field(default_factory=list)
    states: list[State] = field(default_factory=list)
    reactions: list[float] = field(default_factory=list)
    strains: list[float] = field(default_factory=list)
    resumed: Resumed | None = None

    def add(self, time: float, state: State, reaction: float, largest_strain: float) -> None:
        """Keep an accepted step."""
        self.time.append(time)
        self.states.append(state)
        self.reactions.append(reaction)
        self.strains.append(largest_strain)

    def copy(self) -> Record:
        """The same steps, to which others can be added."""
        lists: dict[str, Any] = {name: [*getattr(self, name)] for name in ("time", "states", "reactions", "strains")}
        return replace(self, **lists)

    def solution(self, failure: Failure | None, warnings: tuple[str, ...], further: Record | None = None) -> Solution:
        """Arrays of all steps kept; `further` has the last state of equilibrium between two steps, too."""
        numbering = self.equilibrium.system.numbering
        y = np.array([state.y for state in self.states]).reshape(len(self.states), numbering.count)
        nodal = numbering.expand(y).swapaxes(1, 2)
        rest_pressure = self.equilibrium.system.rest()[1]
        pressure = np.array([s.pressure for s in self.states]).reshape(len(self.states), *rest_pressure.shape)
        return Solution(
            time=np.array(self.time),
            force=np.array([state.force for state in self.states]),
            reaction=np.array(self.reactions),
            depth=-y[:, self.equilibrium.probe],
            layer_names=self.layer_names,
            top_deflection=self._top_deflection(nodal),
            max_strain=np.array(self.strains),
            displacement=nodal,
            pressure=pressure,
            complete=failure is None,
            failure=failure,
            warnings=warnings,
            mesh=self.mesh,
            recovery=self.recovery,
            resumed=self.resumed,
            last=None if further is None else further.solution(failure, warnings),
        )

    def _top_deflection(self, nodal: FloatArray) -> FloatArray:
        """Deflection (n, L) in m of the layers' top faces on the tool's axis of displacements (n, N, components)."""
        axis = np.zeros(1)
        rows = [self.mesh.profile(-u[:, -1], axis)[:, 0] for u in nodal]
        return np.array(rows).reshape(len(nodal), len(self.layer_names))


def largest_strain(system: System, y: FloatArray, finite: bool) -> float:
    """Largest element mean of the Green-Lagrange strain (`finite`) or of the small strain."""
    deformation = system.elements.deformation(system.element_displacement(y))
    measure = deformation.green_strain if finite else deformation.small_strain
    return largest_element_strain(measure, system.elements.geometry)
