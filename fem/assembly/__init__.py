"""Discrete equations of mixed elements; those in three dimensions are in the modules with "solid" in their names."""

from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.geometry import Geometry, gauss_geometry, point_geometry
from fem.assembly.laws import ElementLaws, element_laws
from fem.assembly.memory import Memory, Prony, prony_of
from fem.assembly.scatter import Numbering, Scatter, build_scatter, number_unknowns
from fem.assembly.system import Evaluation, System

__all__ = [
    "ElementGeometry",
    "ElementLaws",
    "Evaluation",
    "Geometry",
    "Memory",
    "Numbering",
    "Prony",
    "Scatter",
    "System",
    "build_scatter",
    "element_laws",
    "gauss_geometry",
    "number_unknowns",
    "point_geometry",
    "prony_of",
]
