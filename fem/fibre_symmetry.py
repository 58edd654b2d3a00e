"""Whether the directions of fibres fit the symmetry of a geometry."""

from __future__ import annotations

import math
from collections.abc import Mapping

from fem.errors import FemError
from fem.materials import Fibre, FibreReinforced, Material

SAME = 1e-9


def require_fibre_symmetry(materials: Mapping[str, Material], geometry: str) -> None:
    """Refuse directions of fibres in a layer's material that the geometry cannot have.

    Axial symmetry has no direction in the plane; a block has mirror planes along x and y.

    Raises
    ------
    FemError
        If a family breaks the symmetry.
    """
    for name, material in materials.items():
        if not isinstance(material, FibreReinforced):
            continue
        directed = [fibre for fibre in material.fibres if fibre.directed]
        if geometry == "axisymmetric" and directed:
            raise FemError(
                f"layer {name!r}: fibre angle = {_degrees(directed[0]):g} deg breaks the symmetry of geometry = "
                "'axisymmetric': leave the angle out (fibres spread evenly over the plane), set dispersion = 1/3, "
                "or use a geometry in three dimensions"
            )
        lonely = [fibre for fibre in directed if geometry == "block" and not _mirrored(fibre, directed)]
        if lonely:
            raise FemError(
                f"layer {name!r}: fibre angle = {_degrees(lonely[0]):g} deg breaks the mirror planes of "
                "geometry = 'block': use 0 or 90 deg, two equal families at plus and minus the angle, or 'surface'"
            )


def _mirrored(fibre: Fibre, families: list[Fibre]) -> bool:
    """Whether the mirror image of a family is there, and as often as the family itself."""
    alike = [f for f in families if (f.k1, f.k2, f.dispersion) == (fibre.k1, fibre.k2, fibre.dispersion)]
    angle = fibre.angle or 0.0
    here = sum(_apart(f.angle or 0.0, angle) < SAME for f in alike)
    return here == sum(_apart(f.angle or 0.0, -angle) < SAME for f in alike)


def _apart(first: float, second: float) -> float:
    """Angle between two directions without sense, in rad."""
    return abs(math.remainder(first - second, math.pi))


def _degrees(fibre: Fibre) -> float:
    return math.degrees(fibre.angle or 0.0)
