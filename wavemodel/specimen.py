"""What is pressed and with what: the layers of the specimen and the disc-shaped tool (SI units)."""

from dataclasses import dataclass

from wavemodel.errors import WaveError, require_positive

CONTACTS = ("uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional")


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

    def __post_init__(self) -> None:
        where = f"layer {self.name!r}"
        require_positive(f"{where}: thickness", self.thickness, "m")
        require_positive(f"{where}: density", self.density, "kg/m3")
        require_positive(f"{where}: youngs_modulus", self.youngs_modulus, "Pa")
        if not -1.0 < self.poisson_ratio < 0.5:
            raise WaveError(f"{where}: poisson_ratio = {self.poisson_ratio:g} is not allowed: above -1 and below 0.5")

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

    Raises
    ------
    WaveError
        If the radius is not positive or the contact is none of these words.
    """

    radius: float
    contact: str = "uniform_pressure"

    def __post_init__(self) -> None:
        require_positive("tool radius", self.radius, "m")
        if self.contact not in CONTACTS:
            raise WaveError(f"tool contact = {self.contact!r} is not allowed: one of {', '.join(CONTACTS)}")

    @property
    def rigid(self) -> bool:
        """Whether the face under the tool moves as one."""
        return self.contact.startswith("rigid")
