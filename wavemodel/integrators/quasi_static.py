"""Presses that are slow against the first frequency: inertia left out, damping by stiffness kept.

Every mode is then in the same state, x(t) times its static answer, with eta x' + x = F; the whole history is one
scalar. The first frequency of skin on a base is a few hundred hertz, a press takes seconds.
"""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.history import History
from wavemodel.integrators.lag import lagged
from wavemodel.integrators.load import Load


def quasi_static(load: Load, unit: FloatArray, unit_axis: FloatArray, compliance: float, lag: float) -> History:
    """Run a load history without inertia.

    Parameters
    ----------
    load
        Force or depth over time.
    unit
        (L, K) static amplitudes per unit force.
    unit_axis
        (L,) static deflection of each layer's top face on the axis per unit force, m/N.
    compliance
        Depth per force, m/N.
    lag
        Kelvin-Voigt retardation time, s.
    """
    if load.control == "force":
        force = load.value
        static = lagged(load.durations, force, lag)
    else:
        static = load.value / compliance
        force = static + lag * load.rates / compliance

    def amplitude(step: int) -> FloatArray:
        return np.asarray(unit * static[step])

    return History(force, static * compliance, np.outer(static, unit_axis), static, amplitude)
