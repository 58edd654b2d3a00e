"""The parts of a problem: layers, tool, support and discretisation, each checked when made."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from fem.errors import FemError, require_one_of, require_positive
from fem.materials import Material
from fem.materials.prony import PronyTerm, require_something_left

CONTACTS = ("uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional")
SUPPORTS = ("bonded", "hole", "half_space", "plates")
CLAMPS = ("plate", "rim")
TOUCHING = ("rigid_frictionless", "rigid_frictional")
LARGEST_FRICTION, LARGEST_ADHESION = 10.0, 1e3  # adhesion in N
LARGEST_SHEAR_LIMIT = 1e12  # Pa
LARGEST_EDGE = 8.0
LARGEST_TILT = math.radians(30.0)


@dataclass(frozen=True)
class Layer:
    """One layer of the specimen; layers are listed from the surface down.

    Attributes
    ----------
    name
        What it is called in results.
    thickness
        In m, above 0. The last layer of a half-space is endless: its thickness is not used and may be `inf`.
    density
        In kg/m3, above 0. The quasi-static solver does not need it.
    material
        A law of :mod:`fem.materials`; its moduli are those of a sudden press.
    relaxation
        Prony terms by which the isochoric stress relaxes; their fractions add up to less than 1.
    """

    name: str
    thickness: float
    density: float
    material: Material
    relaxation: tuple[PronyTerm, ...] = ()

    def __post_init__(self) -> None:
        if self.thickness != math.inf:
            require_positive(f"layer {self.name!r}: thickness", self.thickness, "m")
        require_positive(f"layer {self.name!r}: density", self.density, "kg/m3")
        object.__setattr__(self, "relaxation", tuple(self.relaxation))
        require_something_left(self.relaxation, f"layer {self.name!r}: relaxation")


@dataclass(frozen=True)
class Tool:
    """The round tool.

    Attributes
    ----------
    radius
        In m, above 0.
    contact
        "uniform_pressure", "rigid_bonded", "rigid_frictionless" or "rigid_frictional".
    edge_radius
        Rounding of the edge in m, above 0 and at most `radius`; None for a sharp flat cylinder.
    position
        (x, y) in m where the tool's axis meets the surface; in three dimensions only, on a block along x only.
    tilt
        Angle in rad of the tool's axis from the vertical in the x-z plane, its upper end towards +x, at most
        30 degrees. The tool presses and moves vertically. One that touches has depth 0 where its lowest point meets
        the surface.
    friction_coefficient
        Coulomb's, 0 to 10; needed by "rigid_frictional".
    adhesion_force
        Pull in N, 0 to 1e3, that the flat face of a rounded punch holds before it lets go; for the contacts
        "rigid_frictionless" and "rigid_frictional" in finite strain, upright.
    """

    radius: float
    contact: str
    edge_radius: float | None = None
    position: tuple[float, float] = (0.0, 0.0)
    tilt: float = 0.0
    friction_coefficient: float | None = None
    adhesion_force: float = 0.0

    def __post_init__(self) -> None:
        require_positive("tool.radius", self.radius, "m")
        require_one_of("tool.contact", self.contact, CONTACTS)
        if self.edge_radius is not None:
            require_positive("tool.edge_radius", self.edge_radius, "m")
            if self.edge_radius > self.radius:
                raise FemError(
                    f"tool.edge_radius = {self.edge_radius:g} m: must be at most tool.radius = {self.radius:g} m"
                )
        self._require_place()
        self._require_surface()

    def _require_surface(self) -> None:
        friction = self.friction_coefficient
        if self.contact == "rigid_frictional" and friction is None:
            raise FemError("tool.friction_coefficient is missing: contact 'rigid_frictional' needs it, from 0 to 10")
        if friction is not None and not 0.0 <= friction <= LARGEST_FRICTION:
            raise FemError(f"tool.friction_coefficient = {friction:g}: must be from 0 to {LARGEST_FRICTION:g}")
        if not 0.0 <= self.adhesion_force <= LARGEST_ADHESION:
            raise FemError(f"tool.adhesion_force = {self.adhesion_force:g} N: must be from 0 to {LARGEST_ADHESION:g} N")
        if self.adhesion_force > 0.0 and self.contact not in TOUCHING:
            raise FemError(f"tool.adhesion_force: not with contact {self.contact!r}, only {', '.join(TOUCHING)}")

    def _require_place(self) -> None:
        x, y = self.position
        if not (math.isfinite(x) and math.isfinite(y)):
            raise FemError(f"tool.position = ({x:g}, {y:g}) m: must be finite")
        if not abs(self.tilt) <= LARGEST_TILT:
            raise FemError(f"tool.tilt = {self.tilt:g} rad: must be from {-LARGEST_TILT:.4g} to {LARGEST_TILT:.4g} rad")


@dataclass(frozen=True)
class Support:
    """What holds the specimen.

    Attributes
    ----------
    kind
        "bonded" (lower face fixed), "hole" (lower face fixed from `hole_radius` outwards, free inside)
        "half_space" (the last layer is endless) or "plates" (a cylinder on a plate, its side free; the tool is the
        other plate, and both faces stick or slide as its contact says; a negative load pulls).
    hole_radius
        In m, above 0; needed for "hole", and only there.
    clamp_shear_limit
        For "hole" in finite strain and axial symmetry: shear stress in Pa, 0 to 1e12, per area at rest, at which the
        lower face slides on the plate; it stays on the plate, and is held at the outer border. None: it does not slide.
    clamp
        For "hole": "plate" (the lower face is held outside the hole, the sheet goes on above it) or "rim" (the sheet
        ends at the hole, where its whole edge is held).
    specimen_radius
        In m, above 0; needed for "plates", and only there.
    """

    kind: str
    hole_radius: float | None = None
    clamp_shear_limit: float | None = None
    clamp: str = "plate"
    specimen_radius: float | None = None

    def __post_init__(self) -> None:
        require_one_of("support.kind", self.kind, SUPPORTS)
        for key, value, kind in (
            ("hole_radius", self.hole_radius, "hole"),
            ("specimen_radius", self.specimen_radius, "plates"),
        ):
            if (value is None) == (self.kind == kind):
                state = "missing" if value is None else f"{value:g} m"
                raise FemError(f"support.{key} = {state}: needed for the support {kind!r}, and only there")
            if value is not None:
                require_positive(f"support.{key}", value, "m")
        require_one_of("support.clamp", self.clamp, CLAMPS)
        if self.clamp == "rim" and (self.kind != "hole" or self.clamp_shear_limit is not None):
            raise FemError("support.clamp = 'rim': only with the support 'hole', and without clamp_shear_limit")
        self._require_clamp()

    def _require_clamp(self) -> None:
        limit = self.clamp_shear_limit
        if limit is None:
            return
        if self.kind != "hole":
            raise FemError(f"support.clamp_shear_limit: not with the support {self.kind!r}, only with 'hole'")
        if not 0.0 <= limit <= LARGEST_SHEAR_LIMIT:
            raise FemError(f"support.clamp_shear_limit = {limit:g} Pa: must be from 0 to {LARGEST_SHEAR_LIMIT:g} Pa")


@dataclass(frozen=True)
class Discretisation:
    """How fine the mesh is and how far it reaches.

    Attributes
    ----------
    density
        "coarse", "default" or "fine"; "fine" has half the element size of "default".
    radius
        Radius of the outer border in m; None follows tool, stack and support.
    stabilisation
        Finite strain: part of the bulk modulus, in shear moduli, that acts at each Gauss point instead of
        on the pressure field (see :func:`fem.assembly.elements.make_elements`); 0 gives the plain Q2/P1 element.
    edge
        How much larger than usual, 1 to 8, the elements are round the edge of a tool stuck to a first layer that is
        not thin, in finite strain and axial symmetry: a little stiffer, but they fold later. On a block only with
        `halved`, which below 2 leaves the elements at a stuck edge and at a rim as they are.
    halved
        Half as many elements in each direction, on a block as many round the axis, as two solutions need that tell the
        error of a mesh (:func:`fem.estimate_mesh_error`).
    """

    density: Literal["coarse", "default", "fine"] = "default"
    radius: float | None = None
    stabilisation: float = 1.0
    edge: float = 1.0
    halved: bool = False

    def __post_init__(self) -> None:
        require_one_of("discretisation.density", self.density, ("coarse", "default", "fine"))
        if self.radius is not None:
            require_positive("discretisation.radius", self.radius, "m")
        if not 0.0 <= self.stabilisation <= 10.0:
            raise FemError(f"discretisation.stabilisation = {self.stabilisation:g}: must be from 0 to 10 shear moduli")
        if not 1.0 <= self.edge <= LARGEST_EDGE:
            raise FemError(f"discretisation.edge = {self.edge:g}: must be from 1 to {LARGEST_EDGE:g}")
