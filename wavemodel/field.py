"""The deflection in space: from amplitudes of the modes and the static remainder to numbers at points."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.rectangle import Rectangle
from wavemodel.errors import WaveError
from wavemodel.loads.traction import Traction
from wavemodel.remainder import Remainder


@dataclass(frozen=True)
class Snapshot:
    """State of the wave at one instant.

    Attributes
    ----------
    amplitude
        (L, K) amplitude of each layer's top face by distinct wavenumber, m3: a mode's share of a centred unit load
        (1/m2) times it is the mode's deflection.
    remainder
        Force that the static remainder answers to, N.
    """

    amplitude: FloatArray
    remainder: float


@dataclass(frozen=True)
class Field:
    """Synthesis for one tool in the middle of one window.

    Attributes
    ----------
    domain
        Window and modes.
    traction
        Contact traction of unit force.
    rest
        Static remainder, or None where the modes carry the whole load.
    """

    domain: Rectangle
    traction: Traction
    rest: Remainder | None

    @cached_property
    def share(self) -> FloatArray:
        """(M, M) share of each mode in a centred unit load, 1/m2."""
        return self.domain.participation()

    def modal(self, amplitude: FloatArray) -> FloatArray:
        """(L, M, M) deflection of each mode, m: amplitudes (L, K)."""
        return self.domain.spread(amplitude) * self.share

    def remainder(self, radius: FloatArray, layers: int) -> FloatArray:
        """(L, R) deflection that the remainder adds per force at radii (R,), m/N."""
        if self.rest is None:
            return np.zeros((layers, radius.size))
        return self.rest.deflection(self.traction.coefficients, radius)

    def along_x(self, state: Snapshot, radius: FloatArray) -> FloatArray:
        """(L, R) deflection at radii (R,) along +x, m; NaN outside the window.

        Raises
        ------
        WaveError
            If a radius is negative or not a number.
        """
        if not np.all(radius >= 0.0):
            raise WaveError("profile: a radius that is negative or not a number is not allowed")
        inside = radius <= 0.5 * self.domain.width
        out = np.full((state.amplitude.shape[0], radius.size), np.nan)
        line = self.modal(state.amplitude) @ self.domain.sines(np.zeros(1), axis=1)[0]
        out[:, inside] = line @ self.domain.sines(radius[inside]).T
        out[:, inside] += state.remainder * self.remainder(radius[inside], out.shape[0])
        return out
