"""Laws of all elements, evaluated in one batch per kind of law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.deformation import Deformation
from fem.materials import IsochoricLaw, Material


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
    """

    groups: tuple[Group, ...]
    shear_modulus: FloatArray
    bulk_modulus: FloatArray

    def stress(self, deformation: Deformation) -> FloatArray:
        """Isochoric first Piola-Kirchhoff stress (5, q, E) in Pa."""
        if len(self.groups) == 1:
            return self.groups[0].law.stress(deformation, self.groups[0].parameters)
        out = np.empty_like(deformation.H)
        for group in self.groups:
            out[..., group.elements] = group.law.stress(_part(deformation, group), group.parameters)
        return out

    def tangent(self, deformation: Deformation) -> FloatArray:
        """Packed dP/dF (15, q, E) in Pa."""
        if len(self.groups) == 1:
            return self.groups[0].law.tangent(deformation, self.groups[0].parameters)
        pairs = len(deformation.components.pairs[0])
        out = np.empty((pairs, *deformation.J.shape))
        for group in self.groups:
            out[..., group.elements] = group.law.tangent(_part(deformation, group), group.parameters)
        return out


def _part(deformation: Deformation, group: Group) -> Deformation:
    return Deformation(deformation.components, deformation.H[..., group.elements])


def element_laws(materials: tuple[Material, ...], layer: IntArray) -> ElementLaws:
    """Laws of elements by their layer (E,)."""
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
    return ElementLaws(tuple(groups), shear, bulk)
