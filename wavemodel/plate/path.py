"""The sheet's equilibrium from rest to a load: Newton's method along a path whose steps halve where it fails."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.plate.sheet import Sheet

CORRECTIONS = 14
TOLERANCE = 1e-9
"""Of the sheet's thickness: largest correction of a coefficient that counts as none."""
FINEST_STEP = 1.0 / 256.0


@dataclass(frozen=True)
class Equilibrium:
    """One state at rest.

    Attributes
    ----------
    load
        What is prescribed: depth of a rigid tool (m), or force of a pressure (N).
    state
        Unknowns of the sheet.
    """

    load: float
    state: FloatArray


def follow(sheet: Sheet, start: tuple[Equilibrium, ...], loads: FloatArray) -> tuple[Equilibrium, ...]:
    """Equilibria at rising loads, from the last ones of a path on; stops early where none is found.

    Parameters
    ----------
    sheet
        The sheet.
    start
        What is known, at least the state at rest.
    loads
        (n,) above the last of `start`.
    """
    found = list(start)
    for target in loads.tolist():
        step = target - found[-1].load
        finest = FINEST_STEP * step
        trail = found[-2:]
        while trail[-1].load < target:
            load = min(target, trail[-1].load + step)
            state = _solve(sheet, load, _predict(trail, load))
            if state is not None:
                trail = [trail[-1], Equilibrium(load, state)]
            elif step <= finest:
                return tuple(found)
            else:
                step *= 0.5
        found.append(trail[-1])
    return tuple(found)


def _predict(trail: list[Equilibrium], load: float) -> FloatArray:
    """Straight on through the last two states."""
    last = trail[-1]
    if len(trail) == 1 or trail[0].load == last.load:
        return last.state
    share = (load - last.load) / (last.load - trail[0].load)
    return last.state + share * (last.state - trail[0].state)


def _solve(sheet: Sheet, load: float, state: FloatArray) -> FloatArray | None:
    """Newton's method; None where it does not converge."""
    depth, force = (load, 0.0) if sheet.tool is not None else (0.0, load)
    small = TOLERANCE * sheet.section.thickness
    for _ in range(CORRECTIONS):
        with np.errstate(all="ignore"):
            residual, jacobian = sheet.residual(state, depth, force)
        if not np.isfinite(jacobian).all():
            return None
        scale = 1.0 / np.sqrt(np.abs(jacobian).max(axis=1))
        change = -scale * np.linalg.solve(jacobian * np.outer(scale, scale), residual * scale)
        state = state + change
        if np.abs(change[: sheet.functions.unknowns]).max() < small:
            return state
    return None
