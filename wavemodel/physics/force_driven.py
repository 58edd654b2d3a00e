"""A press driven by force: at each instant the depth at which the body with its options answers with that force."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.load import Load, checked_load
from wavemodel.physics.body import Physics
from wavemodel.physics.quasi_static_press import ForceLaw, PressState, QuasiStaticPress, Trace, joined

WIDENINGS = 60
EXACT = 1e-13
"""Of the force, and of the depth (relatively), to which a step is solved."""


def driven(load: Load, law: ForceLaw, physics: Physics, scale: float) -> Trace:
    """Go through a load history, of force or depth, on an elastic law with options; see `drive_by_force`."""
    press = QuasiStaticPress(law, physics)
    if load.control == "force":
        return drive_by_force(press, load.time, load.value, scale)
    return press.trace(load.time, load.value)


def drive_by_force(press: QuasiStaticPress, time: FloatArray, force: FloatArray, scale: float) -> Trace:
    """Go through a history of force; the tool rests on the tissue all the time, also without force.

    Each step is solved for by bracketing, the options' memories being carried from step to step: about a millisecond
    a step.

    Parameters
    ----------
    press
        The body.
    time, force
        (n,) in s and N; see `QuasiStaticPress.force`.
    scale
        About the depth of the press, m: the search begins with a thousandth of it.

    Raises
    ------
    WaveError
        If the history is not usable, pulls more than adhesion holds, or asks for more than the law's range gives.
    """
    load = checked_load("force", time, force)
    _check_pull(press, load.value)
    state, depth, move, pieces = press.rest(), 0.0, 1e-3 * scale, []
    for duration, value in zip(load.durations, load.value.tolist(), strict=True):
        trace, state = _step(press, np.array([duration]), value, state, (depth, move))
        move = max(abs(float(trace.depth[0]) - depth), 1e-3 * scale)
        depth = float(trace.depth[0])
        pieces.append(trace)
    return joined(pieces)


def _check_pull(press: QuasiStaticPress, force: FloatArray) -> None:
    held = press.physics.adhesion.force if press.physics.adhesion else 0.0
    if force.min() < -held:
        at = int(force.argmin())
        raise WaveError(
            f"load: value[{at}] = {force[at]:g} N is not allowed: the tissue can be pulled by no more than its "
            f"adhesion, {held:g} N"
        )


def _step(
    press: QuasiStaticPress, duration: FloatArray, force: float, state: PressState, near: tuple[float, float]
) -> tuple[Trace, PressState]:
    def excess(depth: float) -> float:
        return float(press.follow(duration, np.array([depth]), state, held=True)[0].force[0]) - force

    low, high = _bracket(excess, *near)
    depth = low if low == high else brentq(excess, low, high, xtol=EXACT * (abs(low) + near[1]), rtol=1e-14)
    return press.follow(duration, np.array([depth]), state, held=True)


def _bracket(excess: Callable[[float], float], depth: float, move: float) -> tuple[float, float]:
    """Two depths between which the force comes to its value; twice the same where it is already there."""
    here = excess(depth)
    if here == 0.0:
        return depth, depth
    towards, step, before = -np.sign(here), 1.25 * move, depth
    for _ in range(WIDENINGS):
        after = before + towards * step
        if excess(after) * here <= 0.0:
            return min(before, after), max(before, after)
        before, step = after, 2.0 * step
    raise WaveError(f"force: no depth between {depth * 1e3:g} mm and {before * 1e3:g} mm answers with it")
