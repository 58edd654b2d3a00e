"""Free vibration of the stack at each wavenumber, K(k) phi = w^2 M phi; the oscillators of a press.

The problem is solved for 1 / w^2 with shapes of unit strain energy, so that the slow modes, and with them the static
answer, come out to full precision although the rates of a stack span eight decades.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.inertial import ModalSystem
from wavemodel.integrators.load_history import Load
from wavemodel.integrators.viscoelastic import ELASTIC, Damping, Prony
from wavemodel.layered.press import Press
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness


@dataclass(frozen=True)
class Vibration:
    """d modes at each of n wavenumbers.

    Attributes
    ----------
    frequency
        (n, d) angular, rad/s, falling.
    surface
        (n, d, 2) U and W of the surface in each shape (of unit strain energy: phi' K phi = 1).
    deflection
        (n, L, d) W of each layer's top face in each shape.
    outward
        (n, L + 1, d) U of each layer's top face and of the lowest one.
    """

    frequency: FloatArray
    surface: FloatArray
    deflection: FloatArray
    outward: FloatArray


def assemble(blocks: FloatArray, base: str) -> FloatArray:
    """Stack sub-layer matrices (..., S, 6, 6) to (..., d, d): per sub-layer top U, W and middle U, W."""
    count = blocks.shape[-3]
    size = 4 * count + 2
    out = np.zeros((*blocks.shape[:-3], size, size))
    for s in range(count):
        unknowns = np.array([0, 1, 4, 5, 2, 3]) + 4 * s
        out[..., unknowns[:, None], unknowns] += blocks[..., s, :, :]
    kept = size if base == "free" else size - 2
    return out[..., :kept, :kept]


def vibration(wavenumber: FloatArray, laminate: Laminate) -> Vibration:
    """Modes of the stack at wavenumbers (n,), rad/m."""
    stiffness = assemble(quadratic_stiffness(wavenumber, laminate), laminate.base)
    mass = assemble(consistent_mass(laminate), laminate.base)
    root = np.linalg.cholesky(stiffness)
    half = np.linalg.solve(root, np.broadcast_to(mass, stiffness.shape))
    scaled = np.linalg.solve(root, np.swapaxes(half, -1, -2))
    square, vectors = np.linalg.eigh(0.5 * (scaled + np.swapaxes(scaled, -1, -2)))
    floor = np.finfo(np.float64).tiny
    shapes = np.linalg.solve(np.swapaxes(root, -1, -2), vectors)
    return Vibration(
        frequency=1.0 / np.sqrt(np.maximum(square, floor)),
        surface=np.swapaxes(shapes[:, :2], -1, -2),
        deflection=shapes[:, 4 * laminate.top_of_layer + 1],
        outward=_outward(shapes, laminate),
    )


def _outward(shapes: FloatArray, laminate: Laminate) -> FloatArray:
    """(n, L + 1, d) of shapes (n, unknowns, d); the lowest face of a bonded stack does not move."""
    tops = shapes[:, 4 * laminate.top_of_layer]
    lowest = np.zeros_like(shapes[:, :1]) if laminate.base == "bonded" else shapes[:, 4 * laminate.sublayers :][:, :1]
    return np.concatenate([tops, lowest], axis=1)


def modal_system(press: Press, rigid: bool, damping: Damping, series: Prony = ELASTIC) -> ModalSystem:
    """The d oscillators of each of the K wavenumbers of a press, driven by its force.

    A state is scaled to its static value under unit force. The depth of a rigid tool is the mean of the surface's
    motion weighted by the contact traction.
    """
    modes = vibration(press.field.domain.wavenumber, press.modal_stack)
    drive = np.einsum("kdc,kc->kd", modes.surface, press.load)
    deflection, outward = (
        np.einsum("kld,kd,k->lkd", faces, drive, press.share) for faces in (modes.deflection, modes.outward)
    )
    weight = press.field.domain.axis_weight
    watched = drive**2 * press.share[:, None] if rigid else deflection[0]
    return ModalSystem(
        frequency=modes.frequency,
        deflection=deflection,
        outward=outward,
        axis_weight=weight,
        depth=watched * weight[:, None],
        remainder_depth=press.remainder_depth,
        remainder_axis=press.remainder_axis,
        collocated=rigid,
        damping=damping,
        series=series,
    )


def first_frequency(press: Press) -> float:
    """Lowest natural frequency of the carried modes, Hz, among two dozen of the wavenumbers."""
    k = press.field.domain.wavenumber
    chosen = np.unique(np.geomspace(1, k.size, 24).astype(np.intp)) - 1
    return float(vibration(k[chosen], press.modal_stack.at(chosen)).frequency.min() / (2.0 * np.pi))


def ringing(load: Load, frequency: float, damping: Damping) -> float:
    """About how much inertia adds to a press, over its peak.

    A ramp that lasts t leaves its static answer ringing with the amplitude 1 / (w t): the largest change of the load
    within one period, over 2 pi. Drag proportional to mass makes the answer lag by mass_rate / w^2. Noise of a
    measured load counts by its size, not by its slope.

    Parameters
    ----------
    load
        The history.
    frequency
        First natural frequency, Hz.
    damping
        Its mass-proportional part counts.
    """
    peak = float(np.abs(load.value).max())
    if peak == 0.0:
        return 0.0
    time, value = load.line
    beside = np.interp(np.array([[1.0], [-1.0]]) / frequency + time, time, value)
    change = float(np.abs(beside - value).max())
    return (1.0 + damping.mass_rate / (2.0 * np.pi * frequency)) * change / (2.0 * np.pi * peak)
