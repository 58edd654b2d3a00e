"""Discrete equations of mixed elements."""

from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.geometry import Geometry, gauss_geometry, point_geometry
from fem.assembly.laws import ElementLaws, element_laws
from fem.assembly.memory import Memory, Prony, prony_of
from fem.assembly.scatter import Numbering, Scatter, build_scatter, number_unknowns
from fem.assembly.solid_element import SOLID_ELEMENTS, SolidElement
from fem.assembly.solid_geometry import SolidGeometry, solid_geometry, solid_middle
from fem.assembly.system import Evaluation, System

__all__ = [
    "SOLID_ELEMENTS",
    "ElementGeometry",
    "ElementLaws",
    "Evaluation",
    "Geometry",
    "Memory",
    "Numbering",
    "Prony",
    "Scatter",
    "SolidElement",
    "SolidGeometry",
    "System",
    "build_scatter",
    "element_laws",
    "gauss_geometry",
    "number_unknowns",
    "point_geometry",
    "prony_of",
    "solid_geometry",
    "solid_middle",
]
