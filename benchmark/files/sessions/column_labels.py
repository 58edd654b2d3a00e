"""Whether trials are surely in another unit than their columns say, or have force and depth exchanged: refused.

Told by the trials of the same condition or set-up, with what to write where the labels are wrong, or right after all.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from bench_hw.instrument_files.press_record import first_touch
from bench_hw.instrument_files.vocabulary import DIMENSIONS, unit_scale
from bench_hw.tables import TrialTable, calm
from benchmark.errors import InputError
from benchmark.files.sessions.description import ImportTable
from benchmark.files.sessions.recordings import Recording
from benchmark.files.sessions.session_folder import SESSION_FILE

OTHERS, MOST_OTHERS = 3, 20
"""Further trials of a condition that a trial must differ from alike, and the most that it is compared with."""
ODD: Final = 0.25
"""Share of those others that may be odd themselves; the rest are the family that a trial is compared with."""
TIGHT: Final = 0.25
"""Of the log of the fold by which a trial is apart, that the family's own range may be at most: a 1000-fold one is told
among trials that differ 5-fold, a 10-fold one among those that differ 1.8-fold."""
ROUNDED: Final = 0.05
"""How near to a unit's factor a trial is besides half the range of its family, relative."""
SAME: Final = math.log(3.0)
"""Log of the fold within which two presses are as deep, or as strong, to be compared in the other."""
SIGNAL: Final = 20.0
"""Of its row-to-row noise, that a force must rise to tell a unit: an empty press is a thousandth of one, too."""
ALIKE: Final = 0.04
"""Units nearer to each other than this (gf and cN) are told together."""
_UNITS: Final[Mapping[str, tuple[str, ...]]] = {  # lbf is 4.4 N, which specimens may differ by, too
    "depth": ("m", "cm", "mm", "um", "nm", "inch"),
    "force": ("kN", "N", "mN", "uN", "gf", "cN", "kgf"),
    "time": ("min", "s", "ms", "us"),
}
_OWN: Final[Mapping[str, str]] = {"time": "time_s [s]", "depth": "depth_mm [mm]", "force": "force_N [N]"}
"""The columns of the bench's own table, as `PressRecord.columns` shows those of other instruments."""


@dataclass(frozen=True, eq=False)
class _Labelled:
    """A trial with what its file says of its columns, and the quantities of which a person said more."""

    file: str
    condition: str
    table: TrialTable
    columns: Mapping[str, str]
    told: frozenset[str]

    def column(self, role: str) -> tuple[str, str]:
        """Name and unit of a column."""
        name, _, unit = self.columns[role].rpartition(" [")
        return name.removeprefix("column ") if name.startswith("column #") else name, unit.removesuffix("]")

    def scale(self, role: str) -> float:
        """SI value of the unit of a column."""
        return unit_scale(self.column(role)[1], DIMENSIONS[role]) or 1.0

    @cached_property
    def force(self) -> np.ndarray:
        """(n,) N above where it began."""
        force = calm(self.table.force)
        return np.asarray(force - np.median(force[: max(5, len(force) // 50)]))

    @cached_property
    def travel(self) -> float:
        """Range of the depth, m."""
        return float(np.ptp(self.table.depth))

    @cached_property
    def rise(self) -> float:
        """Largest force above where it began, N."""
        return float(self.force.max())

    @cached_property
    def is_press(self) -> bool:
        """Whether the force rises clearly over its noise as the tool goes in."""
        noise = float(np.median(np.abs(np.diff(self.table.force))))
        return float(self.table.depth.max()) > 0.0 and self.travel > 0.0 and self.rise > SIGNAL * noise

    def force_at(self, depth: float) -> float:
        """Force (N) on the way to the deepest row, at a depth (m)."""
        last = int(self.table.depth.argmax()) + 1
        return float(np.interp(depth, np.maximum.accumulate(self.table.depth[:last]), self.force[:last]))


def check_labels(read: Sequence[Recording], told: ImportTable, setups: Mapping[str, Hashable]) -> None:
    """Refuse trials whose force and depth are surely exchanged, or surely in another unit than the others'.

    A trial is compared with the others of its condition where three or more press, else with all under the same set-up
    (`setups`, by condition), whose speeds may differ. What a person says of a column ([import], or `import` of the
    trial) is believed.

    Raises
    ------
    InputError
        Names each trial, what tells it, and what to write.
    """
    known = [made for each in read if (made := _labelled(each, told)) is not None]
    presses: dict[Hashable, list[_Labelled]] = {}
    for one in known:
        for group in (one.condition, (setups[one.condition],)):
            presses.setdefault(group, []).extend([one] if one.is_press else [])
    found: list[_Found] = []
    for one in known:
        of_condition = len(presses[one.condition]) - one.is_press >= OTHERS
        own = presses[one.condition if of_condition else (setups[one.condition],)]
        others = [each for each in own[:: max(1, len(own) // MOST_OTHERS)] if each is not one]
        exchanged = not one.told & {"depth", "force"} and (_exchanged_in_air(one) or _exchanged_among(one, others))
        found += [_exchanged(one, exchanged)] if exchanged else _other_units(one, others)
    if found:
        raise InputError(_refusal(found, len(read)))


@dataclass(frozen=True)
class _Found:
    """A trial whose numbers contradict its columns: its file, why, and what to tell by the keys of [import]."""

    file: str
    why: str
    keys: Mapping[str, str]
    true: Mapping[str, str]


def _refusal(found: Sequence[_Found], trials: int) -> str:
    """What is wrong in which files and what to write: options where it is true of all trials, else lines of each."""
    first = found[0]
    if len(found) == trials and all(one.keys == first.keys for one in found):
        more = f" (and {trials - 1} more files)" if trials > 1 else ""
        options, kept = (
            " ".join(f'--set import.{k}="{v}"' for k, v in keys.items()) for keys in (first.keys, first.true)
        )
        return f"{first.file}{more}: {first.why}; allowed: {options}, or where all is right {kept}."
    said = []
    for one in found[:3]:
        table = ", ".join(f'{key} = "{value}"' for key, value in one.keys.items())
        said.append(f"{one.file}: {one.why}; allowed: import = {{ {table} }}")
    more = f"; and {len(found) - 3} more" if len(found) > 3 else ""
    kept = ", ".join(f'{key} = "{value}"' for key, value in first.true.items())
    return (
        f"{'; '.join(said)}{more}. This is a line below the file's name in {SESSION_FILE} (`python -m benchmark "
        f"session new FOLDER` writes one); import = {{ {kept} }} where the file is right as it is."
    )


def _labelled(one: Recording, told: ImportTable) -> _Labelled | None:
    """A trial whose columns can be told otherwise; None for the bench's own recordings, and for stress or strain."""
    columns = one.columns or _OWN
    if one.entry.file.lower().endswith(".mcap") or not columns.keys() >= {"depth", "force"}:
        return None
    said = frozenset(told.with_own(one.entry.import_).model_fields_set)
    return _Labelled(one.entry.file, one.entry.condition, one.table, columns, said)


LEAST_AIR: Final = 0.1
"""Share of its range by which an approach in air moves a column, while the force stands."""
AIR_ROWS, AIR_VALUES = 20, 10
"""Rows of an approach, and different values of a force in it: a depth in coarse counts stands without scattering."""
EVEN: Final = 0.01
"""Of its way, within which an approach is a parabola over time."""


def _exchanged_in_air(one: _Labelled) -> str:
    """What tells that the record begins with a depth that stands and scatters while its force moves evenly."""
    table = one.table
    row, _ = first_touch(TrialTable(table.time, one.force, table.depth, {}, table.source, {}))
    time, force, depth = table.time[: row + 1], one.force[: row + 1], table.depth[: row + 1]
    if row < AIR_ROWS or len(np.unique(depth)) < AIR_VALUES:
        return ""
    moved, scatter = float(force[-1] - force[0]), float(np.std(depth))
    fitted = np.polynomial.Polynomial.fit(time, force, 2)(time)
    stands = scatter < EVEN * one.travel and LEAST_AIR * float(np.ptp(one.force)) < moved
    if not stands or float(np.std(force - fitted)) > EVEN * moved:
        return ""
    return (
        f"over the first {row + 1} rows the force rises evenly by {moved:.3g} N while the depth stands and scatters by "
        f"{1e3 * scatter:.2g} mm, as depth and force do in air"
    )


def _exchanged_among(one: _Labelled, others: Sequence[_Labelled]) -> str:
    """What tells that a trial's depth is as large a number as the other trials' force, and its force as their depth."""
    if len(others) < OTHERS:
        return ""
    numbers = [[each.travel / each.scale("depth"), each.rise / each.scale("force")] for each in (one, *others)]
    if min(numbers[0]) <= 0.0:
        return ""
    own, families = np.log(numbers[0]), [_family(column) for column in np.array(numbers[1:]).T]
    for number, other, family in zip(own, own[::-1], families, strict=True):
        if abs(other - family.middle) > family.near or not family.is_apart(number):
            return ""
    own, middle = np.exp(own), np.exp([family.middle for family in families])
    units = [one.column(role)[1] for role in ("depth", "force")]
    return (
        f"depth to {own[0]:.3g} {units[0]} and force to {own[1]:.3g} {units[1]}, where {len(others)} other trials "
        f"come to {middle[0]:.3g} {units[0]} and {middle[1]:.3g} {units[1]}"
    )


def _exchanged(one: _Labelled, why: str) -> _Found:
    (depth, length), (force, weight) = one.column("depth"), one.column("force")
    keys = {"depth": f"{force}:{length}", "force": f"{depth}:{weight}"}
    true = {"depth": f"{depth}:{length}", "force": f"{force}:{weight}"}
    return _Found(one.file, f"{why}: {depth!r} and {force!r} are exchanged", keys, true)


@dataclass(frozen=True)
class _Family:
    """Log of the median of some trials' values, and the range of the logs of all but a quarter of them."""

    middle: float
    range: float

    @property
    def near(self) -> float:
        """How far, in logs, a value may be from the middle to be of the family."""
        return ROUNDED + 0.5 * self.range

    def is_apart(self, log: float) -> bool:
        """Whether a value is so far from the middle that the range of the family is nothing beside it."""
        return abs(log - self.middle) > max(self.range / TIGHT, self.near)


def _family(values: Sequence[float] | np.ndarray) -> _Family:
    logs = np.log(np.asarray(values, dtype=float))
    middle = float(np.median(logs))
    kept = logs[np.argsort(np.abs(logs - middle))][: len(logs) - int(ODD * (len(logs) - 1))]
    return _Family(middle, float(np.ptp(kept)))


def _other_units(one: _Labelled, others: Sequence[_Labelled]) -> list[_Found]:
    """What a trial's numbers are beside those of the others, where that is another unit's factor."""
    if len(others) < OTHERS or not one.is_press:
        return []
    found = [*_other_press(one, others), *_other_clock(one, others)]
    return [_told_unit(one, len(others), *each) for each in found if each[1] not in one.told]


def _other_press(one: _Labelled, others: Sequence[_Labelled]) -> list[tuple[_Beside, str, str]]:
    """A force of another unit at the same depth, or a depth of another for about the same force, or both.

    A press of another depth that lies on the others' curve is a shallower or deeper press.
    """
    everyone = (one, *others)
    deep = _beside(one, "depth", [each.travel for each in everyone])
    deepest = [float(each.table.depth.max()) for each in everyone]
    level = 0.8 * min(deepest[0], float(np.median(deepest[1:])))
    at_level = [each.force_at(level) for each in everyone]
    if abs(math.log(deep.ratio)) < SAME:
        strong = _beside(one, "force", at_level) if min(at_level) > 0.0 else _Beside(1.0)
        return [(strong, "force", " at the same depth")] if strong.unit else []
    on_curve = abs(math.log(max(at_level[0], 1e-300) / max(float(np.median(at_level[1:])), 1e-300))) < SAME
    strong = _beside(one, "force", [each.rise for each in everyone])
    if on_curve or not deep.unit or not (strong.unit or abs(math.log(strong.ratio)) < SAME):
        return []
    return [*([(strong, "force", "")] if strong.unit else []), (deep, "depth", "")]


def _other_clock(one: _Labelled, others: Sequence[_Labelled]) -> list[tuple[_Beside, str, str]]:
    """Times of another unit, where rows and records of one condition are as many times longer."""
    if any(each.condition != one.condition for each in others):
        return []
    lasts = [float(np.ptp(each.table.time)) for each in (one, *others)]
    steps = [float(np.median(np.diff(each.table.time))) for each in (one, *others)]
    long, slow = (_beside(one, "time", values) for values in (lasts, steps))
    return [(long, "time", " from row to row and in all")] if long.unit and long.unit == slow.unit else []


@dataclass(frozen=True)
class _Beside:
    """A trial's quantity over the others' median, and the unit it would be in; "" where it is as theirs, or none's."""

    ratio: float
    unit: str = ""


def _beside(one: _Labelled, role: str, values: Sequence[float]) -> _Beside:
    """Compare the first of some SI values with the others."""
    if role not in one.columns:
        return _Beside(1.0)
    family, own = _family(values[1:]), math.log(values[0])
    ratio = math.exp(own - family.middle)
    if not family.is_apart(own):
        return _Beside(ratio)
    scales = {unit: unit_scale(unit, DIMENSIONS[role]) or 1.0 for unit in _UNITS[role]}
    apart = {unit: abs(math.log(scale * ratio / one.scale(role))) for unit, scale in scales.items()}
    near = [unit for unit in apart if apart[unit] < min(apart.values()) + ALIKE]
    fits = min(apart.values()) < family.near and scales[near[0]] != one.scale(role)
    return _Beside(ratio, " or ".join(near) if fits else "")


def _told_unit(one: _Labelled, others: int, found: _Beside, role: str, where: str) -> _Found:
    name, unit = one.column(role)
    why = (
        f"{name!r} is {found.ratio:.3g} times that of {others} other trials{where}, as "
        f"numbers in {found.unit} would be under {unit}"
    )
    keys, true = ({role: f"{name}:{each}"} for each in (found.unit.partition(" ")[0], unit))
    return _Found(one.file, why, keys, true)
