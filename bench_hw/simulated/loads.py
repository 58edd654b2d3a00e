"""Loads and motions for a device that is simulated on its own, without a bench around it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bench_hw.simulated.specimen import FloatArray, SheetSpecimen

PERIOD = 4.0
"""Period of the slow swing, s."""


def swinging(peak: float) -> Callable[[FloatArray], FloatArray]:
    """Give a press force that swings between 0 and `peak` (N) every four seconds; instants (n,) to (n, 3)."""

    def load(instants: FloatArray) -> FloatArray:
        force = np.zeros((len(instants), 3))
        force[:, 2] = peak * _swing(instants)
        return force

    return load


def pressed_sheet(depth: float = 2e-3) -> Callable[[float], FloatArray]:
    """Give the markers (m, 3), m, of a sheet pressed between 0 and `depth` (m) every four seconds."""
    specimen = SheetSpecimen()

    def markers(time: float) -> FloatArray:
        instants = np.array([time])
        answer: FloatArray = specimen(instants, depth * _swing(instants), 0).markers[0]
        return answer

    return markers


def _swing(instants: FloatArray) -> FloatArray:
    return np.asarray(0.5 - 0.5 * np.cos(2.0 * np.pi / PERIOD * instants))
