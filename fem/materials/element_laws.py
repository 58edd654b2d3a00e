"""Laws of all elements, evaluated in one batch per kind of law, with what the state before the press adds.

A pretension S0 (constant second Piola-Kirchhoff stress) adds F S0 to P, in equilibrium at rest where S0 lies in the
plane of the layers; its linear form is the geometric stiffness of an initial stress (M. A. Biot, Mechanics of
Incremental Deformations, 1965). It does not relax. The share and the overstress of relaxation are explained in
:mod:`fem.materials.prony`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.materials import IsochoricLaw, Material
from fem.materials.deformation import Deformation
from fem.materials.invariants import structure_curvature, structure_gradient
from fem.materials.prony import Prony, PronyTerm, prony_of


@dataclass(frozen=True)
class Group:
    """Elements that share a law.

    Attributes
    ----------
    law
        The law.
    parameters
        Its parameters (k, n) on the n elements.
    elements
        The elements (n,).
    """

    law: IsochoricLaw
    parameters: FloatArray
    elements: IntArray


@dataclass(frozen=True)
class ElementLaws:
    """The isochoric laws of all elements.

    Attributes
    ----------
    groups
        One per kind of law.
    shear_modulus, bulk_modulus
        Moduli at rest (E,) in Pa.
    prony
        Series of their relaxation, or None.
    pretension
        S0, (components, 1, 1) in Pa, or None.
    share
        Share (E,) of the elastic stress that relaxation leaves to this step; None for all of it.
    overstress
        Known overstress (components, q, E) in Pa, or None.
    """

    groups: tuple[Group, ...]
    shear_modulus: FloatArray
    bulk_modulus: FloatArray
    prony: Prony | None = None
    pretension: FloatArray | None = None
    share: FloatArray | None = None
    overstress: FloatArray | None = None

    def relaxing(self, share: FloatArray, overstress: FloatArray | None) -> ElementLaws:
        """The same laws in a step of relaxation."""
        return replace(self, share=share, overstress=overstress)

    def stress(self, deformation: Deformation) -> FloatArray:
        """First Piola-Kirchhoff stress (5, q, E) in Pa without the pressure."""
        out = self.stress_change(deformation)
        if self.pretension is not None:
            out += self.pretension
        return out

    def stress_change(self, deformation: Deformation) -> FloatArray:
        """The same less the pretension at rest: in equilibrium itself, its round-off would hide small loads."""
        out = self.elastic_stress(deformation)
        if self.share is not None:
            out *= self.share
        if self.overstress is not None:
            out += structure_gradient(deformation, self.overstress)
        if self.pretension is not None:
            out += deformation.components.product(deformation.H, self.pretension)
        return out

    def tangent(self, deformation: Deformation) -> FloatArray:
        """Packed dP/dF (15, q, E) in Pa."""
        out = self.elastic_tangent(deformation)
        if self.share is not None:
            out *= self.share
        if self.overstress is not None:
            out += structure_curvature(deformation, self.overstress, np.ones(()))
        if self.pretension is not None:
            place, component = deformation.components.row_pairs
            out[place] += self.pretension[component]
        return out

    def second_stress(self, deformation: Deformation) -> FloatArray:
        """J^(2/3) F^-1 P of the elastic isochoric stress P, (5, q, E) in Pa: what relaxation remembers."""
        components = deformation.components
        pulled = components.product(deformation.cofactor[components.transposed], self.elastic_stress(deformation))
        out: FloatArray = pulled / (deformation.J * deformation.isochoric_factor)
        return out

    def linear_stress(self, deformation: Deformation) -> FloatArray:
        """Elastic isochoric stress (5, q, E) in Pa of small strain, from the moduli at rest."""
        components = deformation.components
        rest = Deformation(components, np.zeros_like(deformation.H))
        moduli = components.unpack(self.elastic_tangent(rest))
        out: FloatArray = np.einsum("kmqe,mqe->kqe", moduli, deformation.H)
        return out

    def small_stress(self, deformation: Deformation) -> FloatArray:
        """Stress (5, q, E) in Pa of small strain without the pressure: relaxed, with the pretension."""
        out = self.linear_stress(deformation)
        if self.share is not None:
            out *= self.share
        if self.overstress is not None:
            out += self.overstress
        if self.pretension is not None:
            out += self.pretension
        return out

    def elastic_stress(self, deformation: Deformation) -> FloatArray:
        """Isochoric first Piola-Kirchhoff stress (5, q, E) in Pa."""
        if len(self.groups) == 1:
            return self.groups[0].law.stress(deformation, self.groups[0].parameters)
        out = np.empty_like(deformation.H)
        for group in self.groups:
            out[..., group.elements] = group.law.stress(_part(deformation, group), group.parameters)
        return out

    def elastic_tangent(self, deformation: Deformation) -> FloatArray:
        """Packed dP/dF (15, q, E) in Pa of the isochoric stress."""
        if len(self.groups) == 1:
            return self.groups[0].law.tangent(deformation, self.groups[0].parameters)
        pairs = len(deformation.components.pairs[0])
        out = np.empty((pairs, *deformation.J.shape))
        for group in self.groups:
            out[..., group.elements] = group.law.tangent(_part(deformation, group), group.parameters)
        return out


def _part(deformation: Deformation, group: Group) -> Deformation:
    return Deformation(deformation.components, deformation.H[..., group.elements])


def element_laws(
    materials: tuple[Material, ...],
    layer: IntArray,
    relaxation: tuple[tuple[PronyTerm, ...], ...] = (),
    pretension: FloatArray | None = None,
) -> ElementLaws:
    """Laws of elements by their layer (E,).

    Parameters
    ----------
    materials
        Material of each layer.
    layer
        Layer of each element (E,).
    relaxation
        Prony terms of each layer, or empty for none at all.
    pretension
        S0, (components, 1, 1) in Pa, the same in all layers, or None.
    """
    laws = list(dict.fromkeys(material.law for material in materials))
    groups = []
    for law in laws:
        members = [n for n, material in enumerate(materials) if material.law == law]
        elements = np.flatnonzero(np.isin(layer, members))
        table = np.array([materials[n].parameters for n in members])
        position = np.searchsorted(members, layer[elements])
        groups.append(Group(law, np.ascontiguousarray(table[position].T), elements))
    shear = np.array([material.shear_modulus for material in materials])[layer]
    bulk = np.array([material.bulk_modulus for material in materials])[layer]
    return ElementLaws(tuple(groups), shear, bulk, prony_of(relaxation, layer), pretension)
