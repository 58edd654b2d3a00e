"""Window and modes that follow the tool and the stack.

A window with zero border equals the endless specimen under loads of alternating sign at every multiple of its side
a, so what its border costs is read off the endless response g: near the border at most g(a/2), on the axis 4 g(a).
"""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.endless import endless
from wavemodel.layers.compliance import compliance, exact_faces
from wavemodel.layers.laminate import Laminate
from wavemodel.loads.uniform import uniform_pressure

BORDER_COST = 0.001
"""Of the peak, wherever the profile is printed; the contract is 0.005."""
PROFILE_RADII = 4.25
"""The window reaches at least this many tool radii to each side: the profile needs four."""
RESOLUTION = 12.0
"""Largest wavenumber of the modes times the tool's radius."""
FEWEST_MODES, MOST_MODES = 24, 512
REACH, SAMPLES = 8.0, 161
"""The far field is looked at over so many heights of the stack, at so many distances."""


def far_field(laminate: Laminate, radius: float, distance: FloatArray) -> FloatArray:
    """(L, R) deflection over each layer's peak at distances (R,) from the axis, for the endless specimen."""
    spectrum = endless(RESOLUTION / radius, float(distance[-1]) + radius)
    load = uniform_pressure(radius).transform(spectrum.wavenumber)
    answer = compliance(spectrum.wavenumber, laminate, exact_faces).respond(load)[..., 1].T
    answer = answer * np.exp(-((spectrum.wavenumber * radius / (0.5 * RESOLUTION)) ** 4))
    field = spectrum.at_radius(answer, np.concatenate([[0.0], distance]))
    relative: FloatArray = field[:, 1:] / field[:, :1]
    return relative


def automatic_window(laminate: Laminate, radius: float) -> float:
    """Side of the square window, m: the border costs at most `BORDER_COST` of the peak anywhere in it."""
    nearest = PROFILE_RADII * radius
    distance = np.linspace(nearest, nearest + REACH * laminate.height, SAMPLES)
    field = np.abs(far_field(laminate, radius, distance)).max(axis=0)
    at_border = _last_above(BORDER_COST, distance, field)
    on_axis = 0.5 * _last_above(BORDER_COST / 4.0, distance, field)
    return 2.0 * max(at_border, on_axis)


def border_cost(laminate: Laminate, radius: float, side: float) -> float:
    """What the border of a window (m) costs at most in it, over a layer's peak."""
    distance = np.linspace(0.5 * side, 0.5 * side + REACH * laminate.height, SAMPLES)
    field = np.abs(far_field(laminate, radius, distance)).max(axis=0)
    return float(max(field.max(), 4.0 * field[distance >= side].max(initial=0.0)))


def _last_above(level: float, distance: FloatArray, field: FloatArray) -> float:
    """First distance from which on the field stays below the level."""
    above = np.flatnonzero(field > level)
    return float(distance[min(above[-1] + 1, distance.size - 1)] if above.size else distance[0])


def enough_modes(side: float, radius: float) -> int:
    """N for a window (m) and a tool (m): the load's smooth part, up to k a = 12, fits below the cut-off."""
    return int(np.clip(np.ceil(RESOLUTION * side / (np.pi * radius)), FEWEST_MODES, MOST_MODES))
