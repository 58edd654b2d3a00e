"""What an answer is worth: one case's truth against what the discovery said."""

from __future__ import annotations

from dataclasses import dataclass, replace

from benchmark.blind.cases import BlindCase
from benchmark.discovery.discovery_result import Discovery

NAMING = ("named", "conditional", "lookalikes", "instrument_first", "partly_explained")
"""Verdicts under which the effects of an answer are claimed."""

CONFIDENT = ("named", "conditional")


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
