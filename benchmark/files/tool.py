"""The tool and what the specimen lies on, as scenarios and trial sessions give them."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import model_validator

from benchmark.files.quantities import Length, SignedLength, Tilt, problem
from benchmark.files.schema import FileModel
from benchmark.files.tissue import Tissue

Contact = Literal["uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional"]

TOUCHING = ("rigid_frictionless", "rigid_frictional")
"""Contacts by real contact, which need a rounded edge in finite strain."""


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
        bonded | hole | half_space (the last layer is endless).
    hole_radius : float or None
        m; needed by a hole, ignored otherwise.
    clamp : str
        How a hole holds a sheet: plate (on a plate round the hole) | rim (at the hole's rim, where the sheet ends).
    """

    kind: Literal["bonded", "hole", "half_space"] = "bonded"
    hole_radius: Length | None = None
    clamp: Literal["plate", "rim"] = "plate"

    @model_validator(mode="after")
    def _hole_has_a_radius(self) -> Self:
        if self.kind == "hole" and self.hole_radius is None:
            raise problem('a support of kind "hole" needs it; give a length such as "30 mm"', key="hole_radius")
        if self.kind != "hole" and self.clamp == "rim":
            raise problem('only a support of kind "hole" has a rim; leave it out', key="clamp")
        return self


def setup_uncertainties(tissue: Tissue, tool: Tool, support: Support) -> dict[str, float]:
    """Standard uncertainties that are stated of a set-up, as shares of the values, by keys as in `--set`."""
    parts = {"tool": tool, "support": support}
    own = {f"{name}.{key}": share for name, part in parts.items() for key, share in part.own_uncertainties.items()}
    return {**tissue.uncertainties, **own}


def check_hole(tool: Tool, support: Support) -> None:
    """Refuse a tool that does not pass through the hole it presses into.

    Raises
    ------
    PydanticCustomError
        Naming `support.hole_radius`.
    """
    if support.kind == "hole" and support.hole_radius is not None and support.hole_radius <= tool.radius:
        raise problem(
            f"{support.hole_radius * 1e3:g} mm is not larger than the tool's radius of {tool.radius * 1e3:g} mm; "
            "allowed: above the tool's radius",
            key="support.hole_radius",
        )
