"""Friction of nodes on a rigid punch in one or two directions, with a given limit.

It is Coulomb's law with as little elastic stick and a multiplier x for each direction (P. Wriggers, Computational
Contact Mechanics, 2nd ed., 2006, chapters 5 and 6); a limit that is given (Tresca's law) keeps the stiffness symmetric.
A node that sticks has k x = k slid; one that slides has the limit against its slip.

In two directions the friction of a node that slides turns with its slip. Its derivative is taken with the direction of
the multiplier beside that of the slip (T. F. Chan, G. H. Golub and P. Mulet, SIAM J. Sci. Comput. 20 (1999) 1964),
which keeps a slip from turning to and fro.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import BoolArray, FloatArray

TURN = 1e-5  # of the slip against the multiplier; larger ones make the slip turn to and fro


@dataclass(frozen=True)
class Rub:
    """Friction of m nodes in t directions.

    Attributes
    ----------
    drag
        Force (t, m) in N against the slip.
    left
        What the multipliers' equations leave, (t, m) in N.
    sticks
        Which nodes (m,) stick.
    turning
        Derivative of the drag of nodes that slide by their slip, (t, t, m) in N/m; None in one direction.
    """

    drag: FloatArray
    left: FloatArray
    sticks: BoolArray
    turning: FloatArray | None


def rub(drawn: FloatArray, slid: FloatArray, limit: FloatArray, k: FloatArray) -> Rub:
    """Friction with multipliers and slip (t, m) in m, limits (m,) in N and stiffness k (m,) in N/m."""
    trial = k * (drawn + TURN * (slid - drawn))
    if len(slid) == 1:
        sticks = np.abs(trial[0]) <= limit
        sliding, turning = np.clip(trial, -limit, limit), None
    else:
        sticks = np.hypot(*trial) <= limit
        sliding, turning = _in_the_plane(drawn, slid, np.where(sticks, 0.0, limit), k)
    drag = np.where(sticks, k * drawn, sliding)
    left = np.where(sticks, k * (slid - drawn), drag - k * drawn)
    return Rub(drag, left, sticks, turning)


def _in_the_plane(
    drawn: FloatArray, slid: FloatArray, limit: FloatArray, k: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Drag (2, m) and its derivative (2, 2, m) of nodes that slide; zero where the limit is."""
    pull = k * (slid + drawn)
    size, slides = np.hypot(*pull), limit > 0.0
    direction = np.where(slides, pull / np.where(slides, size, 1.0), 0.0)
    before = k * drawn / np.where(slides, limit, 1.0)
    before = before / np.maximum(np.hypot(*before), 1.0)
    crossed = before[:, None] * direction
    turn = np.eye(2)[..., None] - 0.5 * (crossed + crossed.swapaxes(0, 1))
    return limit * direction, np.where(slides, limit * k / np.where(slides, size, 1.0), 0.0) * turn
