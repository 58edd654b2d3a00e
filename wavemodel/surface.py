"""One frame of the deflected faces on a grid of vertices: U = Sx A Sy' per layer, from tables made beforehand."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.field import Field, Snapshot

REMAINDER_RADII = 512


@dataclass(frozen=True)
class Surface:
    """Vertices at all pairs of P positions x and Q positions y from the tool axis.

    A frame reuses the same memory: copy what must outlive the next call.

    Attributes
    ----------
    field
        The model's synthesis.
    sines_x, sines_y
        (P, M) and (M, Q) tables.
    remainder
        (L, P, Q) deflection that the static remainder adds per force, m/N.
    """

    field: Field
    sines_x: FloatArray
    sines_y: FloatArray
    remainder: FloatArray
    _memory: "_Memory"

    def frame(self, state: Snapshot) -> FloatArray:
        """(L, P, Q) deflection of each layer's top face, m, downwards."""
        memory = self._memory
        memory.padded[:, :-1] = state.amplitude
        np.take(memory.padded, self.field.domain.pair_index, axis=1, out=memory.modal, mode="clip")
        np.multiply(memory.modal, self.field.share, out=memory.modal)
        np.matmul(self.sines_x, memory.modal, out=memory.half)
        np.matmul(memory.half, self.sines_y, out=memory.out)
        if self.field.rest is not None:
            np.multiply(self.remainder, state.remainder, out=memory.rest)
            np.add(memory.out, memory.rest, out=memory.out)
        return memory.out


@dataclass(frozen=True)
class _Memory:
    """Work arrays: amplitudes with a nought for modes not carried, modes, half-way sums, result, remainder."""

    padded: FloatArray
    modal: FloatArray
    half: FloatArray
    out: FloatArray
    rest: FloatArray


def surface(field: Field, x: FloatArray, y: FloatArray, layers: int) -> Surface:
    """Prepare the tables for vertices at x (P,) and y (Q,), m from the tool axis.

    Raises
    ------
    WaveError
        If a vertex lies outside the window.
    """
    for name, position, side in (("x", x, field.domain.width), ("y", y, field.domain.height)):
        if not np.all(np.abs(position) <= 0.5 * side):
            raise WaveError(
                f"surface: {name} reaches {np.abs(position).max() * 1e3:g} mm from the tool axis, outside the "
                f"window of {side * 1e3:g} mm (half of it to each side)"
            )
    count, kept = field.domain.order.size, field.domain.wavenumber.size
    memory = _Memory(
        np.zeros((layers, kept + 1)),
        np.empty((layers, count, count)),
        np.empty((layers, x.size, count)),
        np.empty((layers, x.size, y.size)),
        np.empty((layers, x.size, y.size)),
    )
    return Surface(
        field,
        field.domain.sines(x),
        np.ascontiguousarray(field.domain.sines(y, axis=1).T),
        _remainder(field, np.hypot(x[:, None], y), layers),
        memory,
    )


def _remainder(field: Field, distance: FloatArray, layers: int) -> FloatArray:
    """(L, P, Q) by interpolation between radii that crowd towards the tool's edge."""
    if field.rest is None:
        return np.zeros((layers, *distance.shape))
    edge, reach = field.traction.basis.radius, field.rest.reach
    turn = np.linspace(0.0, 1.0, REMAINDER_RADII)
    radius = np.concatenate([edge * np.sin(0.5 * np.pi * turn), edge + (reach - edge) * turn[1:] ** 2])
    values = field.remainder(radius, layers)
    return np.stack([np.interp(distance, radius, row, right=0.0) for row in values])
