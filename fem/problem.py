"""The problem: layers, tool, support, kinematics and discretisation, checked when made.

Nothing here computes; :func:`fem.prepare` turns a problem into a model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fem.checks import require_one_of, require_positive
from fem.errors import FemError
from fem.fibre_symmetry import require_fibre_symmetry
from fem.materials import Material
from fem.relaxation import PronyTerm, require_something_left

if TYPE_CHECKING:
    from fem.mesh.surface.model import Surface

CONTACTS = ("uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional")
SUPPORTS = ("bonded", "hole", "half_space")
GEOMETRIES = ("axisymmetric", "block", "surface")
TOUCHING = ("rigid_frictionless", "rigid_frictional")
LARGEST_FRICTION, LARGEST_ADHESION = 10.0, 1e3  # adhesion in N
LARGEST_PRETENSION = 1e8  # Pa
LARGEST_SHEAR_LIMIT = 1e12  # Pa
LARGEST_EDGE = 4.0
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
        Prony terms by which the isochoric stress fades; their fractions add up to less than 1.
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
        or "half_space" (the last layer is endless).
    hole_radius
        In m, above 0; needed for "hole", and only there.
    clamp_shear_limit
        For "hole" in finite strain and axial symmetry: shear stress in Pa, 0 to 1e12, per area at rest, at which the
        lower face slides on the plate; it stays on the plate, and is held at the outer border. None: it does not slide.
    """

    kind: str
    hole_radius: float | None = None
    clamp_shear_limit: float | None = None

    def __post_init__(self) -> None:
        require_one_of("support.kind", self.kind, SUPPORTS)
        if (self.hole_radius is None) == (self.kind == "hole"):
            state = "missing" if self.hole_radius is None else f"{self.hole_radius:g} m"
            raise FemError(f"support.hole_radius = {state}: needed for the support 'hole', and only there")
        if self.hole_radius is not None:
            require_positive("support.hole_radius", self.hole_radius, "m")
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
        on the pressure field (see :class:`fem.assembly.System`); 0 gives the plain Q2/P1 element.
    edge
        How much larger than usual, 1 to 4, the elements are round the edge of a tool stuck to a first layer that is not
        thin, in finite strain and axial symmetry: a little stiffer, but they fold later.
    """

    density: Literal["coarse", "default", "fine"] = "default"
    radius: float | None = None
    stabilisation: float = 1.0
    edge: float = 1.0

    def __post_init__(self) -> None:
        require_one_of("discretisation.density", self.density, ("coarse", "default", "fine"))
        if self.radius is not None:
            require_positive("discretisation.radius", self.radius, "m")
        if not 0.0 <= self.stabilisation <= 10.0:
            raise FemError(f"discretisation.stabilisation = {self.stabilisation:g}: must be from 0 to 10 shear moduli")
        if not 1.0 <= self.edge <= LARGEST_EDGE:
            raise FemError(f"discretisation.edge = {self.edge:g}: must be from 1 to {LARGEST_EDGE:g}")


@dataclass(frozen=True)
class Problem:
    """Everything but the load history.

    Attributes
    ----------
    layers
        From the surface down, at least one, with different names.
    tool, support
        Tool and support.
    kinematics
        "finite" (large strain) or "linear" (small strain).
    discretisation
        Mesh density and outer radius.
    geometry
        "axisymmetric"; "block": three dimensions, a square block of half side `discretisation.radius`; or
        "surface": the body inside `surface`, whose layers count inwards from it, the last one filling the rest.
    pretension
        Tensile stress in Pa in the plane of all layers before the press, 0 to 1e8, the same in all directions; the
        layers' moduli are those of small motions from there. Not with geometry = "surface".
    surface
        The body's surface, for that geometry only (see :func:`fem.read_surface`).
    interface_shear_limit
        Shear stress in Pa, 0 to 1e12, per area at rest, at which the layers slide on each other without parting: one
        value for all interfaces, or one for each from the top. 0: without friction; None or inf: bonded. For
        geometry = "axisymmetric" only; in linear kinematics 0 or bonded only.

    Raises
    ------
    FemError
        If the parts do not fit together.
    """

    layers: tuple[Layer, ...]
    tool: Tool
    support: Support
    kinematics: Literal["finite", "linear"] = "finite"
    discretisation: Discretisation = field(default_factory=Discretisation)
    geometry: Literal["axisymmetric", "block", "surface"] = "axisymmetric"
    surface: Surface | None = None
    pretension: float = 0.0
    interface_shear_limit: float | tuple[float | None, ...] | None = None

    @property
    def shear_limits(self) -> tuple[float | None, ...]:
        """Limit in Pa of each interface from the top; None where it is bonded."""
        given = self.interface_shear_limit
        limits = given if isinstance(given, tuple) else (given,) * (len(self.layers) - 1)
        return tuple(None if limit is None or limit == math.inf else limit for limit in limits)

    def __post_init__(self) -> None:
        object.__setattr__(self, "layers", tuple(self.layers))
        require_one_of("kinematics", self.kinematics, ("finite", "linear"))
        require_one_of("geometry", self.geometry, GEOMETRIES)
        if not self.layers:
            raise FemError("layers: none given, at least one is needed")
        names = [layer.name for layer in self.layers]
        for name in names:
            if names.count(name) > 1:
                raise FemError(f"layers: the name {name!r} is used {names.count(name)} times, names must differ")
        self._require_finite_thickness()
        self._require_finite_strain_laws()
        require_fibre_symmetry({layer.name: layer.material for layer in self.layers}, self.geometry)
        self._require_pretension()
        self._require_room()
        self._require_sliding()
        self._require_slipping()
        self._require_three_dimensions()

    def _require_finite_thickness(self) -> None:
        endless = 1 if self.support.kind == "half_space" or self.geometry == "surface" else 0
        for layer in self.layers[: len(self.layers) - endless]:
            if math.isinf(layer.thickness):
                raise FemError(
                    f"layer {layer.name!r}: thickness = inf m: "
                    "only the last layer of the support 'half_space' is endless and that of a surface fills the rest"
                )

    def _require_finite_strain_laws(self) -> None:
        for layer in self.layers:
            if self.kinematics == "finite" and not layer.material.finite_strain:
                raise FemError(
                    f"layer {layer.name!r}: material {type(layer.material).__name__} is for kinematics = 'linear' "
                    "only; kinematics = 'finite' needs a hyperelastic law such as NeoHookean"
                )

    def _require_pretension(self) -> None:
        if not 0.0 <= self.pretension <= LARGEST_PRETENSION:
            raise FemError(f"pretension = {self.pretension:g} Pa: must be from 0 to {LARGEST_PRETENSION:g} Pa")
        if self.pretension > 0.0 and self.geometry == "surface":
            raise FemError("pretension: a body of geometry = 'surface' has no plane to lie in; leave it out")

    def _require_room(self) -> None:
        radius, hole = self.discretisation.radius, self.support.hole_radius
        least, why = self.tool.radius, "tool.radius"
        if hole is not None and hole > least:
            least, why = hole, "support.hole_radius"
        if radius is not None and radius <= least:
            raise FemError(f"discretisation.radius = {radius:g} m: must be above {why} = {least:g} m")

    def _require_sliding(self) -> None:
        slides = self.support.clamp_shear_limit is not None
        if slides and (self.kinematics, self.geometry) != ("finite", "axisymmetric"):
            raise FemError(
                "support.clamp_shear_limit: only with kinematics = 'finite' and geometry = 'axisymmetric'; leave it out"
            )

    def _require_slipping(self) -> None:
        limits, name, interfaces = self.shear_limits, "interface_shear_limit", len(self.layers) - 1
        if self.interface_shear_limit is None:
            return
        if not limits or len(limits) != interfaces:
            raise FemError(
                f"{name}: {len(limits)} values for {len(self.layers)} layers, which have {interfaces} interfaces; "
                "give one value for all, or one for each from the top"
            )
        for limit in (limit for limit in limits if limit is not None):
            if not 0.0 <= limit <= LARGEST_SHEAR_LIMIT:
                raise FemError(f"{name} = {limit:g} Pa: must be from 0 to {LARGEST_SHEAR_LIMIT:g} Pa, or inf (bonded)")
            if self.geometry != "axisymmetric":
                raise FemError(f"{name}: only with geometry = 'axisymmetric'; leave it out")
            if self.kinematics == "linear" and limit > 0.0:
                raise FemError(
                    f"{name} = {limit:g} Pa: kinematics = 'linear' has interfaces without friction (0) and bonded "
                    "ones (inf) only; use kinematics = 'finite'"
                )

    def _require_three_dimensions(self) -> None:
        tool = self.tool
        if self.geometry == "axisymmetric" and (tool.position != (0.0, 0.0) or tool.tilt != 0.0):
            raise FemError(
                f"tool.position = ({tool.position[0]:g}, {tool.position[1]:g}) m, tool.tilt = {tool.tilt:g} rad: "
                "geometry = 'axisymmetric' has the tool upright on the axis; use geometry = 'block'"
            )
        if tool.tilt != 0.0 and tool.contact != "rigid_bonded" and not self.touches:
            raise FemError(
                f"tool.tilt = {tool.tilt:g} rad: only a tool of contact 'rigid_bonded' or, in finite strain, "
                f"{', '.join(TOUCHING)} can be tilted"
            )
        if tool.tilt != 0.0 and tool.adhesion_force > 0.0:
            raise FemError(
                f"tool.adhesion_force = {tool.adhesion_force:g} N: needs an upright tool; tool.tilt = {tool.tilt:g} rad"
            )
        if self.geometry == "block" and tool.position[1] != 0.0:
            raise FemError(
                f"tool.position = ({tool.position[0]:g}, {tool.position[1]:g}) m: must be (x, 0) with geometry = "
                "'block'; turn the specimen so that the tool stands off-centre along x"
            )
        self._require_surface()

    @property
    def touches(self) -> bool:
        """Whether the tool touches the tissue and comes off it, rather than being tied to it."""
        return self.tool.contact in TOUCHING and self.kinematics == "finite"

    def _require_surface(self) -> None:
        if (self.surface is None) == (self.geometry == "surface"):
            state = "missing" if self.surface is None else "given"
            raise FemError(f"surface is {state}: needed for geometry = 'surface', and only there")
        if self.geometry != "surface":
            return
        if self.support.kind != "bonded":
            raise FemError(f"support.kind = {self.support.kind!r}: geometry = 'surface' has the support 'bonded' only")
        if self.tool.tilt != 0.0:
            raise FemError(f"tool.tilt = {self.tool.tilt:g} rad: must be 0 with geometry = 'surface'")
        if self.touches:
            raise FemError(
                f"tool.contact = {self.tool.contact!r}: geometry = 'surface' has no tool that touches; "
                "use 'rigid_bonded' or 'uniform_pressure' there, or geometry = 'block'"
            )
