"""Damping proportional to mass and stiffness."""

from dataclasses import dataclass

from wavemodel.errors import WaveError


@dataclass(frozen=True)
class Damping:
    """C = mass_rate M + stiffness_time K: M q'' + C q' + K q = f.

    Attributes
    ----------
    mass_rate
        In 1/s (Rayleigh's first term).
    stiffness_time
        In s; alone it makes every layer a Kelvin-Voigt solid of this retardation time.

    Raises
    ------
    WaveError
        If one is negative or not finite.
    """

    mass_rate: float = 0.0
    stiffness_time: float = 0.0

    def __post_init__(self) -> None:
        for name, value, unit in (
            ("mass_rate", self.mass_rate, "1/s"),
            ("stiffness_time", self.stiffness_time, "s"),
        ):
            if not 0.0 <= value < float("inf"):
                raise WaveError(f"damping {name} = {value:g} {unit} is not allowed: finite and not negative")
