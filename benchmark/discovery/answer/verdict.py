"""The verdict in one word and one sentence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from benchmark.discovery import criteria
from benchmark.physics import Effect
from benchmark.physics.setup_entry import effect_name, setup_key

NOTHING = ("cannot_tell", "no_discrepancy")
"""Verdicts by which no disagreement is answered."""


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
        Whether each condition alone tells the same parameters; None with one condition.
    level : float
    within : bool
        Whether the base, with its set-up as told where that would need an effect, misses by no more than the stated
        tolerance.
    tiny : bool
        Whether the base misses by less than finite elements and elastic laws are right to.
    taken_up : bool
        Whether a set-up as far off as people are usually wrong has taken up what the set-up as told would need.
    fitted : bool
        Whether the model with the effects misses by no more than the stated tolerance.
    worse : tuple of str
        Held-out conditions that the effects predict worse than the base.
    grows : bool
        Whether the held-out gap surely grows in some channel and none is surely missed by less.
    shrinks : bool
        Whether some channel is surely missed by less where it is held out.
    conditions : int
    undetermined : tuple of str
        Accepted effects whose strength the data do not tell.
    unsteady : tuple of str
        Accepted effects of rig or sensor whose parameters are others in each condition, which an instrument's are not.
    p_strained : float
        Of the base's having to bend so far beside the effects, by the priors of what was told of the set-up.
    shared : float
        Squared norm of what trials share row by row beside the effects, in standard errors above chance.
    p_shared : float
        Of sharing so much by chance.
    by_speed : bool
        Whether the trials' time shifts go with their speeds, as no clock's do: something may hide in them.
    parted : bool
        Whether the trials' gains part conditions, as no scatter of trials does.
    unseen : tuple of str
        Effects that were not looked for, since the trials' motion cannot show them; another one would.
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
    within: bool = True
    worse: tuple[str, ...] = ()
    grows: bool = False
    shrinks: bool = True
    conditions: int = 2
    undetermined: tuple[str, ...] = ()
    unsteady: tuple[str, ...] = ()
    p_strained: float = 1.0
    taken_up: bool = False
    tiny: bool = False
    fitted: bool = True
    shared: float = 0.0
    p_shared: float = 1.0
    by_speed: bool = False
    parted: bool = False
    unseen: tuple[str, ...] = ()

    @property
    def by_rows(self) -> bool:
        """Whether trials surely share a misfit row by row, beside what effects there are."""
        least = criteria.SHARED_BESIDE if self.effects else criteria.SHARED
        return self.p_shared < self.level and self.shared > least

    @property
    def by_cells(self) -> bool:
        """Whether cells surely do."""
        return (self.p_after if self.effects else max(self.p, self.p_cells)) < self.level

    @property
    def shares(self) -> bool:
        """Whether either does."""
        return self.by_rows or self.by_cells

    @property
    def p_any(self) -> float:
        """Of the disagreement that is answered."""
        return self.p if self.effects or self.by_cells else min(self.p, self.p_shared)

    @property
    def partial(self) -> bool:
        """Whether trials still disagree beside the effects, and something is surely left."""
        return self.shares and self.left > criteria.PARTLY

    @property
    def strained(self) -> bool:
        """Whether the base must surely bend further beside the effects than its set-up as told allows."""
        return self.p_strained < criteria.STRAINED

    @property
    def predicts(self) -> bool:
        """Whether the effects predict some of what was held out better than the base does.

        Surely, where they predict a condition worse: else what is gained elsewhere is no more than chance.
        """
        return len(self.worse) < self.conditions and not self.grows and (self.shrinks or not self.worse)


def verdict(facts: Facts) -> str:
    """One of `VERDICTS`."""
    if not facts.enough:
        return "cannot_tell"
    if not (facts.p < facts.level if facts.effects else facts.shares and not facts.tiny):
        return "no_discrepancy" if facts.within and not (facts.by_speed or facts.parted) else "cannot_tell"
    if not facts.effects or _fails(facts):
        return "outside_catalogue"
    if facts.lookalikes:
        return "instrument_first" if _mixed((*facts.effects, *facts.lookalikes)) else "lookalikes"
    if facts.worse or facts.strained or not facts.fitted or (facts.partial and facts.transfers is not None):
        return "partly_explained"
    return "named" if facts.transfers and facts.shrinks else "conditional"


def _fails(facts: Facts) -> bool:
    """Whether the accepted effects are no answer: they leave most, predict nothing, or are of no known strength.

    An instrument of other parameters in each condition that leaves something is none either.
    """
    leaves = facts.left > criteria.OUTSIDE and facts.shares
    unlike = bool(facts.unsteady) and facts.partial
    return leaves or unlike or not facts.predicts or bool(facts.undetermined)


def _nothing(facts: Facts) -> str:
    if facts.tiny and facts.shares:
        return (
            "What simulation and measurement disagree by is within the stated tolerance, and less than "
            f"{100.0 * criteria.LEAST_FORCE:g} % of the force, to which finite elements and elastic laws are right."
        )
    return (
        "No disagreement beyond the base model's own uncertainty is visible "
        f"(p = {facts.p_cells:.2g}), and what is left is within the stated tolerance."
    )


def _mixed(effects: Sequence[Effect]) -> bool:
    places = {effect.description.acts_on == "body" for effect in effects}
    return len(places) > 1


def statement(word: str, facts: Facts) -> str:
    """The answer in one sentence, and in another what was not looked for where trials disagree with the model."""
    names = " and ".join(effect_name(effect.slug) for effect in facts.effects)
    lacks = _lacks(facts.effects)
    alike = ", ".join(effect_name(effect.slug) for effect in facts.lookalikes)
    sentences = {
        "no_discrepancy": _nothing(facts),
        "cannot_tell": _untold(facts),
        "named": f"{lacks}: it holds on trials and on conditions that the fit has not seen.",
        "conditional": f"{lacks}, as far as these conditions tell; another rate, depth or tool must "
        "show that it holds there with the same parameters.",
        "lookalikes": f"{lacks}, or what these data cannot rule out in its place: {alike}.",
        "partly_explained": f"{lacks}, and something more: {_more(facts)}.",
        "outside_catalogue": _outside(names, facts),
        "instrument_first": f"{lacks}, but these data cannot tell set-up, rig or sensor from tissue here "
        f"(in question: {alike}): a calibration measurement comes first.",
    }
    hidden = facts.unseen if word not in NOTHING else ()
    beside = f" Not looked for, as these trials cannot show it: {', '.join(map(effect_name, hidden))}."
    return sentences[word] + (beside if hidden else "")


def _lacks(effects: Sequence[Effect]) -> str:
    """What is wrong of the set-up, and what the model lacks."""
    keys = [key for effect in effects if (key := setup_key(effect.slug)) is not None]
    names = " and ".join(effect_name(effect.slug) for effect in effects if setup_key(effect.slug) is None)
    setup = f"The set-up is not as told ({', '.join(keys)})"
    if not keys:
        return f"The model lacks {names}"
    return f"{setup}, and the model lacks {names}" if names else setup


def _untold(facts: Facts) -> str:
    """Why these trials cannot tell."""
    if not facts.enough:
        return (
            "These trials cannot tell: too few trials, or none repeated, to show a disagreement at the "
            f"{100.0 * facts.level:g} % level; nothing is named, and agreement is not shown either."
        )
    if facts.within and facts.parted:
        return (
            "These trials cannot tell: a stiffness is fitted to each, and these part the conditions, as no scatter of "
            "trials does: a machine that gives way, another tool or another specimen may hide in them; nothing is "
            "named, and agreement is not shown either."
        )
    if facts.within:
        return (
            "These trials cannot tell: a time shift is fitted to each, and these shifts go with the speed, as no "
            "clock's do: play or friction may hide in them; nothing is named, and agreement is not shown either."
        )
    if facts.taken_up:
        return (
            "These trials cannot tell: with the set-up as told the model misses them by more than the stated "
            "tolerance, and a set-up that is off by what people are usually wrong by explains that as well as an "
            "effect does; nothing is named, and agreement is not shown either."
        )
    return (
        f"These trials cannot tell: the model misses them by more than the stated tolerance, but they differ so much "
        f"that this may be chance (p = {facts.p:.2g}); nothing is named, and agreement is not shown either."
    )


def _more(facts: Facts) -> str:
    """What speaks against the effects being all."""
    if facts.worse:
        return f"held out, {', '.join(facts.worse)} is predicted worse with it than without"
    if facts.strained:
        return "beside it the set-up must still be another than was told"
    if not facts.fitted:
        return "with it in the model the trials are still missed by more than the stated tolerance"
    return f"{'cells' if facts.by_cells else 'row by row trials'} still disagree with it in the model"


def _outside(names: str, facts: Facts) -> str:
    start = "Simulation and measurement disagree, and no entry of the catalogue accounts for it"
    if not names:
        rows = ", though no cell's mean shows it: the trials share it row by row"
        return f"{start}{'' if facts.by_cells else rows}."
    why = ""
    if facts.undetermined:
        why = ", whose strength these data do not tell"
    elif facts.unsteady and facts.partial:
        why = ", but it would be another instrument in each condition"
    elif not facts.predicts:
        why = ", which predicts unseen data worse than the model without it"
    else:
        why = f", which leaves {100.0 * facts.left:.2g} % of what trials share"
    return f"{start}; the nearest is {names}{why}."
