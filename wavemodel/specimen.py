"""What is pressed and with what: the layers of the specimen and the disc-shaped tool (SI units)."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError, require_between, require_not_negative, require_positive

SLIDING = ("rigid_frictionless", "rigid_frictional")
LEAST_FACE = 0.2
"""Radius of a flat face over that of its tool, at least."""
CONTACTS = ("uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional")

LEAST_TOOL = 1e-6
"""m, of a tool's radius. The memory of a wave goes as the stack's height over it: 3 GB for 1 um on 11.5 mm."""
LAW_MISFIT = 1e-3
"""A law's shear modulus at rest may differ by this share from that of its layer's moduli."""


class StrainEnergy(Protocol):
    """Shape-changing (isochoric) strain energy of a layer's material, at any points (...).

    Displacement gradients (5, ...) have the components rr, rz, zr, zz and the hoop, z down. The volumetric part is the
    wave's, K / 2 (J - 1)^2. Values that are not finite mean that the law has no answer there. Laws are compared and
    hashed with their layer: a frozen dataclass of numbers serves.
    """

    def energy(self, gradient: FloatArray) -> FloatArray:
        """(...) J/m3."""
        ...

    def stress(self, gradient: FloatArray) -> FloatArray:
        """(5, ...) first Piola-Kirchhoff stress, Pa."""
        ...

    def tangent(self, gradient: FloatArray) -> FloatArray:
        """(5, 5, ...) derivative of the stress by the gradient, Pa."""
        ...


@dataclass(frozen=True)
class WaveLayer:
    """One isotropic elastic layer; layers are listed from the surface down.

    Attributes
    ----------
    name
        Name under which its results appear.
    thickness
        In m.
    density
        In kg/m3.
    youngs_modulus
        In Pa.
    poisson_ratio
        Above -1 and below 0.5.
    law
        Energy at finite strain, whose stiffness at rest is that of the moduli; None: neo-Hookean. The layered waves
        follow it where they follow finite strain; what is of small strain or a plate theory takes the moduli only.

    Raises
    ------
    WaveError
        If a value is outside its range.
    """

    name: str
    thickness: float
    density: float
    youngs_modulus: float
    poisson_ratio: float
    law: StrainEnergy | None = None

    def __post_init__(self) -> None:
        where = f"layer {self.name!r}"
        require_positive(f"{where}: thickness", self.thickness, "m")
        require_positive(f"{where}: density", self.density, "kg/m3")
        require_positive(f"{where}: youngs_modulus", self.youngs_modulus, "Pa")
        if not -1.0 < self.poisson_ratio < 0.5:
            raise WaveError(f"{where}: poisson_ratio = {self.poisson_ratio:g} is not allowed: above -1 and below 0.5")
        if self.law is not None:
            self._require_stiffness(float(self.law.tangent(np.zeros((5, 1)))[1, 1, 0]), where)

    def _require_stiffness(self, at_rest: float, where: str) -> None:
        if not abs(at_rest / self.shear_modulus - 1.0) <= LAW_MISFIT:
            raise WaveError(
                f"{where}: law = {type(self.law).__name__} has a shear modulus of {at_rest:g} Pa at rest; "
                f"youngs_modulus and poisson_ratio give {self.shear_modulus:g} Pa, which it must be"
            )

    @property
    def shear_modulus(self) -> float:
        """G in Pa."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def lame_modulus(self) -> float:
        """Lame's first parameter in Pa."""
        return 2.0 * self.shear_modulus * self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio)


@dataclass(frozen=True)
class DiscTool:
    """A circular tool that presses with its flat face.

    Attributes
    ----------
    radius
        In m.
    contact
        "uniform_pressure", "rigid_bonded", "rigid_frictionless" or "rigid_frictional".
    edge_radius
        In m, zero for a sharp edge. What slides under a tool at finite strain slides over its edge.
    friction
        Coulomb's coefficient of "rigid_frictional", zero for any other contact.

    Raises
    ------
    WaveError
        If the radius is not positive or below `LEAST_TOOL`, the edge is larger, the friction negative or that of a
        contact without, or the contact none of these words.
    """

    radius: float
    contact: str = "uniform_pressure"
    edge_radius: float = 0.0
    friction: float = 0.0

    def __post_init__(self) -> None:
        require_positive("tool radius", self.radius, "m")
        if self.radius < LEAST_TOOL:
            raise WaveError(f"tool radius = {self.radius:g} m is not allowed: at least {LEAST_TOOL:g} m")
        require_between("tool", "edge_radius", self.edge_radius, "m", 0.0, self.radius)
        require_not_negative("tool friction", self.friction, "")
        if self.friction > 0.0 and self.contact != "rigid_frictional":
            raise WaveError(
                f"tool friction = {self.friction:g} is not allowed with {self.contact!r}: 'rigid_frictional'"
            )
        if self.contact not in CONTACTS:
            raise WaveError(f"tool contact = {self.contact!r} is not allowed: one of {', '.join(CONTACTS)}")

    @property
    def rigid(self) -> bool:
        """Whether the face under the tool moves as one."""
        return self.contact.startswith("rigid")

    @property
    def sticks(self) -> bool:
        """Whether tissue is glued to the face, and pulled by it."""
        return self.contact == "rigid_bonded"

    @property
    def slides(self) -> bool:
        """Whether the tissue slides under a flat face and over its rounded edge.

        A ball has no flat face: its depth goes with no power one of a small force.
        """
        return self.contact in SLIDING and 0.0 < self.edge_radius <= (1.0 - LEAST_FACE) * self.radius

    @property
    def at_first_touch(self) -> "DiscTool":
        """What a small press touches: the tool, or the flat face of one over whose edge the tissue slides."""
        return DiscTool(self.radius - self.edge_radius, "rigid_frictionless") if self.slides else self
