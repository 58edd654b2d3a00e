"""The jump that cannot be linked: the whole grid moved by half a spacing or more between two pictures.

A regular grid that moves by a spacing looks nearly the same, with every marker in its neighbour's place. What gives
it away is its border: another shift than the small one explains more of the spots.
"""

from __future__ import annotations

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.markers.model import FloatArray
from bench_hw.vision.tracking.linking import GATE

_AGREE = 0.2
_LEAST_SHARE = 0.6


class JumpError(InputError):
    """The grid jumped too far to tell its markers apart."""


def rigid_jump(last: FloatArray, spots: FloatArray, spacing: float) -> FloatArray | None:
    """Find out whether the grid jumped.

    Parameters
    ----------
    last : ndarray, shape (m, 2)
        Where each marker was last seen.
    spots : ndarray, shape (k, 2)
        All that is seen now, each once, in the same units.
    spacing : float
        Distance of neighbours.

    Returns
    -------
    ndarray, shape (2,), or None
        The shift, at least half the spacing, if it explains more than half of the markers and more of them than
        any shorter one does; None otherwise.
    """
    if len(spots) < _LEAST_SHARE * len(last):
        return None
    shifts = (spots[:, None, :] - last[None, :, :]).reshape(-1, 2)
    apart = shifts[:, None, :] - shifts[None, :, :]
    agree = np.hypot(apart[:, :, 0], apart[:, :, 1]) < _AGREE * spacing
    pairs = agree.reshape(len(shifts), len(spots), len(last))
    agreeing = np.minimum(pairs.any(axis=2).sum(axis=1), pairs.any(axis=1).sum(axis=1))
    short = np.hypot(shifts[:, 0], shifts[:, 1]) < GATE * spacing
    best = int(np.argmax(agreeing))
    rival = int(agreeing[short].max()) if short.any() else 0
    if short[best] or agreeing[best] <= rival or agreeing[best] < _LEAST_SHARE * len(last):
        return None
    return np.asarray(np.median(shifts[agree[best]], axis=0))


def refuse_jump(last: FloatArray, spots: FloatArray, spacing: float) -> None:
    """Raise `JumpError` if the grid jumped."""
    shift = rigid_jump(last, spots, spacing)
    if shift is not None:
        raise JumpError(
            f"the whole grid jumped by ({shift[0]:.1f}, {shift[1]:.1f}) px since it was last seen, "
            f"{float(np.hypot(*shift)) / spacing:.2f} of the marker spacing: its markers cannot be told apart; "
            "allowed: less than half the spacing from picture to picture"
        )
