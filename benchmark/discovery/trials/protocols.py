"""Trials of a condition by the motion they share: segments made alike, protocols taken apart, odd trials set aside."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.rows import RawTrial
from benchmark.discovery.trials.segments import Segment, without_dwells
from benchmark.errors import InputError
from benchmark.files.sessions.proposal import JUMP_ROWS, Motion, motion_of
from benchmark.files.sessions.specimens import ONE_HEIGHT, gap_at_zero_depth


def by_protocol(name: str, group: Sequence[RawTrial], warnings: list[str]) -> list[list[RawTrial]]:
    """The trials of a condition by the motion they share, their segments alike; single odd ones are set aside.

    Usually that is one list. Where a condition holds several protocols, each of at least two trials, each becomes a
    condition of its own, named after the old one and its motion.

    Parameters
    ----------
    name
        Of the session, for messages.
    group
        At least one trial, of one condition.
    warnings
        Who was set aside, and what was taken apart, is added here.

    Raises
    ------
    InputError
        More than single trials have a motion that no other trial has.
    """
    told = group[0].trial.condition
    kept = _alike(group, most_odd(len(group)))
    if kept:
        _tell_left(told, group, kept, warnings)
        return [kept]
    apart = _apart(group)
    if not apart:
        raise InputError(
            f"session {name}, condition {told}: trials of different protocols ({len(group)} trials; "
            f"{_Extent.of(group)}); give each protocol, of at least two trials, a condition of its own."
        )
    parts = ", ".join(f"{each[0].trial.condition} ({len(each)} trials)" for each in apart)
    warnings.append(f"condition {told}: its trials are of several protocols, and taken for {parts}")
    _tell_left(told, group, [raw for each in apart for raw in each], warnings)
    return apart


def by_height(group: Sequence[RawTrial], warnings: list[str]) -> list[Sequence[RawTrial]]:
    """The trials of a condition by their specimens' heights, where these fall apart and each has at least two trials.

    Each height then becomes a condition of its own, since its base is another.
    """
    heights = np.array([_height(raw) for raw in group])
    if not np.isfinite(heights).all() or heights.max() <= ONE_HEIGHT * heights.min():
        return [group]
    told, ranked = group[0].trial.condition, np.sort(heights)
    first = np.append(-np.inf, ranked[1:][ranked[1:] > ONE_HEIGHT * ranked[:-1]])
    numbers = np.searchsorted(first, heights, side="right")
    if first.size == 1 or min(np.count_nonzero(numbers == number) for number in numbers) == 1:
        span = f"{1e3 * ranked[0]:.4g} to {1e3 * ranked[-1]:.4g} mm"
        warnings.append(f"condition {told}: its specimens are {span} high, and all held against one base")
        return [group]
    apart = []
    for number in range(1, first.size + 1):
        name = f"{1e3 * float(np.median(heights[numbers == number])):.4g}mm"
        apart.append([_renamed(raw, name) for raw, own in zip(group, numbers, strict=True) if own == number])
    listed = ", ".join(f"{each[0].trial.condition} ({len(each)} trials)" for each in apart)
    warnings.append(f"condition {told}: its specimens are of several heights, and taken for {listed}")
    return [*apart]


def _alike(group: Sequence[RawTrial], most: float) -> list[RawTrial]:
    """The trials with the motion of most, their segments made alike; none if more than `most` have another."""
    alike = _with_like_rests(_with_like_dwells(group))
    usual = Counter(_kinds(raw) for raw in alike).most_common(1)[0][0]
    model = next(raw for raw in alike if _kinds(raw) == usual)
    timed = [raw if _kinds(raw) == usual else _timed_like(raw, model) for raw in alike]
    kept = [raw for raw in timed if raw is not None]
    extent = _Extent.of(kept)
    if extent.wide:
        kept = [raw for raw, odd in zip(kept, extent.odd, strict=True) if not odd]
    return [] if len(group) - len(kept) > most or _Extent.of(kept).wide else kept


def _apart(group: Sequence[RawTrial]) -> list[list[RawTrial]]:
    """Two or more trials a motion, each in a condition of its own; none where that leaves out more than single ones."""
    motions: list[tuple[Motion, list[RawTrial]]] = []
    for raw in group:
        motion = motion_of(raw.trial.table, by_force=raw.by_force)
        mates = next((mates for other, mates in motions if other.alike(motion)), None)
        if mates is None:
            motions.append((motion, [raw]))
        else:
            mates.append(raw)
    shared = [(motion, _alike(mates, 0.0)) for motion, mates in motions if len(mates) > 1]
    kept = [(motion, mates) for motion, mates in shared if mates]
    if len(group) - sum(len(mates) for _, mates in kept) > most_odd(len(group)):
        return []
    return [[_renamed(raw, motion.name) for raw in mates] for motion, mates in kept]


def _renamed(raw: RawTrial, motion: str) -> RawTrial:
    return replace(raw, trial=replace(raw.trial, condition=f"{raw.trial.condition}_{motion}"))


def _tell_left(told: str, group: Sequence[RawTrial], kept: Sequence[RawTrial], warnings: list[str]) -> None:
    names = {raw.trial.name for raw in kept}
    left = [raw.trial.name for raw in group if raw.trial.name not in names]
    if left:
        warnings.append(f"condition {told}: left out for another motion than the others': {', '.join(left)}")


def most_odd(trials: int) -> float:
    """How many of so many trials may be set aside: one of three and more, else a share."""
    return max(criteria.MOST_ODD * trials, 1.0 if trials >= criteria.LEAST_TRIALS else 0.0)


def specimens(group: Sequence[RawTrial]) -> NDArray[np.int64]:
    """(R,) numbers of the specimens, told apart by their heights; all one where these were not measured."""
    heights = np.array([_height(raw) for raw in group])
    if not np.isfinite(heights).all():
        return np.zeros(len(group), dtype=np.int64)
    order = np.argsort(heights, kind="stable")
    steps = np.diff(np.log(heights[order]), prepend=np.log(heights[order[0]])) > criteria.SAME_HEIGHT
    numbers = np.empty(len(group), dtype=np.int64)
    numbers[order] = np.cumsum(steps)
    return numbers


def _kinds(raw: RawTrial) -> tuple[str, ...]:
    return tuple(piece.kind for piece in raw.pieces)


def _strokes(raw: RawTrial) -> tuple[str, ...]:
    return tuple(kind for kind in _kinds(raw) if kind != "rest")


def _rests(raw: RawTrial) -> dict[int, Segment]:
    """The rests of a trial by the number of strokes before them."""
    found, strokes = {}, 0
    for piece in raw.pieces:
        if piece.kind == "rest":
            found[strokes] = piece
        else:
            strokes += 1
    return found


def _with_like_dwells(group: Sequence[RawTrial]) -> Sequence[RawTrial]:
    """Trials whose dwells inside strokes count to these where not all trials of one motion show the same."""
    whole = [replace(raw, pieces=without_dwells(raw.pieces)) for raw in group]
    usual = Counter(_strokes(raw) for raw in whole).most_common(1)[0][0]
    found = {_strokes(raw) for raw, joined in zip(group, whole, strict=True) if _strokes(joined) == usual}
    return group if len(found) == 1 else whole


def _with_like_rests(group: Sequence[RawTrial]) -> list[RawTrial]:
    """Trials whose first rest, and short ones, count to the motion beside them where not all trials show them.

    Whether a short dwell shows depends on how far the tool travels, and so on the specimen's height.
    """
    usual = Counter(_strokes(raw) for raw in group).most_common(1)[0][0]
    rests = [_rests(raw) for raw in group if _strokes(raw) == usual]
    shared = set(rests[0]).intersection(*rests)
    unshared = {place for each in rests for place in each} - shared
    shares: dict[int, list[float]] = {place: [] for place in unshared}
    for raw in group:
        if _strokes(raw) == usual:
            for place, piece in _rests(raw).items():
                shares.get(place, []).append(_duration(raw, piece) / float(np.ptp(raw.time)))
    joined = {place for place, each in shares.items() if place == 0 or np.median(each) <= criteria.SHORT_REST}
    return [_without_rests(raw, joined) if _strokes(raw) == usual else raw for raw in group]


def _duration(raw: RawTrial, piece: Segment) -> float:
    return float(raw.time[min(piece.last, raw.time.size - 1)] - raw.time[piece.first])


def _without_rests(raw: RawTrial, places: AbstractSet[int]) -> RawTrial:
    """A trial whose rests at these places count to the stroke before them, the first to the one after it."""
    out: list[Segment] = []
    strokes, first = 0, 0
    for piece in raw.pieces:
        if piece.kind == "rest" and strokes in places:
            if out:
                out[-1] = replace(out[-1], last=piece.last)
            continue
        strokes += piece.kind != "rest"
        out.append(piece if out else replace(piece, first=first))
    return replace(raw, pieces=tuple(out))


@dataclass(frozen=True, eq=False)
class _Extent:
    """How deep, how hard and how fast trials press, each (R,): m, N, m/s; `height` of each specimen, m, or NaN.

    Where the force was prescribed (`by_force`), the depth is an answer and is not asked: `speed` is the force's, N/s.
    """

    depth: Array
    force: Array
    speed: Array
    height: Array
    by_force: bool

    @staticmethod
    def of(group: Sequence[RawTrial]) -> _Extent:
        return _Extent(
            np.array([raw.depth.max() for raw in group]),
            np.array([np.ptp(raw.force) for raw in group]),
            np.array([_speed(raw) for raw in group]),
            np.array([_height(raw) for raw in group]),
            all(raw.by_force for raw in group),
        )

    @property
    def _presses(self) -> tuple[Array, ...]:
        """What may be alike in one protocol: depth, depth over the specimen's height, or force."""
        return (self.force,) if self.by_force else (self.depth, self.force, *self._over_height(self.depth))

    @property
    def _rates(self) -> tuple[Array, ...]:
        return (self.speed,) if self.by_force else (self.speed, *self._over_height(self.speed))

    def _over_height(self, values: Array) -> tuple[Array, ...]:
        return (values / self.height,) if np.isfinite(self.height).all() else ()

    @property
    def wide(self) -> bool:
        """Whether the trials differ in speed, or in depth and force, by more than chance."""
        spreads = [min(_ratio(each) for each in kind) for kind in (self._presses, self._rates)]
        return max(spreads) > criteria.PROTOCOL_SPREAD

    @property
    def odd(self) -> NDArray[np.bool_]:
        """(R,) whether a trial is far from the median."""
        far = [
            np.min([np.abs(np.log(each / np.median(each))) for each in kind], axis=0)
            for kind in (self._presses, self._rates)
        ]
        return np.asarray(np.max(far, axis=0) > 0.5 * np.log(criteria.PROTOCOL_SPREAD))

    def __str__(self) -> str:
        if self.by_force:
            force, rate = self.force, self.speed
            return f"force up to {force.min():.3g} to {force.max():.3g} N, at {rate.min():.3g} to {rate.max():.3g} N/s"
        depth, speed = 1e3 * self.depth, 1e3 * self.speed
        return (
            f"peak depth {depth.min():.3g} to {depth.max():.3g} mm, speed {speed.min():.3g} to {speed.max():.3g} mm/s"
        )


def _ratio(values: Array) -> float:
    return float(values.max() / values.min())


def _height(raw: RawTrial) -> float:
    """Gap between tool and base at zero depth, m, or what was told; NaN where neither is known."""
    gap = gap_at_zero_depth(raw.trial.table)
    height = raw.trial.height if gap is None else gap
    return height if height is not None and height > 0.0 else np.nan


def _speed(raw: RawTrial) -> float:
    """Of the longest way in of the first press, m/s, or N/s where the force was prescribed.

    A weight that is put on within few rows has no rate that these show: they count as so many.
    """
    strokes = [piece for piece in raw.pieces if piece.kind == "press" and piece.cycle == 1]
    ends = [(piece.first, min(piece.last, raw.time.size - 1)) for piece in strokes]
    first, last = max(ends, key=lambda each: abs(raw.led[each[1]] - raw.led[each[0]]))
    least = JUMP_ROWS * float(np.median(np.diff(raw.time))) if raw.by_force else 1e-9
    return float(abs(raw.led[last] - raw.led[first]) / max(raw.time[last] - raw.time[first], least))


def _timed_like(raw: RawTrial, model: RawTrial) -> RawTrial | None:
    """A trial with the segments of another by their times, if its motion is the same."""
    duration, other = np.ptp(raw.time), np.ptp(model.time)
    if abs(duration / other - 1.0) > criteria.PROTOCOL_TIME:
        return None
    shown = np.interp(model.time - model.time[0], raw.time - raw.time[0], raw.led)
    if np.abs(shown - model.led).max() > criteria.PROTOCOL_DEPTH * np.ptp(model.led):
        return None
    stamps = [model.time[piece.first] - model.time[0] for piece in model.pieces]
    edges = [int(np.searchsorted(raw.time - raw.time[0], stamp - 1e-9)) for stamp in stamps] + [raw.time.size]
    pieces = [
        replace(piece, first=first, last=last)
        for piece, first, last in zip(model.pieces, edges[:-1], edges[1:], strict=True)
    ]
    return replace(raw, pieces=tuple(pieces)) if all(p.last > p.first for p in pieces) else None
