"""The deflection in space: from amplitudes of the modes and the static remainder to numbers at points."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import WaveDomain
from wavemodel.layered.finite_strain.correction import FiniteStrainLaw
from wavemodel.layered.remainder import Remainder, deflections
from wavemodel.layered.tractions import Traction


@dataclass(frozen=True)
class ModalState:
    """State of the wave at one instant.

    Attributes
    ----------
    amplitude
        (L, K) amplitude of each layer's top face by distinct wavenumber, m3: a mode's share of a centred unit load
        (1/m2) times it is the mode's deflection.
    remainder
        Force that the static remainder answers to, N; with layers that creep each in its own way (B,) forces, one
        for each of its fields.
    elastic
        Elastic force that the finite-strain correction is read at, N.
    """

    amplitude: FloatArray
    remainder: float | FloatArray
    elastic: float = 0.0


@dataclass(frozen=True)
class Field:
    """Synthesis for one tool in one window.

    Attributes
    ----------
    domain
        Window and modes.
    traction
        Contact traction of unit force.
    rest
        Static remainder by the initial moduli, or None where the modes carry the whole load.
    creeping
        With layers that creep each in its own way the B fields of the remainder.
    large
        What finite strain adds, or None.
    """

    domain: WaveDomain
    traction: Traction
    rest: Remainder | None
    creeping: tuple[Remainder, ...] = ()
    large: FiniteStrainLaw | None = None

    def remainder(self, radius: FloatArray, layers: int) -> FloatArray:
        """(L, R) deflection that the remainder adds per force at radii (R,), m/N."""
        if self.rest is None:
            return np.zeros((layers, radius.size))
        return self.rest.deflection(self.traction.coefficients, radius)

    def remainders(self, radius: FloatArray) -> FloatArray:
        """(B, L, R) deflection that each field of the remainder adds per force at radii (R,), m/N."""
        return deflections(self.creeping, self.traction.coefficients, radius)

    def _sharp(self, state: ModalState, radius: FloatArray, layers: int) -> FloatArray:
        if np.ndim(state.remainder) == 0:
            return np.asarray(state.remainder * self.remainder(radius, layers))
        if self.rest is None:
            return np.zeros((layers, radius.size))
        return np.asarray(np.tensordot(state.remainder, self.remainders(radius), axes=1))

    def along_x(self, state: ModalState, radius: FloatArray) -> FloatArray:
        """(L, R) deflection at radii (R,) along +x, m; NaN outside the window."""
        points = np.stack([radius, np.zeros_like(radius)], axis=1)
        inside = self.domain.holds(points)
        out = np.full((state.amplitude.shape[0], radius.size), np.nan)
        out[:, inside] = self.domain.at(state.amplitude, points[inside])
        out[:, inside] += self._sharp(state, radius[inside], out.shape[0])
        if self.large is not None:
            weights = self.large.weights_at(state.elastic)
            out[:, inside] += np.tensordot(weights, self.large.at_radius(radius[inside]), axes=1)
        return out
