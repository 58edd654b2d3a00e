"""The problem: whether its parts fit together is checked when it is made.

Nothing here computes; :func:`fem.prepare` turns a problem into a model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fem.errors import FemError, require_one_of
from fem.materials.fibres import require_fibre_symmetry
from fem.problem.parts import LARGEST_SHEAR_LIMIT, TOUCHING, Discretisation, Layer, Support, Tool

if TYPE_CHECKING:
    from fem.mesh.surface.surface_file import Surface

GEOMETRIES = ("axisymmetric", "block", "surface")
LARGEST_PRETENSION = 1e8  # Pa
BETWEEN_PLATES = ("rigid_bonded", "rigid_frictionless")


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
        self._require_plates()
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
        if self.support.clamp == "rim" and (radius is not None or self.geometry != "axisymmetric"):
            raise FemError(
                "support.clamp = 'rim': only with geometry = 'axisymmetric' and without discretisation.radius, since "
                "the sheet ends at the hole"
            )

    def _require_plates(self) -> None:
        """What a cylinder between two plates can be: it has no other border, and no plane to be stretched in."""
        tool, radius = self.tool, self.support.specimen_radius
        if radius is None:
            return
        if tool.contact not in BETWEEN_PLATES or tool.edge_radius is not None:
            raise FemError(
                f"tool.contact = {tool.contact!r}: between plates only {' or '.join(BETWEEN_PLATES)}, without "
                "tool.edge_radius: the plate covers the face"
            )
        if tool.radius < radius:
            raise FemError(
                f"tool.radius = {tool.radius:g} m: the plate must cover the specimen; must be at least "
                f"support.specimen_radius = {radius:g} m"
            )
        stated = {
            "geometry": self.geometry != "axisymmetric",
            "discretisation.radius": self.discretisation.radius is not None,
            "pretension": self.pretension != 0.0,
            "interface_shear_limit": self.interface_shear_limit is not None,
        }
        if any(stated.values()):
            names = ", ".join(name for name, given in stated.items() if given)
            raise FemError(f"support.kind = 'plates': only axisymmetric and without {names}; leave it out")

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
        return self.tool.contact in TOUCHING and self.kinematics == "finite" and self.support.kind != "plates"

    @property
    def is_stuck(self) -> bool:
        """Whether the surface is stuck, or kept level, up to a sharp edge."""
        return self.tool.contact != "uniform_pressure" and not self.slides_on_plates and not self.touches

    @property
    def slides_on_plates(self) -> bool:
        """Whether a cylinder's faces slide on the plates without friction."""
        return self.support.kind == "plates" and self.tool.contact == "rigid_frictionless"

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
