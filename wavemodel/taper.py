"""How a load is shared between the wave's modes and the static remainder.

The load's smooth part, a share s(k) of its transform, is carried by the modes; the sharp rest, 1 - s(k), that no mode
of the window resolves, acts only close to the tool and is answered statically (`remainder`). s falls from one to zero
below the largest wavenumber of the modes, smoothly, so that the rest stays local.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import erfc

from wavemodel.arrays import FloatArray

CENTRE, WIDTH = 0.65, 0.14
LOCAL = 4.5
"""The remainder has decayed (by exp(-LOCAL^2 / 4), to below 1 %) LOCAL / (WIDTH limit) away from the tool."""


@dataclass(frozen=True)
class Taper:
    """Share of the modes.

    Attributes
    ----------
    limit
        Largest wavenumber carried by the modes along an axis, rad/m.
    active
        Where not, the modes carry all and there is no remainder.
    """

    limit: float
    active: bool = True

    def modes(self, wavenumber: FloatArray) -> FloatArray:
        """s(k), (n,) to (n,)."""
        if not self.active:
            return np.ones_like(wavenumber)
        share: FloatArray = 0.5 * erfc((wavenumber / self.limit - CENTRE) / WIDTH)
        return share

    def remainder(self, wavenumber: FloatArray) -> FloatArray:
        """1 - s(k), without loss of digits where it is small."""
        share: FloatArray = 0.5 * erfc((CENTRE - wavenumber / self.limit) / WIDTH)
        return share

    @property
    def locality(self) -> float:
        """How far beyond the tool's edge the remainder reaches, m."""
        return LOCAL / (WIDTH * self.limit)
