"""From a press to oscillators, and how much inertia matters for a load."""

import numpy as np

from wavemodel.integrators.inertial import ModalSystem
from wavemodel.integrators.load_history import Load
from wavemodel.integrators.viscoelastic import ELASTIC, Damping, Prony
from wavemodel.layered.press import Press
from wavemodel.layered.stack.vibration import vibration


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
