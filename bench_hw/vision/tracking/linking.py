"""Which of the spots seen now is which marker, and when that cannot be told.

Spots are assigned to where each marker was seen last (optimal assignment). The gate is just under half the spacing:
beyond that a spot could as well be the neighbour. There is no extrapolation of motion through gaps; where two markers
and spots compete, what the markers around did decides.

A regular grid that jumps by a spacing looks nearly the same, with every marker in its neighbour's place. What gives it
away is its border: another shift than the small one explains more of the spots. And while a marker is hidden the sheet
may move on by as much; so one that comes back must have moved, since it went, about as its neighbours have.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from bench_hw.errors import InputError
from bench_hw.vision.markers.grid import FloatArray, IntArray, Sighting

GATE = 0.49
"""Farthest a marker may be from where it was last seen, in spacings."""
_WITNESSES, _CARRIERS = 4, 8
"""Nearest markers whose usual way counts, and whose affine map does."""
AWAY = 0.25
"""Farthest a marker may go, from a picture to the next, from where its neighbours carry it, in spacings; a marker that
was lost, since it went."""
_FOLLOW = 0.25
"""How much of a picture is learned of how a marker usually differs from its neighbours."""
_ALLOWED, _SHARE, _SHARE_ASIDE, _ODD = np.array([0.05, 0.02]), 0.5, 1.0, 0.1
"""How far a marker may lie (spacings) and be drawn out (as `shapes` tell) otherwise than usual, as its neighbours show
it; besides, a share of what their strain has changed, more where they lie on one side. A marker that was drawn out by
more than the last number at first may become as the others."""
_AMID = 0.3
"""Farthest the middle of the neighbours may be from a marker, in spacings: else they lie on one side of it, and do not
judge its place."""
_LEAST_SPREAD = 0.5
"""Of the neighbours, in spacings squared, along either direction, for a strain to be told."""
_FORBIDDEN = 1e9
_AGREE = 0.2
_LEAST_SHARE = 0.6


def link(last: FloatArray, spots: FloatArray, gate: float) -> IntArray:
    """Assign spots to markers.

    Parameters
    ----------
    last : ndarray, shape (m, 2)
        Where each marker was last seen.
    spots : ndarray, shape (k, 2)
        What is seen now, in the same units.
    gate : float
        Longest way between the two.

    Returns
    -------
    ndarray of int, shape (m,)
        Number of each marker's spot, -1 for none.
    """
    result = np.full(len(last), -1, dtype=np.int64)
    if not len(last) or not len(spots):
        return result
    way = spots[None, :, :] - last[:, None, :]
    distance = np.hypot(way[:, :, 0], way[:, :, 1])
    allowed = distance < gate
    cost = np.where(allowed, _settled(last, way, distance, allowed), _FORBIDDEN)
    rows, columns = linear_sum_assignment(cost)
    good = allowed[rows, columns]
    result[rows[good]] = columns[good]
    return result


def _settled(last: FloatArray, way: FloatArray, distance: FloatArray, allowed: NDArray[np.bool_]) -> FloatArray:
    """The distances; in conflicts those left after the usual way of the nearest markers without one."""
    single = (allowed.sum(axis=1) == 1) & (allowed[:, allowed.sum(axis=0) == 1].any(axis=1))
    conflict = allowed.any(axis=1) & ~single
    if not conflict.any() or not single.any():
        return distance
    sure = np.flatnonzero(single)
    increments = way[sure, allowed[sure].argmax(axis=1)]
    result = distance.copy()
    for marker in np.flatnonzero(conflict):
        near = np.argsort(np.hypot(*(last[sure] - last[marker]).T))[:_WITNESSES]
        usual = np.median(increments[near], axis=0)
        left = way[marker] - usual
        result[marker] = np.hypot(left[:, 0], left[:, 1])
    return result


def doubles(places: FloatArray, starts: FloatArray, closest: float) -> NDArray[np.bool_]:
    """Find markers that were measured at the same place as another one.

    Parameters
    ----------
    places : ndarray, shape (m, 2)
        Where the markers were measured; NaN where not.
    starts : ndarray, shape (m, 2)
        Where each was seen last.
    closest : float
        Two markers cannot be closer than this.

    Returns
    -------
    ndarray of bool, shape (m,)
        Those that are not the one the place belongs to by `link`.
    """
    wrong = np.zeros(len(places), dtype=bool)
    seen = np.flatnonzero(np.isfinite(places).all(axis=1))
    gap = places[seen, None, :] - places[None, seen, :]
    close = np.hypot(gap[:, :, 0], gap[:, :, 1]) < closest
    if close.sum() == len(seen):
        return wrong
    taken = np.zeros(len(seen), dtype=bool)
    for index in np.flatnonzero(close.sum(axis=1) > 1):
        if not taken[index]:
            group = close[index]
            taken |= group
            members = seen[group]
            owner = link(starts[members], places[members][:1], np.inf)
            wrong[members[owner < 0]] = True
    return wrong


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
        The shift, beyond `GATE` of the spacing, if it explains `_LEAST_SHARE` of the markers or more, and more of
        them than any shorter one does; None otherwise.
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


class Neighbours:
    """Compares each marker with the affine map of the markers next to it.

    A sheet moves and strains smoothly. What has come in front of a marker, or has grown together with it, draws its
    outline out where the sheet is not drawn out, or goes another way.

    Parameters
    ----------
    rest : ndarray, shape (m, 2)
        Where the markers were at first, pixels.
    spacing : float
        Distance of neighbours, pixels.
    """

    def __init__(self, rest: FloatArray, spacing: float) -> None:
        self._rest, self._spacing = rest, spacing
        distance = np.hypot(*(rest[:, None] - rest[None]).transpose(2, 0, 1))
        self._near = np.argsort(distance, axis=1, kind="stable")[:, 1 : _CARRIERS + 1]
        arms = (rest[self._near] - rest[:, None]) / spacing
        self._amid = np.hypot(*arms.mean(axis=1).T) < _AMID
        self._columns = np.concatenate([np.ones((*arms.shape[:2], 1)), arms], axis=2)
        self._seen: NDArray[np.bool_] = np.zeros(0, dtype=bool)
        self._usual = np.full((len(rest), 7), np.nan)

    def _maps(self, ways: FloatArray) -> FloatArray:
        """Way (pixels) and its change per spacing along x and y, at each marker by its neighbours; (m, 3, 2)."""
        seen = np.isfinite(ways[:, 0])
        if not np.array_equal(seen, self._seen):
            columns = self._columns * seen[self._near, None]
            normal = columns.transpose(0, 2, 1) @ columns
            told = np.linalg.eigvalsh(normal)[:, 0] > _LEAST_SPREAD
            normal[~told] = np.eye(3)
            self._seen, self._solve = seen, np.linalg.solve(normal, columns.transpose(0, 2, 1))
            self._solve[~told] = np.nan
        return np.asarray(self._solve @ np.where(seen[:, None], ways, 0.0)[self._near])

    def strayed(self, pixels: FloatArray, last: FloatArray) -> NDArray[np.bool_]:
        """Tell which markers, now at `pixels` (m, 2), went from `last` another way than their neighbours did."""
        ways = pixels - last
        if not np.nanmax(np.abs(ways), initial=0.0) > 0.5 * AWAY * self._spacing:
            return np.zeros(len(ways), dtype=bool)
        usual = self._maps(ways)[:, 0]
        allowed = AWAY * self._spacing + _SHARE * np.hypot(usual[:, 0], usual[:, 1])
        return np.asarray(np.hypot(*(ways - usual).T) > allowed)

    def unlike(self, pixels: FloatArray, drawn: NDArray[np.complex128]) -> tuple[FloatArray, FloatArray]:
        """Compare with the usual difference from the neighbours.

        Parameters
        ----------
        pixels : ndarray, shape (m, 2)
            Where the markers are now; NaN where unseen.
        drawn : ndarray of complex, shape (m,)
            How their outlines are drawn out, as `shapes` tell it.

        Returns
        -------
        way, stretch : ndarray, shape (m,)
            How far each goes another way (pixels) and is drawn out otherwise, beyond what is allowed; 0 where nothing
            can be told.
        """
        ways = pixels - self._rest
        maps = self._maps(ways)
        now = np.concatenate([(ways - maps[:, 0]) / self._spacing, _strain(maps[:, 1:] / self._spacing)], axis=1)
        now[:, 2] = drawn.real - now[:, 4]
        now[:, 3] = drawn.imag - now[:, 5]
        change = now - self._usual
        square = change * change
        strain = np.where(self._amid, _SHARE, _SHARE_ASIDE) * np.sqrt(square[:, 4:].sum(axis=1))
        off = np.sqrt(square[:, :4].reshape(-1, 2, 2).sum(axis=2))
        beyond = off - _ALLOWED - strain[:, None]
        beyond[~self._amid, 0] = 0.0
        calm = ~(beyond > 0.0).any(axis=1)
        if not calm.all():
            calm |= self._as_others(now)
        beyond = np.where(calm[:, None] | ~(beyond > 0.0), 0.0, beyond)
        self._usual = np.where(calm[:, None] & np.isfinite(now), self._usual + _FOLLOW * change, self._usual)
        new = np.isnan(self._usual)
        if new.any():
            self._usual[new] = now[new]
        return beyond[:, 0] * self._spacing, beyond[:, 1]

    def _as_others(self, now: FloatArray) -> NDArray[np.bool_]:
        """Markers that were drawn out at first, by what touched them, and are now as the others: they begin anew."""
        usual = np.nanmedian(now[:, 2:4], axis=0)
        odd, here = (np.hypot(*(each[:, 2:4] - usual).T) for each in (self._usual, now))
        back = (odd > _ODD) & (here < _ALLOWED[1])
        self._usual[back] = now[back]
        return np.asarray(back)


def _strain(slope: FloatArray) -> FloatArray:
    """Two free columns, how discs are drawn out (as `shapes` tell it) and the log of the root of their area, (m, 5).

    Of displacement gradients (m, 2, 2), whose first index is the direction.
    """
    xx, xy, yx, yy = 1.0 + slope[:, 0, 0], slope[:, 1, 0], slope[:, 0, 1], 1.0 + slope[:, 1, 1]
    area = np.abs(xx * yy - xy * yx)
    left, right = xx * xx + xy * xy, yx * yx + yy * yy
    whole = left + right + 2.0 * area
    free = np.zeros_like(area)
    return np.stack([free, free, (left - right) / whole, 2.0 * (xx * yx + xy * yy) / whole, 0.5 * np.log(area)], axis=1)


class Absences:
    """Remembers, for each marker that is away, where all were when it went.

    Parameters
    ----------
    limit : float
        How far a marker's way may be from its neighbours' one, pixels.
    """

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._when_it_went: dict[int, FloatArray] = {}

    def checked(self, sighting: Sighting) -> Sighting:
        """Give a sighting without the markers that came back to a place that is not theirs."""
        seen = sighting.seen
        back = [marker for marker in self._when_it_went if seen[marker]]
        if not back:
            return sighting
        witnesses = self._witnesses(sighting)
        wrong = [marker for marker in back if not self._agrees(marker, sighting.pixels, witnesses)]
        chosen = np.ones(len(seen), dtype=bool)
        chosen[wrong] = False
        return sighting.kept(chosen & seen) if wrong else sighting

    def note(self, sighting: Sighting, last: FloatArray) -> None:
        """Take down who went and who is back; `last` (m, 2) is where each was seen last, pixels."""
        for marker, seen in enumerate(sighting.seen.tolist()):
            if seen:
                self._when_it_went.pop(marker, None)
            elif marker not in self._when_it_went:
                self._when_it_went[marker] = last.copy()

    def carried(self, sighting: Sighting, last: FloatArray) -> FloatArray:
        """Where each marker that is away would be now (m, 2), carried by the sheet as its neighbours show it.

        Of the others it is where they were seen last.
        """
        places = last.copy()
        witnesses = self._witnesses(sighting)
        for marker in self._when_it_went:
            if len(witnesses) >= _WITNESSES:
                places[marker] = self._expected(marker, sighting.pixels, witnesses)
        return places

    def _witnesses(self, sighting: Sighting) -> IntArray:
        seen = np.flatnonzero(sighting.seen).tolist()
        return np.array([marker for marker in seen if marker not in self._when_it_went], dtype=np.int64)

    def _agrees(self, marker: int, places: FloatArray, witnesses: IntArray) -> bool:
        """Whether it is where the nearest markers that were never away carried it; true if there are none."""
        if not len(witnesses):
            return True
        return bool(np.hypot(*(places[marker] - self._expected(marker, places, witnesses))) < self._limit)

    def _expected(self, marker: int, places: FloatArray, witnesses: IntArray) -> FloatArray:
        """Its place when it went, moved by the affine map of the nearest witnesses; of few, by their usual way."""
        before = self._when_it_went[marker]
        order = np.argsort(np.hypot(*(before[witnesses] - before[marker]).T))
        near = witnesses[order[:_CARRIERS]]
        usual = np.median((places - before)[near[:_WITNESSES]], axis=0)
        arms = before[near] - before[marker]
        if len(near) < _CARRIERS or np.linalg.svd(arms - arms.mean(axis=0), compute_uv=False)[1] < 0.5 * self._limit:
            return np.asarray(before[marker] + usual)
        columns = np.column_stack([np.ones(len(near)), arms])
        return np.asarray(before[marker] + np.linalg.lstsq(columns, (places - before)[near], rcond=None)[0][0])
