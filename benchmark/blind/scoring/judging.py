"""What answers are worth: each case's truth against what the discovery said, and the table of a blind run.

The table has shares with Clopper-Pearson bounds against the bars, and who was taken for whom.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from benchmark.blind.cases import BlindCase, CaseName
from benchmark.blind.scoring.measure_rows import BlindRow, average, median, share
from benchmark.discovery.discovery_result import Discovery

NAMING = ("named", "conditional", "lookalikes", "instrument_first", "partly_explained")
"""Verdicts under which the effects of an answer are claimed."""

CONFIDENT = ("named", "conditional")
SETUP = "setup."
IMPOSSIBLE = "not made"
"""Verdict of a case whose effect cannot be as strong as wanted in its lab; it counts nowhere."""


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
    family, lab, conditions : str
        Of the case; the lab's conditions in words.
    markers : bool
    trials : int
    setup_off : str
        Set-up entries that an answer may rightly name, with + between: what the session tells otherwise than it is.
    experiments : int
        That were done after the first answer.
    set_before : str
        The first effect and its look-alikes before them.
    unexplained : float or None
        D of the weakest hidden effect beside what the session does not state of its layers.
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
    family: str = "first"
    lab: str = "as_told"
    conditions: str = ""
    markers: bool = True
    trials: int = 10
    setup_off: str = ""
    experiments: int = 0
    set_before: str = ""
    unexplained: float | None = None

    @property
    def first(self) -> str:
        """The effect or set-up entry that was said first; "" where nothing was."""
        return self.said.split("+")[0]

    @property
    def named(self) -> tuple[str, ...]:
        """The effects that were said, without set-up entries."""
        return tuple(slug for slug in self.said.split("+") if slug and not slug.startswith(SETUP))


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


def looped(case: BlindCase, answers: Sequence[Discovery], experiments: int, seconds: float) -> Judged:
    """Compare the last answer of a closed loop, whose answers are given in turn, with the truth."""
    before = judge(case, answers[0], seconds).first_set
    return replace(judge(case, answers[-1], seconds), experiments=experiments, set_before=before)


def failed(case: BlindCase, error: Exception, seconds: float) -> Judged:
    """A case whose discovery raised: nothing was said."""
    return replace(_silent(case, "error", seconds), remark=f"{type(error).__name__}: {error}")


def unanswered(name: CaseName, verdict: str, reason: str) -> Judged:
    """A case that cannot be made, or whose process died."""
    return Judged(
        case=name.text,
        kind=name.kind,
        truth=name.slug,
        seed=name.seed,
        session="",
        strength=0.0,
        verdict=verdict,
        said="",
        reported="",
        first_set="",
        p=None,
        strongest="",
        place_found=None,
        place_f1=None,
        gap_closed=None,
        seconds=0.0,
        remark=reason,
        family=name.family,
        lab=name.lab,
    )


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
        family=case.name.family,
        lab=case.name.lab,
        conditions=case.scene.lab.in_words,
        markers=case.scene.grid is not None,
        trials=case.scene.repeats * len(case.scene.plans),
        setup_off="+".join(_setup_off(case)),
        unexplained=case.unexplained,
    )


def _setup_off(case: BlindCase) -> list[str]:
    """Keys of the set-up that are not as the session tells."""
    body, lab = case.scene.body, case.scene.lab
    keys = [f"{SETUP}tool.radius"] if body.shape.radius != 1.0 else []
    keys += [f"{SETUP}support.clamp"] if body.clamp != "plate" else []
    layers = [layer.name for layer in body.specimen.layers]
    if lab.thickness_error or case.name.wrong_layers:
        keys += [f"{SETUP}{layer}.thickness" for layer in layers]
    if lab.modulus_error or case.name.wrong_layers:
        keys += [f"{SETUP}{layer}.youngs_modulus" for layer in layers]
    return keys


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


def table(cases: Sequence[Judged]) -> tuple[BlindRow, ...]:
    """The rows of all measures for which there are cases."""
    cases = [case for case in cases if case.verdict != IMPOSSIBLE]
    effects = [case for case in cases if case.kind == "effect"]
    nulls = [case for case in cases if case.kind == "null"]
    pairs = [case for case in cases if case.kind == "pair"]
    outside = [case for case in cases if case.kind == "outside"]
    placed = [case for case in cases if case.place_found is not None and case.kind in ("effect", "pair")]
    named = [case for case in effects if case.reported]
    gaps = [case for case in effects if case.gap_closed is not None]
    rivals = [case for case in effects if "+" in case.set_before and case.truth in case.set_before.split("+")]
    rows = [
        share("right name first", effects, lambda case: case.first == case.truth, ">= 0.9"),
        share(
            "right name first, up to look-alikes",
            effects,
            lambda case: case.truth in case.first_set.split("+"),
            ">= 0.95",
        ),
        share("truth inside the reported set", effects, lambda case: case.truth in case.reported.split("+"), ">= 0.95"),
        average("mean size of the reported set", named, lambda case: len(case.reported.split("+")), "<= 1.6"),
        share("effects named on nulls", nulls, lambda case: bool(case.said), "<= 0.02"),
        share("nulls without a discrepancy", nulls, lambda case: case.verdict == "no_discrepancy", ""),
        share("outside: wrong confident name", outside, lambda case: case.verdict in CONFIDENT, "<= 0.1"),
        share("outside: flagged", outside, lambda case: case.verdict == "outside_catalogue", ">= 0.8"),
        share("pairs: both named", pairs, both_named, ">= 0.7"),
        share("rivals separated by experiments", rivals, lambda case: case.first_set == case.truth, ">= 0.95"),
        share("place contains the true one", placed, lambda case: bool(case.place_found), ">= 0.95"),
        average("F1 over cells", placed, lambda case: case.place_f1 or 0.0, ">= 0.85"),
        median("gap closed on a held-out condition", gaps, lambda case: case.gap_closed or 0.0, ">= 0.8"),
        median("seconds a case", cases, lambda case: case.seconds, ""),
        share("cases with an error", cases, lambda case: case.verdict == "error", ""),
    ]
    return tuple(row for row in rows if row.n)


def confusion(cases: Sequence[Judged]) -> dict[str, Counter[str]]:
    """For each truth ("none" for nulls) how often which name came first (or the verdict, where none did)."""
    out: dict[str, Counter[str]] = {}
    for case in cases:
        first = case.first or f"({case.verdict})"
        out.setdefault(case.truth or "none", Counter())[first] += 1
    return out


def verdicts(cases: Sequence[Judged]) -> Counter[str]:
    """How often each verdict was given."""
    return Counter(case.verdict for case in cases)


def both_named(case: Judged) -> bool:
    """Whether both effects of a pair were said."""
    return set(case.truth.split("+")) <= set(case.said.split("+"))
