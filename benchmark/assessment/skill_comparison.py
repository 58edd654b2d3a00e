"""Attempts in a table, and two groups of them compared: expert against novice, measure by measure, with power.

An attempt that left targets out was a shorter task: it is not in the comparison of time, path and economy of motion.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from statsmodels.stats.multitest import multipletests

from benchmark.assessment.attempt_measures import Attempt, read_attempt
from benchmark.comparison.t_tests import LARGE_EFFECT, TwoSampleT, detectable_effect, group_power, group_t_test
from benchmark.errors import InputError
from benchmark.runs.output.destination import destination
from reports import Column, Download, Page, Section, Table, Verdict, write_csv, write_json, write_page, write_whole
from reports.formatting import counted

LEVEL = 0.05
FEWEST = 2
"""Attempts of a group that a test needs."""
READ = {
    "time_s": ("time", "s", -1),
    "path_length_mm": ("path length", "mm", -1),
    "economy_of_motion": ("economy of motion", "", 1),
    "targets_reached": ("targets reached", "", 1),
    "log_dimensionless_jerk": ("log dimensionless jerk", "", 1),
    "spectral_arc_length": ("spectral arc length", "", 1),
    "motion_frequency_hz": ("95 % motion frequency", "Hz", -1),
    "tremor_um": ("tremor", "µm", -1),
    "depth_error_mm": ("depth error", "mm", -1),
    "force_error_N": ("force error", "N", -1),
    "bimanual_correlation": ("bimanual correlation", "", 1),
}
"""Each measure in words, its unit, and whether more (1) or less (-1) of it is the better attempt by its source."""
OF_THE_WHOLE = ("time_s", "path_length_mm", "economy_of_motion")
"""Measures that attempts are compared by only where they came to every target."""


@dataclass(frozen=True)
class MeasureTest:
    """One measure between two groups.

    Attributes
    ----------
    measure
        Its column.
    test
        Welch's test; `fem` is the first group, `wave` the second.
    adjusted
        p after Holm's adjustment for all measures tested.
    power
        Of this test against a large effect, 0.8 standard deviations.
    detectable
        Standard deviations that it finds four times in five.
    """

    measure: str
    test: TwoSampleT
    adjusted: float
    power: float
    detectable: float

    @property
    def differs(self) -> bool:
        """Whether the groups differ at 5 % after adjustment."""
        return self.adjusted < LEVEL

    def better(self, groups: Sequence[str]) -> str:
        """The group that does better by this measure."""
        return groups[int(self.test.difference * READ[self.measure][2] > 0.0)]


@dataclass(frozen=True)
class Assessment:
    """All attempts with their measures, and, of two groups, the tests."""

    attempts: tuple[Attempt, ...]
    measures: tuple[dict[str, float], ...]
    groups: tuple[str, ...]
    tests: tuple[MeasureTest, ...] = ()

    def columns(self) -> dict[str, list[Any]]:
        """`attempts.csv`: a row an attempt."""
        out: dict[str, list[Any]] = {
            "attempt": [one.name for one in self.attempts],
            "group": [one.group for one in self.attempts],
        }
        out |= {name: [row[name] for row in self.measures] for name in self.measures[0]}
        return out | {"warnings": ["; ".join(one.warnings) for one in self.attempts]}

    def tests_columns(self) -> dict[str, list[Any]]:
        """`skill.csv`: a row a measure."""
        names = ["first group", "second group"] if len(self.groups) != 2 else list(self.groups)
        return {
            "measure": [one.measure for one in self.tests],
            f"{names[0]}_n": [one.test.fem.observations for one in self.tests],
            f"{names[1]}_n": [one.test.wave.observations for one in self.tests],
            f"{names[0]}_mean": [one.test.fem.mean for one in self.tests],
            f"{names[1]}_mean": [one.test.wave.mean for one in self.tests],
            "difference": [one.test.difference for one in self.tests],
            "ci95_low": [one.test.ci95_low for one in self.tests],
            "ci95_high": [one.test.ci95_high for one in self.tests],
            "t": [-one.test.t for one in self.tests],
            "p": [one.test.p_value for one in self.tests],
            "p_holm": [one.adjusted for one in self.tests],
            "power_large_effect": [one.power for one in self.tests],
            "detectable_effect_sd": [one.detectable for one in self.tests],
        }

    @property
    def headline(self) -> str:
        """What was found, and what it leaves out."""
        return " ".join([f"{counted(len(self.attempts), 'attempt')}{self._found}", *self._left_out, *self._warned])

    @property
    def _found(self) -> str:
        if not self.tests:
            return " measured; groups are compared where two folders with two attempts each are given."
        found = [one for one in self.tests if one.differs]
        if not found:
            return f": no measure tells {' from '.join(self.groups)}, which does not show that they are alike."
        number = f"{len(found)} of {len(self.tests)} measures tell{'s' * (len(found) == 1)}"
        better = [(one.better(self.groups), READ[one.measure][0]) for one in found]
        told = [(group, [words for side, words in better if side == group]) for group in self.groups]
        sides = [f"{group} does better in {', '.join(names)}" for group, names in told if names]
        return f": {number} {' from '.join(self.groups)}; {'; '.join(sides)}."

    @property
    def _left_out(self) -> list[str]:
        """Of two groups, which attempts left targets out and what they are not compared by."""
        each = [
            [row["targets_reached"] for one, row in zip(self.attempts, self.measures, strict=True) if one.group == name]
            for name in self.groups
        ]
        if len(each) != 2 or not any(share < 1.0 for shares in each for share in shares):
            return []
        sides = [
            f"{name} left targets out in {sum(share < 1.0 for share in shares)} of {counted(len(shares), 'attempt')} "
            f"(reached {100.0 * float(np.nanmean(shares)):.3g} %)"
            for name, shares in zip(self.groups, each, strict=True)
            if np.isfinite(shares).any()
        ]
        return [f"{'; '.join(sides)}: time, path length and economy of motion are compared without those."]

    @property
    def _warned(self) -> list[str]:
        warned = [one.warnings for one in self.attempts if one.warnings]
        if len(self.attempts) == 1:
            return [f"Warning: {'; '.join(told)}." for told in warned]
        return [f"Warnings of {counted(len(warned), 'attempt')} stand in attempts.csv."] * bool(warned)


def assess(records: Sequence[Path]) -> Assessment:
    """Measure records and compare them where they come in two groups.

    Parameters
    ----------
    records
        CSV files, or folders of them: a folder is a group, named like it, with as much of its path as tells it from
        the others.

    Raises
    ------
    InputError
        A record that cannot be read or that is given twice, or none.
    """
    names = _group_names([path for path in records if path.is_dir()])
    files = [(file, names.get(path.resolve(), "")) for path in records for file in _files(path)]
    seen: set[Path] = set()
    for file, _ in files:
        if file.resolve() in seen:
            raise InputError(f"{file} is given twice; give each record once, alone or in its folder")
        seen.add(file.resolve())
    attempts = tuple(read_attempt(file, group) for file, group in files)
    measures = tuple(attempt.measures() for attempt in attempts)
    groups = tuple(dict.fromkeys(attempt.group for attempt in attempts if attempt.group))
    return Assessment(attempts, measures, groups, _tests(attempts, measures, groups))


def _group_names(folders: Sequence[Path]) -> dict[Path, str]:
    """The end of each folder's path that no other has, as short as that may be."""
    whole = [folder.resolve() for folder in folders]
    twice = next((folder for at, folder in enumerate(whole) if folder in whole[:at]), None)
    if twice is not None:
        raise InputError(f"{twice} is given twice; give each folder once")
    names = {}
    for folder in whole:
        count, parts = 1, folder.parts
        while sum(other.parts[-count:] == parts[-count:] for other in whole) > 1:
            count += 1
        names[folder] = str(Path(*parts[-count:]))
    return names


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    files = sorted(path.glob("*.csv"))
    if not files:
        raise InputError(f"{path} has no record in it; give CSV files, or folders of them")
    return files


def _tests(
    attempts: Sequence[Attempt], measures: Sequence[dict[str, float]], groups: tuple[str, ...]
) -> tuple[MeasureTest, ...]:
    """A test for each measure that both groups have often enough; see `OF_THE_WHOLE`."""
    if len(groups) != 2:
        return ()
    found: list[tuple[str, TwoSampleT, tuple[int, int]]] = []
    for name in measures[0]:
        values = [
            np.array(
                [
                    row[name]
                    for one, row in zip(attempts, measures, strict=True)
                    if one.group == group and not (name in OF_THE_WHOLE and row["targets_reached"] < 1.0)
                ]
            )
            for group in groups
        ]
        first, second = (each[np.isfinite(each)] for each in values)
        if min(first.size, second.size) >= FEWEST:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # a group whose every attempt reached all targets
                test = group_t_test(first, second)
            if np.isfinite(test.p_value):
                found.append((name, test, (first.size, second.size)))
    if not found:
        return ()
    adjusted = multipletests([test.p_value for _, test, _ in found], method="holm")[1]
    return tuple(
        MeasureTest(name, test, float(p), group_power(sizes), detectable_effect(sizes))
        for (name, test, sizes), p in zip(found, adjusted, strict=True)
    )


def write_assessment(found: Assessment, out: Path | None) -> Path:
    """Write `attempts.csv`, `skill.csv`, `assessment.json` and a page; the folder.

    Raises
    ------
    InputError
        The folder cannot be one; see `destination`.
    """
    folder = destination(out, "assessment")

    def fill(new: Path) -> None:
        write_csv(new / "attempts.csv", found.columns())
        if found.tests:
            write_csv(new / "skill.csv", found.tests_columns())
        write_json(new / "assessment.json", summary(found))
        write_page(new / "report.html", _page(found))

    write_whole(folder, fill)
    return folder


def summary(found: Assessment) -> dict[str, Any]:
    """What programs read."""
    rows = zip(found.attempts, found.measures, strict=True)
    table = found.tests_columns()
    return {
        "schema": 1,
        "headline": found.headline,
        "groups": list(found.groups),
        "attempts": [
            {"attempt": one.name, "group": one.group, **row, "warnings": list(one.warnings)} for one, row in rows
        ],
        "tests": [dict(zip(table, row, strict=True)) for row in zip(*table.values(), strict=True)],
    }


def _page(found: Assessment) -> Page:
    told = any(one.differs for one in found.tests)
    status = "unknown" if not found.tests else "finding" if told else "incomplete"
    points = [
        f"Welch's t-test for each measure, p adjusted by Holm for {len(found.tests)} tests; a measure that does not "
        f"differ is no evidence of equal skill.",
        f"Against a large effect ({LARGE_EFFECT:g} standard deviations) these groups give a power of "
        f"{min((one.power for one in found.tests), default=0.0):.2f} at least; a difference of "
        f"{max((one.detectable for one in found.tests), default=0.0):.2g} standard deviations is found four times in "
        "five.",
    ]
    sections = [Section("Attempts", (_attempts_table(found),))]
    if found.tests:
        sections.insert(0, Section("Groups", (_groups_table(found),)))
    return Page("How it was pressed", Verdict(status, found.headline, points if found.tests else ()), sections)


def _attempts_table(found: Assessment) -> Table:
    """What each attempt measured, without the measures that none has."""
    every = found.columns()
    columns = {name: each for name, each in every.items() if name not in READ or np.isfinite(each).any()}
    if not any(columns["warnings"]):
        del columns["warnings"]
    heads = [Column(*READ.get(name, (name, ""))[:2], digits=3) for name in columns]
    rows = list(zip(*columns.values(), strict=True))
    return Table("What each attempt measured", heads, rows, Download("attempts.csv"))


def _groups_table(found: Assessment) -> Table:
    heads = [
        Column("measure"),
        Column("better is"),
        *(Column(f"{group}, mean", digits=3) for group in found.groups),
        Column("difference", digits=3),
        Column("95 % interval"),
        Column("p by Holm", digits=2),
        Column("better"),
    ]
    rows = [
        (
            f"{words}, {unit}" if unit else words,
            "more" if way > 0 else "less",
            one.test.fem.mean,
            one.test.wave.mean,
            one.test.difference,
            f"{one.test.ci95_low:.3g} to {one.test.ci95_high:.3g}".replace("-", "−"),
            one.adjusted,
            one.better(found.groups) if one.differs else "not told",
        )
        for one in found.tests
        for words, unit, way in (READ[one.measure],)
    ]
    return Table(" against ".join(found.groups), heads, rows, Download("skill.csv"))
