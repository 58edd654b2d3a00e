"""What the discovery must reach in labs that are not as told: measures over labs and families, with their bars."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence

from benchmark.blind.scoring.judging import CONFIDENT, IMPOSSIBLE, Judged, both_named
from benchmark.blind.scoring.measure_rows import BlindRow, average, clopper_pearson, median, share
from benchmark.blind.strength import SHOWS

INSTRUMENTS = frozenset(
    {"contact_gap", "off_centre_load", "machine_compliance", "backlash", "tool_inertia", "force_drift"}
    | {"force_saturation", "camera_latency", "perspective", "marker_scale_error"}
)
"""Effects of rig, sensor and camera."""
RIG = frozenset({"contact_gap", "off_centre_load", "machine_compliance", "backlash"})
SENSORS = INSTRUMENTS - RIG
ENOUGH_TRIALS = 6
"""With fewer no test reaches its level, and the honest answer to any session is that it cannot be told."""
REACHED = 0.8
"""Share of its cases in which each effect must be first or in the set."""
USUAL_TRIALS = 10


def lab_table(cases: Sequence[Judged]) -> tuple[BlindRow, ...]:
    """The rows over labs and families, in the order of the bars; those without a case have n = 0."""
    cases = [case for case in cases if case.verdict != IMPOSSIBLE]
    enough = [case for case in cases if case.trials >= ENOUGH_TRIALS]
    singles = [case for case in enough if case.kind == "effect"]
    printed, off = _of_lab(singles, "printed"), _of_lab(singles, "as_labs_are")
    clamped = _of_lab(enough, "clamped_otherwise")
    bare = [case for case in singles if not case.markers]
    nulls, pairs = [case for case in cases if case.kind == "null"], [case for case in enough if case.kind == "pair"]
    tissue = [case for case in singles if case.truth not in INSTRUMENTS]
    usual = [case for case in enough if case.markers and case.trials == USUAL_TRIALS]
    few = [case for case in cases if case.trials < ENOUGH_TRIALS]
    return (
        share("printed: right name first", printed, first_right, ">= 0.9"),
        share("printed: first or a look-alike of it", printed, alike_right, ">= 0.95"),
        share("printed, if it can show: first", _seen(printed), first_right, ""),
        share("printed, if it can show: look-alike", _seen(printed), alike_right, ""),
        share("clamp: right name or set-up first", _singles(clamped), _right_or_setup, ">= 0.75"),
        share("clamp: wrong instrument, confident", clamped, _wrongly(INSTRUMENTS), "<= 0"),
        share("as labs are: right name first", off, first_right, ">= 0.75"),
        share("as labs are: first or a look-alike", off, alike_right, ">= 0.9"),
        share("nulls named, all labs", nulls, lambda case: bool(case.named), "<= 0.01"),
        share("nulls: set-up said that is as told", nulls, _wrong_setup, ""),
        share("without markers: right name first", bare, first_right, ">= 0.75"),
        share("without markers: in the set", bare, in_set, ">= 0.92"),
        _effects_reached(singles),
        share("tissue: sensor, confident", tissue, _wrongly(SENSORS), "<= 0"),
        share("pairs: both named, all labs", pairs, both_named, ">= 0.8"),
        share("pairs, if both can show: both named", _seen(pairs), both_named, ""),
        share("outside: confident wrong, all labs", _outside(enough), _wrongly(None), "<= 0.05"),
        median("seconds, ten trials with markers", usual, lambda case: case.seconds, "<= 30"),
        share("fewer than six trials: something named", few, lambda case: bool(case.said), ""),
        average("effects and look-alikes said on singles", singles, _size, ""),
    )


def first_right(case: Judged) -> bool:
    """Whether the hidden effect was said first."""
    return case.first == case.truth


def alike_right(case: Judged) -> bool:
    """Whether it was said first or is a look-alike of what was."""
    return case.truth in case.first_set.split("+")


def in_set(case: Judged) -> bool:
    """Whether it was said at all, or is a look-alike of what was."""
    return case.truth in case.reported.split("+")


def right(case: Judged) -> bool:
    """Whether the answer is right for the kind of case: named first, both named, or nothing named."""
    if case.kind == "effect":
        return first_right(case)
    return both_named(case) if case.kind == "pair" else not case.named


def _right_or_setup(case: Judged) -> bool:
    return first_right(case) or (bool(case.first) and case.first in case.setup_off.split("+"))


def _wrong_setup(case: Judged) -> bool:
    """Whether a set-up entry was said that is as told."""
    said = {slug for slug in case.said.split("+") if slug} - set(case.named)
    return bool(said - set(case.setup_off.split("+")))


def _wrongly(of: frozenset[str] | None) -> Callable[[Judged], bool]:
    """Whether an effect (of these) that is not hidden was said with confidence."""

    def said(case: Judged) -> bool:
        wrong = set(case.named) - set(case.truth.split("+"))
        return case.verdict in CONFIDENT and bool(wrong if of is None else wrong & of)

    return said


def _effects_reached(singles: Sequence[Judged]) -> BlindRow:
    """The share of effects that are first or in the set in enough of their cases."""
    by_truth: dict[str, list[bool]] = defaultdict(list)
    for case in singles:
        by_truth[case.truth].append(in_set(case))
    reached = [sum(hits) >= REACHED * len(hits) for hits in by_truth.values()]
    hits, n = sum(reached), len(reached)
    if not n:
        return BlindRow("effects with 80 % in the set", 0.0, (0.0, 1.0), 0, ">= 1", None)
    return BlindRow("effects with 80 % in the set", hits / n, clopper_pearson(hits, n), n, ">= 1", hits == n, True)


def _seen(cases: Sequence[Judged]) -> list[Judged]:
    """Cases whose effects all show beside what their sessions do not state of the layers."""
    return [case for case in cases if case.unexplained is not None and case.unexplained >= SHOWS]


def _of_lab(cases: Sequence[Judged], lab: str) -> list[Judged]:
    return [case for case in cases if case.lab == lab]


def _singles(cases: Sequence[Judged]) -> list[Judged]:
    return [case for case in cases if case.kind == "effect"]


def _outside(cases: Sequence[Judged]) -> list[Judged]:
    return [case for case in cases if case.kind == "outside"]


def _size(case: Judged) -> float:
    return float(len([slug for slug in case.reported.split("+") if slug]))
