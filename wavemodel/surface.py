"""One frame of the deflected faces on a grid of vertices: U = Sx A Sy' per layer, from tables made beforehand."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.field import Field, Snapshot
from wavemodel.large_press.law import LargePress

REMAINDER_RADII, LARGE_RADII = 512, 2048


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
    fading
        (B, L, P, Q) that of each field of the remainder, where layers creep each in its own way; else of none.
    large
        (B, L, P, Q) what each field of a large-press correction adds, m; of none without one.
    """

    field: Field
    sines_x: FloatArray
    sines_y: FloatArray
    remainder: FloatArray
    fading: FloatArray
    large: FloatArray
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
            scalar = np.ndim(state.remainder) == 0
            if scalar:
                np.multiply(self.remainder, state.remainder, out=memory.rest)
            else:
                np.dot(state.remainder, self.fading.reshape(self.fading.shape[0], -1), out=memory.rest.reshape(-1))
            np.add(memory.out, memory.rest, out=memory.out)
        if self.field.large is not None:
            weights = self.field.large.weights_at(state.elastic)
            np.dot(weights, self.large.reshape(weights.size, -1), out=memory.rest.reshape(-1))
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
    domain = field.domain
    for axis, name, position, side in ((0, "x", x, domain.width), (1, "y", y, domain.height)):
        if not domain.inside(position, axis).all():
            place = f" of a point {-domain.place[axis] * 1e3:g} mm from it" if any(domain.place) else ""
            raise WaveError(
                f"surface: {name} reaches {np.abs(position).max() * 1e3:g} mm from the tool axis, outside the "
                f"window of {side * 1e3:g} mm (half of it to each side{place})"
            )
    count, kept = field.domain.order.size, field.domain.wavenumber.size
    memory = _Memory(
        np.zeros((layers, kept + 1)),
        np.empty((layers, count, count)),
        np.empty((layers, x.size, count)),
        np.empty((layers, x.size, y.size)),
        np.empty((layers, x.size, y.size)),
    )
    distance = np.hypot(x[:, None], y)
    return Surface(
        field,
        field.domain.sines(x),
        np.ascontiguousarray(field.domain.sines(y, axis=1).T),
        _remainder(field, distance, lambda radius: field.remainder(radius, layers)[None])[0],
        _remainder(field, distance, field.remainders) if field.fading else np.empty((0, layers, 0, 0)),
        _large(field.large, distance) if field.large else np.empty((0, layers, 0, 0)),
        memory,
    )


def _remainder(field: Field, distance: FloatArray, deflection: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """(B, L, P, Q) by interpolation between radii that crowd towards the tool's edge."""
    if field.rest is None:
        return np.zeros((*deflection(np.zeros(1)).shape[:2], *distance.shape))
    edge, reach = field.traction.basis.radius, field.rest.reach
    turn = np.linspace(0.0, 1.0, REMAINDER_RADII)
    radius = np.concatenate([edge * np.sin(0.5 * np.pi * turn), edge + (reach - edge) * turn[1:] ** 2])
    return _spread(deflection(radius), radius, distance)


def _large(correction: LargePress, distance: FloatArray) -> FloatArray:
    """(B, L, P, Q) by interpolation between many radii."""
    radius = np.linspace(0.0, float(distance.max()), LARGE_RADII)
    return _spread(correction.at_radius(radius), radius, distance)


def _spread(values: FloatArray, radius: FloatArray, distance: FloatArray) -> FloatArray:
    """From (B, L, R) at radii to (B, L, P, Q) at distances."""
    rows = [np.interp(distance, radius, row, right=0.0) for row in values.reshape(-1, radius.size)]
    return np.stack(rows).reshape(*values.shape[:2], *distance.shape)
