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
        (n, B) forces that the B fields of the static remainder answer to, N (the force as creep delays it).
    amplitude
        Step to (L, K): amplitudes of the top faces by wavenumber.
    elastic
        (n,) elastic forces that a large-press correction is read at, N; None where the body is linear.
    outward
        With inertia, step to (L + 1, K): amplitudes in plane of the top faces and the lowest one; None where they
        follow from the force.
    """

    force: FloatArray
    depth: FloatArray
    top_deflection: FloatArray
    static_force: FloatArray
    amplitude: Callable[[int], FloatArray]
    elastic: FloatArray | None = None
    outward: Callable[[int], FloatArray] | None = None
