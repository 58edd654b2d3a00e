"""The page of a blind run: every measure with its bar and interval, what is reached, by lab and by family."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from benchmark.blind.scoring.judging import IMPOSSIBLE, Judged
from benchmark.blind.scoring.lab_measures import alike_right, first_right, in_set, right
from benchmark.blind.scoring.measure_rows import BlindRow, clopper_pearson, share
from reports import Block, Column, Download, Fact, KeyFigure, Notice, Page, Paragraph, Section, Table, Verdict
from reports.figures import ShareRow, shares

ELSEWHERE = (
    ("rivals separated after the next experiments", ">= 0.95 in at most 3"),
    ("measured sessions of other labs answered as their descriptions do", "all"),
)
"""Measures that no blind run can take."""
MOST_POINTS = 6
READING = (
    "A bar is reached where the measured value is on its good side; it is sure only where the whole 95 % interval "
    "(Clopper-Pearson for shares, resampled cases for means and medians) is. Sessions with fewer than six trials are "
    "counted in their own row alone. What can show is five standard deviations and more beside what its session does "
    "not state of the layers."
)
SYNTHETIC = "All sessions are synthetic: computed by the blind trials' generator, not measured."


def scoreboard(
    settings: Mapping[str, Any], rows: Sequence[BlindRow], cases: Sequence[Judged], environment: Mapping[str, Any]
) -> Page:
    """The page of a finished run."""
    made = [case for case in cases if case.verdict != IMPOSSIBLE]
    return Page(
        title=f"Blind trials of the discovery, suite {settings['suite']}",
        subtitle=f"{len(made)} sessions with and without hidden effects, from seed {settings['seed']} on",
        verdict=_verdict(rows),
        facts=(
            Fact("Made", str(environment["made"])),
            Fact("Discovery", str(settings["discoverer"])),
            Fact("Seed", str(settings["seed"])),
        ),
        notices=(Notice("synthetic", SYNTHETIC),),
        key_figures=_key_figures(made),
        sections=[
            Section("Measures", _measures(rows)),
            Section("By lab and family", _by_lab(made)),
            Section("Which effect in which lab", _by_effect(made)),
            Section("Misses", _misses(made)),
        ],
        downloads=(
            Download("cases.csv", "every case: its lab's conditions, what was said, and the truth"),
            Download("confusion.csv", "which effect was taken for which"),
            Download("blind.json", "all measures", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _verdict(rows: Sequence[BlindRow]) -> Verdict:
    judged = [row for row in rows if row.passed is not None]
    missed = [row for row in judged if not row.passed]
    if not judged:
        return Verdict("unknown", "No measure with a bar has a case in this run.")
    doubtful = [row for row in judged if row.passed and not _is_sure(row)]
    told = [f"{row.measure}: {_in_words(row)}, bar {row.bar}" for row in missed]
    told += [f"{row.measure}: {_in_words(row)}, bar {row.bar}, reached but not sure" for row in doubtful]
    points = told[:MOST_POINTS] + ([f"and {len(told) - MOST_POINTS} more, below"] if len(told) > MOST_POINTS else [])
    doubt = f"Too few cases to be sure of {len(doubtful)}, but " if doubtful else ""
    said = f"{doubt}{len(judged) - len(missed)} of {len(judged)} bars are reached."
    return Verdict("finding" if missed else "unknown" if doubtful else "good", said, points)


def _in_words(row: BlindRow) -> str:
    return f"{row.value:.3g} [{row.ci95[0]:.3g}, {row.ci95[1]:.3g}] over {row.n}"


def _key_figures(cases: Sequence[Judged]) -> tuple[KeyFigure, ...]:
    """Four shares worth large type, each where it has cases."""
    kinds: tuple[tuple[str, str, Callable[[Judged], bool]], ...] = (
        ("right name first", "effect", first_right),
        ("first, or a look-alike of the first", "effect", alike_right),
        ("both of a pair named", "pair", right),
        ("nulls with an effect named", "null", lambda case: bool(case.named)),
    )
    found = [(label, share(label, [case for case in cases if case.kind == kind], of, "")) for label, kind, of in kinds]
    return tuple(
        KeyFigure(label, 100 * row.value, "%", f"{100 * row.ci95[0]:.0f} to {100 * row.ci95[1]:.0f} %, {row.n} cases")
        for label, row in found
        if row.n
    )


def _measures(rows: Sequence[BlindRow]) -> list[Block]:
    drawn = [
        ShareRow(row.measure, row.value, *row.ci95, row.n, float(row.bar.split()[1]) if row.bar else None, row.passed)
        for row in rows
        if row.n and row.is_share
    ]
    caption = "Each share with its 95 % interval; the line is its bar. Hollow: not reached."
    blocks: list[Block] = [Paragraph(READING)]
    blocks += [shares(drawn, caption, "Measures with their bars")] if drawn else []
    columns = ("measure", Column("value", digits=3), Column("95 % from", digits=3), Column("to", digits=3), "cases")
    lines = [
        (row.measure, row.value, *row.ci95, row.n, row.bar, _reached(row))
        if row.n
        else _unmeasured(row.measure, row.bar)
        for row in rows
    ]
    lines += [_unmeasured(measure, bar) for measure, bar in ELSEWHERE]
    return [*blocks, Table("Every measure", (*columns, "bar", "reached"), lines, folded=False)]


def _line(row: BlindRow) -> tuple[Any, ...]:
    if not row.n:
        return _unmeasured(row.measure, row.bar)
    return row.measure, row.value, *row.ci95, row.n, row.bar, _reached(row)


def _unmeasured(measure: str, bar: str) -> tuple[Any, ...]:
    return measure, None, None, None, 0, bar, "not measured here"


def _reached(row: BlindRow) -> str:
    if row.passed is None:
        return ""
    return ("yes" if _is_sure(row) else "yes, not sure") if row.passed else "no"


def _is_sure(row: BlindRow) -> bool:
    """Whether the whole interval is on the good side of the bar."""
    sign, limit = row.bar.split()
    return row.ci95[0] >= float(limit) if sign == ">=" else row.ci95[1] <= float(limit)


def _by_lab(cases: Sequence[Judged]) -> list[Block]:
    """Right answers in each lab and family: first for singles, both for pairs, nothing named otherwise."""
    if not cases:
        return [Paragraph("No case of this run could be made.")]
    groups = {lab.replace("_", " "): [case for case in cases if case.lab == lab] for lab in _in_order(cases, "lab")}
    groups |= {f"{name} family": [case for case in cases if case.family == name] for name in _in_order(cases, "family")}
    drawn = [_row(name, group) for name, group in groups.items()]
    caption = (
        "Right answers of all kinds: the hidden effect first, both of a pair, nothing named on nulls and for what is "
        "outside the catalogue."
    )
    columns = ("lab", "family", "singles", "first", "in the set", "pairs", "both", "nulls, outside", "nothing named")
    lines = []
    for lab in _in_order(cases, "lab"):
        for family in _in_order(cases, "family"):
            lines.append((lab, family, *_counts([case for case in cases if (case.lab, case.family) == (lab, family)])))
    return [shares(drawn, caption, "Right answers by lab and family"), Table("Cases by lab and family", columns, lines)]


def _row(name: str, group: Sequence[Judged]) -> ShareRow:
    hits, n = sum(right(case) for case in group), len(group)
    return ShareRow(name, hits / n, *clopper_pearson(hits, n), n)


def _counts(group: Sequence[Judged]) -> tuple[int, ...]:
    singles = [case for case in group if case.kind == "effect"]
    pairs = [case for case in group if case.kind == "pair"]
    others = [case for case in group if case.kind in ("null", "outside")]
    hits = (sum(map(first_right, singles)), sum(map(in_set, singles)), sum(map(right, pairs)), sum(map(right, others)))
    return len(singles), hits[0], hits[1], len(pairs), hits[2], len(others), hits[3]


def _by_effect(cases: Sequence[Judged]) -> list[Block]:
    singles = [case for case in cases if case.kind == "effect"]
    if not singles:
        return [Paragraph("No case of this run has a single effect.")]
    labs = _in_order(singles, "lab")
    lines = []
    for truth in sorted({case.truth for case in singles}):
        own = [case for case in singles if case.truth == truth]
        cells = [_first_of([case for case in own if case.lab == lab]) for lab in labs]
        lines.append((truth, *cells, _first_of(own), f"{sum(map(in_set, own))}/{len(own)}"))
    columns = ("hidden effect", *(lab.replace("_", " ") for lab in labs), "first, all labs", "in the set")
    return [Table("How often the hidden effect was named first", columns, lines, folded=False)]


def _first_of(cases: Sequence[Judged]) -> str:
    return f"{sum(map(first_right, cases))}/{len(cases)}" if cases else ""


def _misses(cases: Sequence[Judged]) -> list[Block]:
    missed = [case for case in cases if not right(case)]
    if not missed:
        return [Paragraph("None.")]
    taken = Counter((case.truth or "none", case.first or f"({case.verdict})", case.family, case.lab) for case in missed)
    counted = [(*key, number) for key, number in sorted(taken.items())]
    lines = [
        (case.truth or "none", case.verdict, case.said or None, case.reported or None, case.session, case.conditions)
        for case in missed
    ]
    return [
        Table("What was taken for what", ("hidden", "said first", "family", "lab", "cases"), counted),
        Table(
            "Every miss with its session",
            ("hidden", "verdict", "said", "reported set", "session", "lab's conditions"),
            lines,
            download=Download("cases.csv", "all cases"),
            folded=True,
        ),
    ]


def _in_order(cases: Sequence[Judged], field: str) -> list[str]:
    return sorted({getattr(case, field) for case in cases})
