"""Discrete equations of the axisymmetric mixed element."""

from fem.assembly.geometry import Geometry, gauss_geometry, point_geometry
from fem.assembly.laws import ElementLaws, element_laws
from fem.assembly.scatter import Numbering, Scatter, build_scatter, number_unknowns
from fem.assembly.system import Evaluation, System

__all__ = [
    "ElementLaws",
    "Evaluation",
    "Geometry",
    "Numbering",
    "Scatter",
    "System",
    "build_scatter",
    "element_laws",
    "gauss_geometry",
    "number_unknowns",
    "point_geometry",
]
