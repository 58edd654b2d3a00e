"""What answers are worth: each case's truth against what the discovery said, and the table of a blind run.

The table has shares with Clopper-Pearson bounds against the bars, and who was taken for whom.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import beta

from benchmark.blind.cases import BlindCase
from benchmark.discovery.discovery_result import Discovery

NAMING = ("named", "conditional", "lookalikes", "instrument_first", "partly_explained")
"""Verdicts under which the effects of an answer are claimed."""

CONFIDENT = ("named", "conditional")
Interval = tuple[float, float]


@dataclass(frozen=True)
class Judged:
    """One finished case, as it stands in the journal and in cases.csv.

    Attributes
    ----------
    case, kind, truth : str
        `truth` has the hidden effects with + between, "" for none.
    seed : int
    session : str
        Its layout in words: specimen, conditions, markers, a bad trial.
    strength : float
        D of all hidden effects together.
    verdict : str
        "error" where the discovery raised.
    said : str
        The claimed effects, best first, with + between.
    reported : str
        The claimed effects and their look-alikes, each once, with + between.
    first_set : str
        The first effect and its look-alikes.
    p : float or None
    strongest : str
        "channel phase" where the hidden effects show most.
    place_found : bool or None
    place_f1 : float or None
        Over (channel, phase).
    gap_closed : float or None
        In the channel where the effect shows most, on a held-out condition.
    seconds : float
        Wall time of the discovery.
    remark : str
        The error, where there was one.
    """

    case: str
    kind: str
    truth: str
    seed: int
    session: str
    strength: float
    verdict: str
    said: str
    reported: str
    first_set: str
    p: float | None
    strongest: str
    place_found: bool | None
    place_f1: float | None
    gap_closed: float | None
    seconds: float
    remark: str = ""


def judge(case: BlindCase, answer: Discovery, seconds: float) -> Judged:
    """Compare an answer with the truth."""
    effects = answer.effects if answer.verdict in NAMING else ()
    said = [effect.slug for effect in effects]
    sets = [(effect.slug, *effect.lookalikes) for effect in effects]
    reported = dict.fromkeys(slug for each in sets for slug in each)
    found = {(place.channel, place.phase) for place in answer.where}
    strongest = case.cells.strongest
    return replace(
        _silent(case, answer.verdict, seconds),
        said="+".join(said),
        reported="+".join(reported),
        first_set="+".join(sets[0]) if sets else "",
        p=answer.p,
        place_found=None if strongest is None else strongest in found,
        place_f1=f1(found, set(case.cells.shows), set(case.cells.may_show)) if strongest else None,
        gap_closed=_gap_closed(answer, strongest[0]) if strongest and case.name.kind == "effect" else None,
    )


def failed(case: BlindCase, error: Exception, seconds: float) -> Judged:
    """A case whose discovery raised: nothing was said."""
    return replace(_silent(case, "error", seconds), remark=f"{type(error).__name__}: {error}")


def _silent(case: BlindCase, verdict: str, seconds: float) -> Judged:
    """A case of which nothing was said and no place was found."""
    strongest = case.cells.strongest
    return Judged(
        case=case.name.text,
        kind=case.name.kind,
        truth=case.name.slug,
        seed=case.name.seed,
        session=session_in_words(case),
        strength=case.strength,
        verdict=verdict,
        said="",
        reported="",
        first_set="",
        p=None,
        strongest=" ".join(strongest) if strongest else "",
        place_found=None if strongest is None else False,
        place_f1=None if strongest is None else 0.0,
        gap_closed=None,
        seconds=seconds,
    )


def f1(found: set[tuple[str, str]], true: set[tuple[str, str]], allowed: set[tuple[str, str]]) -> float:
    """Harmonic mean of precision and recall; what is only allowed counts neither way."""
    hits = len(found & true)
    wrong, missed = len(found - true - allowed), len(true - found)
    return 2.0 * hits / (2.0 * hits + wrong + missed) if hits else 0.0


def session_in_words(case: BlindCase) -> str:
    """Specimen, conditions, whether there are markers, a bad trial."""
    scene = case.scene
    shape = "told shape" if scene.body.shape.radius == 1.0 else "other shape"
    words = [
        scene.body.specimen.name,
        shape,
        f"{len(scene.plans)} conditions",
        "markers" if scene.grid else "force only",
    ]
    return ", ".join([*words, *([case.bad_trial] if case.bad_trial else [])])


def _gap_closed(answer: Discovery, channel: str) -> float | None:
    """Of the channel on a held-out condition; None where no condition was held out or nothing was to be closed."""
    gaps = [gap.closed for gap in answer.gap if gap.channel == channel and gap.held_out == "condition"]
    return gaps[0] if gaps else None


@dataclass(frozen=True)
class BlindRow:
    """A measure: its value with a 95 % interval over `n` cases, and its bar.

    Attributes
    ----------
    measure : str
    value : float
    ci95 : (low, high)
    n : int
    bar : str
        As in ">= 0.9"; "" where there is none.
    passed : bool or None
        None without a bar.
    """

    measure: str
    value: float
    ci95: Interval
    n: int
    bar: str
    passed: bool | None


def table(cases: Sequence[Judged]) -> tuple[BlindRow, ...]:
    """The rows of all measures for which there are cases."""
    effects = [case for case in cases if case.kind == "effect"]
    nulls = [case for case in cases if case.kind == "null"]
    pairs = [case for case in cases if case.kind == "pair"]
    outside = [case for case in cases if case.kind == "outside"]
    placed = [case for case in cases if case.place_found is not None and case.kind in ("effect", "pair")]
    named = [case for case in effects if case.reported]
    gaps = [case for case in effects if case.gap_closed is not None]
    rows = [
        _share("right name first", effects, lambda case: case.said.split("+")[0] == case.truth, ">= 0.9"),
        _share(
            "right name first, up to look-alikes",
            effects,
            lambda case: case.truth in case.first_set.split("+"),
            ">= 0.95",
        ),
        _share(
            "truth inside the reported set", effects, lambda case: case.truth in case.reported.split("+"), ">= 0.95"
        ),
        _average("mean size of the reported set", named, lambda case: len(case.reported.split("+")), "<= 1.6"),
        _share("effects named on nulls", nulls, lambda case: bool(case.said), "<= 0.02"),
        _share("nulls without a discrepancy", nulls, lambda case: case.verdict == "no_discrepancy", ""),
        _share("outside: wrong confident name", outside, lambda case: case.verdict in CONFIDENT, "<= 0.1"),
        _share("outside: flagged", outside, lambda case: case.verdict == "outside_catalogue", ">= 0.8"),
        _share("pairs: both named", pairs, _both_named, ">= 0.7"),
        _share("place contains the true one", placed, lambda case: bool(case.place_found), ">= 0.95"),
        _average("F1 over cells", placed, lambda case: case.place_f1 or 0.0, ">= 0.85"),
        _median("gap closed on a held-out condition", gaps, lambda case: case.gap_closed or 0.0, ">= 0.8"),
        _median("seconds a case", cases, lambda case: case.seconds, ""),
        _share("cases with an error", cases, lambda case: case.verdict == "error", ""),
    ]
    return tuple(row for row in rows if row.n)


def confusion(cases: Sequence[Judged]) -> dict[str, Counter[str]]:
    """For each truth ("none" for nulls) how often which name came first (or the verdict, where none did)."""
    out: dict[str, Counter[str]] = {}
    for case in cases:
        first = case.said.split("+")[0] or f"({case.verdict})"
        out.setdefault(case.truth or "none", Counter())[first] += 1
    return out


def verdicts(cases: Sequence[Judged]) -> Counter[str]:
    """How often each verdict was given."""
    return Counter(case.verdict for case in cases)


def clopper_pearson(hits: int, n: int, level: float = 0.95) -> Interval:
    """Exact interval of a share."""
    tail = 0.5 * (1.0 - level)
    low = float(beta.ppf(tail, hits, n - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1.0 - tail, hits + 1, n - hits)) if hits < n else 1.0
    return low, high


def _share(measure: str, cases: Sequence[Judged], right: Callable[[Judged], bool], bar: str) -> BlindRow:
    hits, n = sum(right(case) for case in cases), len(cases)
    if n == 0:
        return BlindRow(measure, 0.0, (0.0, 1.0), 0, bar, None)
    return BlindRow(measure, hits / n, clopper_pearson(hits, n), n, bar, _passed(hits / n, bar))


def _average(measure: str, cases: Sequence[Judged], value: Callable[[Judged], float], bar: str) -> BlindRow:
    return _statistic(measure, [value(case) for case in cases], bar, middle=False)


def _median(measure: str, cases: Sequence[Judged], value: Callable[[Judged], float], bar: str) -> BlindRow:
    return _statistic(measure, [value(case) for case in cases], bar, middle=True)


def _statistic(measure: str, values: Sequence[float], bar: str, *, middle: bool) -> BlindRow:
    """A mean or median with an interval by 2000 resamples of the cases."""
    if not values:
        return BlindRow(measure, 0.0, (0.0, 0.0), 0, bar, None)
    of = np.median if middle else np.mean
    data = np.array(values, dtype=np.float64)
    drawn = np.random.default_rng(0).integers(data.size, size=(2000, data.size))
    low, high = np.quantile(of(data[drawn], axis=1), [0.025, 0.975])
    value = float(of(data))
    return BlindRow(measure, value, (float(low), float(high)), data.size, bar, _passed(value, bar))


def _passed(value: float, bar: str) -> bool | None:
    if not bar:
        return None
    sign, limit = bar.split()
    return value >= float(limit) if sign == ">=" else value <= float(limit)


def _both_named(case: Judged) -> bool:
    return set(case.truth.split("+")) <= set(case.said.split("+"))
