"""One frame of the deflected faces on a grid of vertices, from tables made beforehand."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import Tables
from wavemodel.layered.field import Field, ModalState
from wavemodel.layered.finite_strain.correction import FiniteStrainLaw

REMAINDER_RADII, LARGE_RADII = 512, 2048


@dataclass(frozen=True)
class Surface:
    """Vertices at all pairs of P positions x and Q positions y from the tool axis.

    A frame reuses the same memory: copy what must outlive the next call.

    Attributes
    ----------
    field
        The model's synthesis.
    modes
        Tables of the modes.
    remainder
        (P L, Q) deflection that the static remainder adds per force, m/N.
    creeping
        (B, P L, Q) that of each field of the remainder, where layers creep each in its own way; else of none.
    large
        (B, P L, Q) what each field of a finite-strain correction adds, m; of none without one.
    """

    field: Field
    modes: Tables
    remainder: FloatArray
    creeping: FloatArray
    large: FloatArray
    _memory: "_Memory"

    def frame(self, state: ModalState) -> FloatArray:
        """(L, P, Q) deflection of each layer's top face, m, downwards."""
        memory = self._memory
        beside = self.field.rest is not None
        if beside:
            if isinstance(state.remainder, np.ndarray) and state.remainder.ndim:
                np.dot(state.remainder, self.creeping.reshape(self.creeping.shape[0], -1), out=memory.out.reshape(-1))
            else:
                np.multiply(self.remainder, state.remainder, out=memory.out)
        self.modes.write(state.amplitude, memory.out, add=beside)
        if self.field.large is not None:
            weights = self.field.large.weights_at(state.elastic)
            np.dot(weights, self.large.reshape(weights.size, -1), out=memory.rest.reshape(-1))
            np.add(memory.out, memory.rest, out=memory.out)
        return memory.faces


@dataclass(frozen=True)
class _Memory:
    """Where a frame goes.

    Attributes
    ----------
    out, faces
        (P L, Q) result, and the same memory as (L, P, Q).
    rest
        (P L, Q) what finite strain adds.
    """

    out: FloatArray
    faces: FloatArray
    rest: FloatArray


def _memory(field: Field, layers: int, shape: tuple[int, int]) -> _Memory:
    out = np.empty((shape[0] * layers, shape[1]))
    return _Memory(
        out,
        out.reshape(shape[0], layers, shape[1]).transpose(1, 0, 2),
        np.empty_like(out) if field.large is not None else np.empty((0, 0)),
    )


def surface(field: Field, x: FloatArray, y: FloatArray, layers: int) -> Surface:
    """Prepare the tables for vertices at x (P,) and y (Q,), m from the tool axis.

    Raises
    ------
    WaveError
        If a vertex lies outside the window.
    """
    modes = field.domain.tables(x, y, layers)
    distance = np.hypot(x[:, None], y)
    return Surface(
        field,
        modes,
        _remainder(field, distance, lambda radius: field.remainder(radius, layers)[None])[0],
        _remainder(field, distance, field.remainders) if field.creeping else np.empty((0, 0, 0)),
        _large(field.large, distance) if field.large else np.empty((0, 0, 0)),
        _memory(field, layers, (x.size, y.size)),
    )


def _remainder(field: Field, distance: FloatArray, deflection: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """(B, P L, Q) by interpolation between radii that crowd towards the tool's edge."""
    if field.rest is None:
        fields, layers = deflection(np.zeros(1)).shape[:2]
        return np.zeros((fields, layers * distance.shape[0], distance.shape[1]))
    edge, reach = field.traction.basis.radius, field.rest.reach
    turn = np.linspace(0.0, 1.0, REMAINDER_RADII)
    radius = np.concatenate([edge * np.sin(0.5 * np.pi * turn), edge + (reach - edge) * turn[1:] ** 2])
    return _spread(deflection(radius), radius, distance)


def _large(correction: FiniteStrainLaw, distance: FloatArray) -> FloatArray:
    """(B, P L, Q) by interpolation between many radii."""
    radius = np.linspace(0.0, float(distance.max()), LARGE_RADII)
    return _spread(correction.at_radius(radius), radius, distance)


def _spread(values: FloatArray, radius: FloatArray, distance: FloatArray) -> FloatArray:
    """From (B, L, R) at radii to (B, P L, Q) at distances (P, Q)."""
    rows = [[np.interp(distance, radius, row, right=0.0) for row in field] for field in values]
    return np.stack([np.stack(field, axis=1) for field in rows]).reshape(len(rows), -1, distance.shape[1])
