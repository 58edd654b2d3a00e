"""The verdict in one word and one sentence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from benchmark.discovery import criteria
from benchmark.physics import Effect


@dataclass(frozen=True)
class Facts:
    """What the verdict rests on.

    Attributes
    ----------
    p : float
        Of any disagreement, along the effects' directions too.
    p_cells : float
        Of any disagreement in the cells, which is what speaks where no effect does.
    enough : bool
        Whether the trials are such that the test can reach its level.
    effects : tuple of Effect
        Accepted.
    lookalikes : tuple of Effect
        Of any accepted effect.
    left : float
        Share of the disagreement in the cells that the effects leave.
    p_after : float
        Of any disagreement with the effects in the model.
    transfers : bool or None
        Whether the effects gain on held-out conditions, their parameters constant; None with one condition.
    level : float
    """

    p: float
    p_cells: float
    enough: bool
    effects: tuple[Effect, ...]
    lookalikes: tuple[Effect, ...]
    left: float
    p_after: float
    transfers: bool | None
    level: float


def verdict(facts: Facts) -> str:
    """One of `VERDICTS`."""
    if not facts.enough:
        return "cannot_tell"
    if facts.p >= facts.level:
        return "no_discrepancy"
    if not facts.effects:
        return "outside_catalogue" if facts.p_cells < facts.level else "no_discrepancy"
    if facts.left > criteria.OUTSIDE and facts.p_after < facts.level:
        return "outside_catalogue"
    if facts.lookalikes:
        return "instrument_first" if _mixed((*facts.effects, *facts.lookalikes)) else "lookalikes"
    if facts.transfers is None:
        return "conditional"
    if facts.p_after < facts.level and facts.left > criteria.PARTLY:
        return "partly_explained"
    return "named" if facts.transfers else "conditional"


def _mixed(effects: Sequence[Effect]) -> bool:
    places = {effect.description.acts_on == "body" for effect in effects}
    return len(places) > 1


def statement(word: str, facts: Facts) -> str:
    """The answer in one sentence."""
    names = " and ".join(effect.slug.replace("_", " ") for effect in facts.effects)
    alike = ", ".join(effect.slug.replace("_", " ") for effect in facts.lookalikes)
    sentences = {
        "no_discrepancy": "No disagreement beyond the base model's own uncertainty is visible "
        f"(p = {facts.p_cells:.2g}).",
        "cannot_tell": "These trials cannot tell: too few trials, or none repeated, to show a disagreement at the "
        f"{100.0 * facts.level:g} % level; nothing is named, and agreement is not shown either.",
        "named": f"The model lacks {names}: it holds on trials and on conditions that the fit has not seen.",
        "conditional": f"The model lacks {names}, as far as these conditions tell; another rate, depth or tool must "
        "show that it holds there with the same parameters.",
        "lookalikes": f"The model lacks {names}, or what these data cannot tell from it: {alike}.",
        "partly_explained": f"The model lacks {names}, and something more: cells still disagree with it in the model.",
        "outside_catalogue": _outside(names),
        "instrument_first": f"The model lacks {names}, but an effect of rig or sensor cannot be told from one of the "
        f"tissue ({alike}): a calibration measurement comes first.",
    }
    return sentences[word]


def _outside(names: str) -> str:
    start = "Simulation and measurement disagree, and no entry of the catalogue accounts for it"
    return f"{start}; the nearest is {names}." if names else f"{start}."
