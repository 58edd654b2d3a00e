"""Which points touch and which are apart, which stick and which slide: the one active set of all interactions.

It is the primal-dual active set (M. Hintermueller, K. Ito and K. Kunisch, SIAM J. Optim. 13 (2002) 865): a trial force,
made of what holds a point and of where it is, decides.

Friction is Tresca's law, whose limit is given, with as little elastic stick as a consistent tangent needs (P. Wriggers,
Computational Contact Mechanics, 2nd ed., 2006, chapters 5 and 6); it keeps the stiffness symmetric. Coulomb's law is a
sequence of it, whose limit follows the pressure from one Newton run to the next. The limits of the next run come from
those of the last ones and what their pressures asked for (D. G. Anderson, Journal of the ACM 12 (1965) 547).

In two directions the friction of a point that slides turns with its slip. Its derivative is taken with the direction of
the multiplier beside that of the slip (T. F. Chan, G. H. Golub and P. Mulet, SIAM J. Sci. Comput. 20 (1999) 1964),
which keeps a slip from turning to and fro.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import BoolArray, FloatArray

GAP_SHARE = 1e-3  # of the penalty, by which a gap counts against a multiplier
SLIP_SHARE = 1e-5  # of the slip against the multiplier; larger ones make the slip turn to and fro
SETTLED = 1e-6  # change of all friction limits, over the press, that ends the runs of Coulomb's law
AT_THE_LIMIT = 1e-9
MIXED = 5
"""Earlier runs of Coulomb's law from which the next limits come; 3 and 8 took as many rounds to 2 %, 2 8 % more."""
MOST_GROWTH = 2.0  # of the misfit from one run to the next, beyond which the earlier ones tell nothing
LEAST_PART = 1e-8  # of the largest singular value of the misfits' changes; smaller ones are round-off


def in_touch(multiplier: FloatArray, gap: FloatArray) -> BoolArray:
    """Which points (m,) touch, of multipliers and gaps (m,) in m."""
    out: BoolArray = multiplier >= GAP_SHARE * gap
    return out


@dataclass(frozen=True)
class MultiplierDrag:
    """Friction of m points in t directions that multipliers hold.

    Attributes
    ----------
    force
        (t, m) in N against the slip.
    left
        What the multipliers' equations leave, (t, m) in N.
    sticks
        Which points (m,) stick.
    turning
        Derivative of the force of points that slide by their slip, (t, t, m) in N/m; None in one direction.
    """

    force: FloatArray
    left: FloatArray
    sticks: BoolArray
    turning: FloatArray | None


@dataclass(frozen=True)
class Friction:
    """Friction of m points, in one direction or in t of them, and where they rest.

    Attributes
    ----------
    stick
        Stiffness (m,) in N/m below the limit.
    limit
        Largest friction (m,) in N.
    anchor
        Path (m,) or (t, m) in m at which there is no friction.
    tried
        Limits (m,) of earlier runs of Coulomb's law for the same step, each with its misfit (m,) in N.
    """

    stick: FloatArray
    limit: FloatArray
    anchor: FloatArray
    tried: tuple[tuple[FloatArray, FloatArray], ...] = ()

    @property
    def present(self) -> bool:
        """Whether a point has a limit above zero."""
        return bool(self.limit.any())

    def drag(
        self, trial: FloatArray, sticking: FloatArray, stretch: FloatArray | float = 1.0
    ) -> tuple[FloatArray, BoolArray]:
        """Friction (m,) in N in one direction, and which points stick.

        Parameters
        ----------
        trial
            Trial force (m,) in N.
        sticking
            Friction (m,) in N of the points that stick.
        stretch
            Factor (m,) on the limit.
        """
        limit = self.limit * stretch
        sticks: BoolArray = np.abs(trial) <= limit
        return np.where(sticks, sticking, np.copysign(limit, trial)), sticks

    def multiplier_drag(self, multiplier: FloatArray, slid: FloatArray) -> MultiplierDrag:
        """Friction of points with multipliers and slip, (t, m) in m each: one that sticks has the multiplier = slip."""
        k = self.stick
        trial = k * (multiplier + SLIP_SHARE * (slid - multiplier))
        turning = None
        if len(slid) == 1:
            force, sticks = self.drag(trial[0], k * multiplier)
        else:
            sticks = np.hypot(*trial) <= self.limit
            sliding, turning = _in_the_plane(multiplier, slid, np.where(sticks, 0.0, self.limit), k)
            force = np.where(sticks, k * multiplier, sliding)
        left = np.where(sticks, k * (slid - multiplier), force - k * multiplier)
        return MultiplierDrag(force, left, sticks, turning)

    def after(self, path: FloatArray, elastic: FloatArray) -> Friction:
        """The same after a step that ends at a path with an elastic slip, shaped like the anchor, in m."""
        return replace(self, anchor=path - elastic, tried=())

    def led(self, path: FloatArray) -> Friction:
        """The same after a way in one direction from rest to a path (m,) or (t, m) in m."""
        most = self.limit / self.stick
        return self.after(path, np.clip(path - self.anchor, -most, most))

    def following(self, limit: FloatArray, press: float) -> Friction | None:
        """Coulomb's law: limits nearer to those (m,) in N of the pressure; None where these fit a press in N."""
        misfit = limit - self.limit
        size = float(np.abs(misfit).sum())
        if size <= SETTLED * press:
            return None
        grew = bool(self.tried) and size > MOST_GROWTH * float(np.abs(self.tried[-1][1]).sum())
        tried = (*(() if grew else self.tried[-MIXED:]), (self.limit, misfit))
        return replace(self, limit=_mixed(tried), tried=tried)

    def with_limit(self, limit: FloatArray) -> Friction:
        """With other limits (m,) in N, as they are before a first run."""
        return replace(self, limit=limit, tried=())

    def slides_everywhere(self, trial: FloatArray) -> bool:
        """Whether the trial force (m,) in N reaches the limit at all points."""
        return bool((np.abs(trial) >= (1.0 - AT_THE_LIMIT) * self.limit).all())


def _mixed(tried: tuple[tuple[FloatArray, FloatArray], ...]) -> FloatArray:
    """The limits (m,) in N without misfit, were it linear in them, from limits and misfits of some runs."""
    limits, misfits = (np.stack(each, axis=1) for each in zip(*tried, strict=True))
    changes = np.diff(misfits, axis=1)
    parts = np.linalg.lstsq(changes, misfits[:, -1], rcond=LEAST_PART)[0]
    found: FloatArray = limits[:, -1] + misfits[:, -1] - (np.diff(limits, axis=1) + changes) @ parts
    return np.maximum(found, 0.0)


def _in_the_plane(
    multiplier: FloatArray, slid: FloatArray, limit: FloatArray, k: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Friction (2, m) and its derivative (2, 2, m) of points that slide; zero where the limit is."""
    pull = k * (slid + multiplier)
    size, slides = np.hypot(*pull), limit > 0.0
    direction = np.where(slides, pull / np.where(slides, size, 1.0), 0.0)
    before = k * multiplier / np.where(slides, limit, 1.0)
    before = before / np.maximum(np.hypot(*before), 1.0)
    crossed = before[:, None] * direction
    turn = np.eye(2)[..., None] - 0.5 * (crossed + crossed.swapaxes(0, 1))
    return limit * direction, np.where(slides, limit * k / np.where(slides, size, 1.0), 0.0) * turn
