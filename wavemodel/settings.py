"""What the user of a layered wave may fix; what is None is found automatically."""

from dataclasses import dataclass
from math import isfinite

from wavemodel.errors import WaveError, require_positive
from wavemodel.physics.in_plane_stress import InPlaneStress

DOMAINS = ("rectangle", "disc")
FEWEST_FOR_CORRECTION = 8
"""With fewer modes the smooth part of a load, which the modes carry, would be next to nothing."""


@dataclass(frozen=True)
class Settings:
    """Set-up of a layered wave.

    Attributes
    ----------
    window
        Side of the square window, or diameter of the round one, m.
    modes
        N: m, n = 1..N, or as many along a radius of the disc.
    sublayers
        Number of equal sub-layers in each layer.
    static_correction
        Whether what the modes leave out of the load is answered statically. None: from 8 modes up.
    place
        (x, y) of the tool from the middle of the window, m.
    domain
        One of `DOMAINS`.
    pretension
        In-plane stress of the layers before the press; None: none.

    Raises
    ------
    WaveError
        If the domain is unknown, the window is not positive, a count is below one, or there are too few modes for the
        correction.
    """

    window: float | None = None
    modes: int | None = None
    sublayers: tuple[int, ...] | None = None
    static_correction: bool | None = None
    pretension: InPlaneStress | None = None
    place: tuple[float, float] = (0.0, 0.0)
    domain: str = "rectangle"

    def __post_init__(self) -> None:
        if self.domain not in DOMAINS:
            raise WaveError(f"domain = {self.domain!r} is not allowed: one of {', '.join(DOMAINS)}")
        if self.window is not None:
            require_positive("window", self.window, "m")
        if len(self.place) != 2 or not all(map(isfinite, self.place)):
            raise WaveError(f"place = {self.place} is not allowed: two finite lengths x and y, in m")
        if self.modes is not None and self.modes < 1:
            raise WaveError(f"modes = {self.modes} is not allowed: at least 1")
        if self.sublayers is not None and any(count < 1 for count in self.sublayers):
            raise WaveError(f"sublayers = {self.sublayers} is not allowed: at least 1 in each layer")
        if self.static_correction and self.modes is not None and self.modes < FEWEST_FOR_CORRECTION:
            raise WaveError(
                f"modes = {self.modes} is not allowed with the static correction: at least {FEWEST_FOR_CORRECTION}"
            )

    @property
    def corrected(self) -> bool:
        """Whether the static correction is on."""
        if self.static_correction is None:
            return self.modes is None or self.modes >= FEWEST_FOR_CORRECTION
        return self.static_correction
