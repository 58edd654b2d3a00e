"""What an integrator hands back."""

from collections.abc import Callable
from dataclasses import dataclass

from wavemodel.arrays import FloatArray


@dataclass(frozen=True)
class History:
    """A run over n steps.

    Attributes
    ----------
    force, depth
        (n,) in N and m.
    top_deflection
        (n, L) in m: each layer's top face on the axis.
    static_force
        (n,) force that the static remainder answers to, N (the lagged force with Kelvin-Voigt damping).
    amplitude
        Step to (L, K): amplitudes of the top faces by wavenumber.
    """

    force: FloatArray
    depth: FloatArray
    top_deflection: FloatArray
    static_force: FloatArray
    amplitude: Callable[[int], FloatArray]
