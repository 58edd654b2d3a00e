"""The tool and what the specimen lies on, as scenarios and trial sessions give them."""

from __future__ import annotations

import math
from typing import Literal, Self

from pydantic import model_validator

from benchmark.files.quantities import Length, SignedLength, Tilt, problem
from benchmark.files.schema import FileModel
from benchmark.files.tissue import Layer, Tissue
from benchmark.files.units import DENSITY, LENGTH, PRESSURE, shown_quantity

Contact = Literal["uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional"]

TOUCHING = ("rigid_frictionless", "rigid_frictional")
"""Contacts by real contact, which need a rounded edge in finite strain."""
BETWEEN_PLATES = ("rigid_bonded", "rigid_frictionless")
"""What the faces of a cylinder do on its plates: stick, or slide without friction."""
COVERING = 0.9
"""Of a cylinder's radius, from which on a plate is taken to cover its face: widths are not known better."""

WIDEST, THICKEST = 0.5, 1.0
"""Radii and thicknesses of layers (m) up to which nothing is asked: no bench for tissue or phantoms has larger ones."""
STIFF, DENSE = (10.0, 1e10), (100.0, 3000.0)
"""Young's modulus (Pa) and density (kg/m^3) of layers within which nothing is asked. Wide on purpose: from the softest
gels, or an inflated lung, to beyond tendon and cortical bone."""


class Tool(FileModel):
    """A round tool with a flat end.

    Attributes
    ----------
    radius : float
        m.
    contact : str
        uniform_pressure | rigid_bonded | rigid_frictionless | rigid_frictional.
    edge_radius : float or None
        Rounding of the edge, m; None for a sharp flat cylinder.
    position : tuple of float
        Where the axis meets the surface, (x, y) in m.
    tilt : float
        Angle of the axis from the surface normal in the x-z plane, rad (3-D only).
    """

    radius: Length
    contact: Contact = "uniform_pressure"
    edge_radius: Length | None = None
    position: tuple[SignedLength, SignedLength] = (0.0, 0.0)
    tilt: Tilt = 0.0

    @property
    def rigid(self) -> bool:
        """Whether the tool's face moves as one, so that the depth is the tool's."""
        return self.contact != "uniform_pressure"

    @model_validator(mode="after")
    def _edge_fits(self) -> Self:
        if self.edge_radius is not None and self.edge_radius > self.radius:
            raise problem(
                f"{self.edge_radius * 1e3:g} mm is larger than the tool's radius of {self.radius * 1e3:g} mm; "
                "allowed: up to the radius",
                key="edge_radius",
            )
        return self


class Support(FileModel):
    """What holds the specimen's lower face.

    Attributes
    ----------
    kind : str
        bonded | hole | half_space (the last layer is endless) | plates, grips (a cylinder whose side is free, pressed
        between two plates or pulled by two grips; both faces stick or slide as the tool's contact says).
    hole_radius : float or None
        m; needed by a hole, ignored otherwise.
    clamp : str
        How a hole holds a sheet: plate (on a plate round the hole) | rim (at the hole's rim, where the sheet ends).
    specimen_radius : float or None
        m; needed between plates or grips, and only there.
    """

    kind: Literal["bonded", "hole", "half_space", "plates", "grips"] = "bonded"
    hole_radius: Length | None = None
    clamp: Literal["plate", "rim"] = "plate"
    specimen_radius: Length | None = None

    @property
    def cylinder(self) -> bool:
        """Whether the specimen is a cylinder between two plates or grips."""
        return self.kind in ("plates", "grips")

    @property
    def pull(self) -> float:
        """-1 where forces and depths are counted positive as the specimen is pulled, 1 where as it is pressed."""
        return -1.0 if self.kind == "grips" else 1.0

    @model_validator(mode="after")
    def _hole_has_a_radius(self) -> Self:
        if self.kind == "hole" and self.hole_radius is None:
            raise problem('a support of kind "hole" needs it; give a length such as "30 mm"', key="hole_radius")
        if self.kind != "hole" and self.clamp == "rim":
            raise problem('only a support of kind "hole" has a rim; leave it out', key="clamp")
        if self.cylinder and self.specimen_radius is None:
            raise problem(f'a support of kind "{self.kind}" needs it; give "10 mm"', key="specimen_radius")
        if self.specimen_radius is not None and not self.cylinder:
            raise problem('only the kinds "plates" and "grips" have it; leave it out', key="specimen_radius")
        return self


def setup_uncertainties(tissue: Tissue, tool: Tool, support: Support) -> dict[str, float]:
    """Standard uncertainties that are stated of a set-up, as shares of the values, by keys as in `--set`."""
    parts = {"tool": tool, "support": support}
    own = {f"{name}.{key}": share for name, part in parts.items() for key, share in part.own_uncertainties.items()}
    return {**tissue.uncertainties, **own}


def implausible(tissue: Tissue, tool: Tool, support: Support) -> list[str]:
    """A sentence for each length, stiffness and density that no bench has, as where a unit is another than was meant.

    The bounds of the files are wider: problems of verification and of other scales are allowed.
    """
    hole = support.hole_radius if support.kind == "hole" else None
    radii = {
        "tool.radius": tool.radius,
        "tool.edge_radius": tool.edge_radius,
        "support.hole_radius": hole,
        "support.specimen_radius": support.specimen_radius,
    }
    lengths = [(key, value, WIDEST) for key, value in radii.items() if value is not None]
    lengths += [(f"{each.name}.thickness", each.thickness, THICKEST) for each in tissue.layers]
    long = [
        f"{key} is {shown_quantity(value, LENGTH)}, more than any bench has ({shown_quantity(most, LENGTH)}): "
        f'is another unit meant, such as "{value:.6g} mm"?'
        for key, value, most in lengths
        if most < value < math.inf
    ]
    return long + [said for layer in tissue.layers for said in _odd_material(layer)]


def _odd_material(layer: Layer) -> list[str]:
    """A sentence for a stiffness ("500 mPa") and a density ("1.1 kg/m^3") that no soft tissue or phantom has."""
    asked = (
        ("youngs_modulus", layer.youngs_modulus, PRESSURE, STIFF, "mPa is a thousandth of a pascal, MPa a million"),
        ("density", layer.density, DENSITY, DENSE, "1.1 g/cm^3 is 1100 kg/m^3"),
    )
    return [
        f"{layer.name}.{key} is {shown_quantity(value, dimension)}; soft tissue and phantoms have "
        f"{shown_quantity(low, dimension)} to {shown_quantity(high, dimension)}: is another unit meant ({hint})?"
        for key, value, dimension, (low, high), hint in asked
        if not low <= value <= high
    ]


def check_hole(tool: Tool, support: Support) -> None:
    """Refuse a tool that does not pass through the hole it presses into, and a plate that does not cover its cylinder.

    Raises
    ------
    PydanticCustomError
        Naming `support.hole_radius`, or a key of the tool.
    """
    if support.cylinder:
        _check_plate(tool, support)
    if support.kind == "hole" and support.hole_radius is not None and support.hole_radius <= tool.radius:
        raise problem(
            f"{support.hole_radius * 1e3:g} mm is not larger than the tool's radius of {tool.radius * 1e3:g} mm; "
            "allowed: above the tool's radius",
            key="support.hole_radius",
        )


def _check_plate(tool: Tool, support: Support) -> None:
    if tool.radius < COVERING * (support.specimen_radius or 0.0):
        raise problem(
            f"{tool.radius * 1e3:g} mm does not cover the specimen between plates; allowed: from its radius of "
            f"{(support.specimen_radius or 0.0) * 1e3:g} mm (support.specimen_radius) on",
            key="tool.radius",
        )
    if tool.contact not in BETWEEN_PLATES:
        raise problem(
            f"{tool.contact} is no contact of a plate; allowed: {' or '.join(BETWEEN_PLATES)}", key="tool.contact"
        )
    if tool.edge_radius is not None or tool.tilt != 0.0 or tool.position != (0.0, 0.0):
        raise problem("a plate has no edge, tilt or place on the specimen; leave these keys out", key="tool")
