"""Which effects: forward, then backward, then swaps, judged on held-out trials and held-out conditions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.stats import t as t_distribution

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.cells import within_tolerance
from benchmark.discovery.evidence.further_effect import (
    beats_bent,
    carries_over,
    further,
    is_form_of_others,
    over_trials,
)
from benchmark.discovery.evidence.gains import (
    Gain,
    Scored,
    broad,
    conditions,
    foretold,
    gain,
    held_out,
    score,
)
from benchmark.discovery.evidence.parameter_evidence import (
    determined,
    seen,
    strength_told,
    terms_told,
    told_parameters,
)
from benchmark.discovery.evidence.pool import Pool
from benchmark.discovery.evidence.shortlist import Screened, missing, screen
from benchmark.physics import Effect
from benchmark.physics.setup_entry import setup_key


@dataclass(frozen=True, eq=False)
class Selection:
    """The chosen fit (the base's where nothing was accepted), its steps and its look-alikes.

    `candidates` are those fitted, round by round, the best of a round first; `screened` all effects by what one step
    gains. `lookalikes`, `rivals` and `own` are by the slug of a chosen effect: who does as well in its place, their
    fits, and what it gains itself over the others. `withheld` are effects with all the evidence but that they do not
    carry over, or may be another form of the others: the catalogue has something like what is left, and does not name
    it.
    """

    base: Fit
    chosen: Fit
    steps: tuple[Scored, ...]
    candidates: tuple[Scored, ...]
    screened: tuple[Screened, ...]
    lookalikes: dict[str, tuple[str, ...]]
    rivals: dict[str, tuple[Fit, ...]]
    own: dict[str, Gain] = field(default_factory=dict)
    withheld: tuple[Scored, ...] = ()


def select(
    base: Fit, effects: Sequence[Effect], settings: Settings, work: Pool, first_screen: tuple[Screened, ...] = ()
) -> Selection:
    """Choose effects; `first_screen` is that of the base, where it is known."""
    current, ranked = base, first_screen
    withheld: tuple[Scored, ...] = ()
    steps: list[Scored] = []
    rounds: list[list[Scored]] = []
    for number in range(1, settings.most_effects + 1):
        taken = {effect.slug for effect in current.model.effects}
        rest = [effect for effect in effects if effect.slug not in taken and usable(base, effect)]
        if not rest:
            break
        if number > 1 or not ranked:
            ranked = screen(current, rest)
        first_screen = first_screen or ranked
        promising = _promising(ranked, criteria.REFINED if number == 1 else criteria.REFINED_LATER)
        scored = score(current, work.fits(f"round {number}", [(current, s.effect) for s in promising]), work.map)
        rounds.append(_enriched(current, scored, work))
        evident = [s for s in rounds[-1] if _evident(s, steps, settings)]
        within = criteria.FORM_OFF**2 * max((step.gain.mean for step in steps), default=0.0)
        accepted = further(current, evident, settings, within) if steps else evident
        if not accepted:
            withheld = tuple(evident)
            break
        steps.append(_simplest(accepted, effects))
        current = steps[-1].fit
    current, forms = _pruned(base, current, settings, work)
    current = _told(base, _swapped(base, current, rounds, settings, work), effects, settings, work)
    current, apart = _as_further_terms(base, current, settings, work)
    places = [_in_place(base, current, effect, rounds, settings, work) for effect in current.model.effects]
    tried = tuple(scored for each in rounds for scored in each)
    rivals = {slug: (*apart.get(slug, ()), *fits) for slug, fits, _ in places}
    own = {slug: gained for slug, _, gained in places}
    names = _names(rivals)
    return Selection(base, current, tuple(steps), tried, first_screen, names, rivals, own, (*withheld, *forms))


def ruled_out(selection: Selection, lost: AbstractSet[str]) -> Selection:
    """What is left once a measurement has ruled out effects: the chosen fit, or else its nearest look-alike."""
    kept = [fit for fit in (selection.chosen, *sum(selection.rivals.values(), ())) if not _slugs(fit) & lost]
    if not kept:
        return selection
    chosen, *others = kept
    if chosen is selection.chosen:
        rivals = {slug: tuple(fit for fit in fits if fit in others) for slug, fits in selection.rivals.items()}
        return replace(selection, rivals=rivals, lookalikes=_names(rivals))
    gone = _slugs(selection.chosen) - _slugs(chosen)
    without = held_out(selection.chosen) - sum(selection.own[slug].each for slug in gone)
    gained = gain(held_out(chosen), without, conditions(chosen))
    own = {slug: selection.own.get(slug, gained) for slug in _slugs(chosen)}
    rivals = {slug: tuple(fit for fit in others if slug not in _slugs(fit)) for slug in own}
    return replace(selection, chosen=chosen, rivals=rivals, lookalikes=_names(rivals), own=own)


def unchosen(selection: Selection) -> Selection:
    """The same search with nothing accepted: its candidates stand."""
    return replace(selection, chosen=selection.base, steps=(), lookalikes={}, rivals={}, own={}, withheld=())


def _names(rivals: Mapping[str, Sequence[Fit]]) -> dict[str, tuple[str, ...]]:
    """Look-alikes by the slug of a chosen effect: the last effect of each fit."""
    return {slug: tuple(dict.fromkeys(fit.model.effects[-1].slug for fit in fits)) for slug, fits in rivals.items()}


def _slugs(fit: Fit) -> set[str]:
    return {effect.slug for effect in fit.model.effects}


def first_gain(selection: Selection) -> float:
    """P of the first accepted effect's held-out gain, for all candidates of its round.

    By Student's t over trials, or by the bound exp(-g) on a density ratio e^g that has not seen the data.
    """
    if not selection.steps:
        return 1.0
    step = selection.steps[0]
    freedom = max(step.gain.each.size - np.unique(conditions(selection.base)).size, 1)
    tried = sum(1 for scored in selection.candidates if len(scored.slugs) == 1)
    by_trials, by_density = t_distribution.sf(step.gain.z, freedom), np.exp(-broad(step.gain))
    return float(min(1.0, tried * min(by_trials, by_density)))


def usable(base: Fit, effect: Effect) -> bool:
    """Whether the session's channels, motion and set-up can show an effect."""
    return not missing(base.model.problem.study, effect)


def _promising(ranked: Sequence[Screened], count: int) -> list[Screened]:
    top = ranked[0].won if ranked else 0.0
    return [s for k, s in enumerate(ranked[:count]) if k < 2 or s.won > criteria.PROMISING * top]


def _simplest(accepted: Sequence[Scored], effects: Sequence[Effect]) -> Scored:
    """The simplest of those that gain as much as the best, which no data tell apart.

    By the terms that the data tell of, then by those that the form may have, then by the catalogue's order.
    """
    places = {effect.slug: place for place, effect in enumerate(effects)}
    best = accepted[0].gain.mean
    ties = [s for s in accepted if s.gain.mean >= best - criteria.TIE * abs(best)]
    told = [s for s in ties if _whole_told(s)]

    def terms(scored: Scored) -> tuple[int, int, int]:
        effect = scored.fit.model.effects[-1]
        return told_parameters(scored.fit, effect), len(effect.names), places[scored.slug]

    return min(told or ties, key=terms)


def _evident(scored: Scored, steps: Sequence[Scored], settings: Settings) -> bool:
    """Whether a candidate has the evidence of trials, in markers too where it must, and beside others a strength."""
    effect = scored.fit.model.effects[-1]
    if not seen(scored.fit, effect) or (steps and not strength_told(scored.fit, effect)):
        return False
    return over_trials(scored.gain, settings) and scored.delta_bic < criteria.ACCEPT_BIC


def _enriched(current: Fit, scored: list[Scored], work: Pool) -> list[Scored]:
    """Effects near the top in their richer form, where BIC prefers it and the data tell how strong each part is.

    Not where they tell how strong the plain form is and no longer how strong the richer one is: a term for a delay of a
    few milliseconds beside a relaxation took its name from it.
    """
    if not scored:
        return scored
    top = scored[0].gain.mean
    near = [s for s in scored if s.gain.mean > criteria.RICHER_SHARE * top and s.gain.z >= criteria.RICHER_Z]
    pairs = [(s, effect) for s in near if (effect := s.fit.model.effects[-1].richer) is not None][: criteria.RICHER]
    richer = work.fits("second terms", [(current, effect) for _, effect in pairs])
    plain = [s.fit.model.effects[-1] for s, _ in pairs]
    told = [fit for fit, effect in zip(richer, plain, strict=True) if terms_told(fit, effect)]
    better = {s.slug: s for s in score(current, told, work.map)}
    chosen = []
    for s in scored:
        other = better.get(s.slug, s)
        surer = _whole_told(other) or not _whole_told(s)
        chosen.append(other if surer and other.delta_bic < s.delta_bic + criteria.RICHER_BIC else s)
    return sorted(chosen, key=lambda each: -each.gain.mean)


def _whole_told(scored: Scored) -> bool:
    return strength_told(scored.fit, scored.fit.model.effects[-1])


def rebuilt(base: Fit, effects: Sequence[Effect], work: Pool, stage: str) -> Fit:
    """Fit the base with several effects, one after the other."""
    return rebuilt_each(base, [effects], work, stage)[0]


def rebuilt_each(base: Fit, rows: Sequence[Sequence[Effect]], work: Pool, stage: str) -> list[Fit]:
    """`rebuilt` with each row of effects, side by side."""
    found = [base] * len(rows)
    for turn in range(max(map(len, rows))):
        going = [number for number, row in enumerate(rows) if turn < len(row)]
        made = work.fits(stage, [(found[number], rows[number][turn]) for number in going])
        for number, fit in zip(going, made, strict=True):
            found[number] = fit
    return found


def _pruned(base: Fit, current: Fit, settings: Settings, work: Pool) -> tuple[Fit, tuple[Scored, ...]]:
    """Drop what the others make superfluous and what is another form of a later one; the dropped of the second kind."""
    forms: list[Scored] = []
    while len(current.model.effects) > 1:
        owns = _owns(base, current, work)
        idle = [o for o in owns if not over_trials(o.gain, settings) or o.under.objective <= current.objective]
        others = [own for own in owns if own not in idle and is_form_of_others(own, settings)]
        if not idle and not others:
            break
        dropped = min((*idle, *others), key=lambda each: each.under.objective)
        forms += [own for own in others if own is dropped]
        current = dropped.under
    return current, tuple(forms)


def _owns(base: Fit, current: Fit, work: Pool) -> list[Scored]:
    """The chosen effects but the last, each with what it gains over the others alone."""
    effects = current.model.effects
    rows = [effects[:left] + effects[left + 1 :] for left in range(len(effects) - 1)]
    unders = rebuilt_each(base, rows, work, "backward")
    now, *densities = foretold([current, *unders], work.map)
    owns = [gain(now, density, conditions(current)) for density in densities]
    return [Scored(current, e.slug, own, None, 0.0, less) for e, own, less in zip(effects, owns, unders, strict=False)]


def _told(base: Fit, current: Fit, effects: Sequence[Effect], settings: Settings, work: Pool) -> Fit:
    """Go back a step while the data do not tell the strength of every effect beside the others.

    A further term of an effect may have stood for the others before these were there. Without it the strengths may be
    told; so it is left out first, where trials are foretold surely better so than without the last effect.
    """
    plain = {effect.slug: effect for effect in effects}
    while len(current.model.effects) > 1:
        untold = {effect.slug for effect in current.model.effects if not strength_told(current, effect)}
        if not untold:
            return current
        less = rebuilt(base, current.model.effects[:-1], work, "backward")
        forms = [plain[effect.slug] if effect.slug in untold else effect for effect in current.model.effects]
        if sum(len(form.names) for form in forms) < sum(len(effect.names) for effect in current.model.effects):
            simpler = rebuilt(base, forms, work, "backward")
            more = gain(held_out(simpler), held_out(less), conditions(current))
            if over_trials(more, settings) and all(strength_told(simpler, effect) for effect in forms):
                return simpler
        current = less
    return current


def _swapped(base: Fit, current: Fit, rounds: Sequence[Sequence[Scored]], settings: Settings, work: Pool) -> Fit:
    """With two effects or more, put others in their place and keep what gains more than a tie.

    The best rivals in the place of each, and pairs of their own; in the place of a set-up entry alone, pairs with
    another one, where trials say so. What comes in is a further effect beside the others, and must be more than another
    form of them, too.
    """
    chosen = current.model.effects
    alone = len(chosen) == 1 and setup_key(chosen[0].slug) is not None
    if not rounds or not (alone or len(chosen) > 1):
        return current
    swaps = _other_pairs(base, current, rounds, setup_alone=alone)
    if not alone:
        taken = {effect.slug for effect in chosen}
        rivals = [s.fit.model.effects[-1] for s in rounds[0] if s.slug not in taken][:2]
        rests = [[other for other in chosen if other is not effect] for effect in chosen]
        swaps = [*((under, rivals) for under in rebuilt_each(base, rests, work, "swaps")), *swaps]
    now, groups = held_out(current), conditions(current)
    best, density = current, float(now.sum())
    if not alone:
        density += criteria.TIE * max(density - float(held_out(base).sum()), 0.0)
    for under, incoming in swaps:
        for scored in score(under, work.fits("swaps", [(under, rival) for rival in incoming]), work.map):
            then = held_out(scored.fit)
            if float(then.sum()) <= density or not seen(scored.fit, scored.fit.model.effects[-1]):
                continue
            if not (carries_over(scored) and beats_bent(scored, settings)):
                continue
            if not alone or over_trials(gain(then, now, groups), settings):
                best, density = scored.fit, float(then.sum())
    return best


def _other_pairs(
    base: Fit, current: Fit, rounds: Sequence[Sequence[Scored]], *, setup_alone: bool
) -> list[tuple[Fit, list[Effect]]]:
    """The pairs that promise most by one step, each as the fit of its first effect and the second.

    Where two causes act at once, the effect that is taken first may be one that stands for both, beside which neither
    shows. So the search begins again with each that did nearly as well in its place, or with each set-up entry of these
    where `setup_alone`.
    """
    begun, top = criteria.BEGINS * rounds[0][0].gain.mean, current.model.effects[0].slug
    near = [s for s in rounds[0] if s.slug != top and s.gain.mean > begun]
    starts = [s for s in near if not setup_alone or setup_key(s.slug) is not None][: criteria.NEAREST]
    known = {s.slug: s.fit.model.effects[-1] for each in rounds[:2] for s in each}
    pairs: list[tuple[float, Fit, Effect]] = []
    for start in starts:
        seconds = screen(start.fit, [effect for slug, effect in known.items() if slug not in (start.slug, top)])
        pairs += [(base.objective - start.fit.objective + s.won, start.fit, s.effect) for s in seconds[:1]]
    pairs.sort(key=lambda pair: -pair[0])
    return [(fit, [effect]) for _, fit, effect in pairs[: criteria.OTHER_PAIRS]]


def _as_further_terms(
    base: Fit, current: Fit, settings: Settings, work: Pool
) -> tuple[Fit, dict[str, tuple[Fit, ...]]]:
    """One effect with more terms, each told, in place of it and another that the data do not tell from such terms.

    Fluid that leaves under tools of one size is a fading memory like any other. Beside the fit stands the one of both
    effects, by the slug of the one that stays. Where no such terms do as well, each must be told by itself to stand
    beside the other: what it adds to the force alone may be what the other's form misses of the true one.
    """
    chosen = {effect.slug: effect for effect in current.model.effects}
    for effect in chosen.values():
        whole = chosen.get(effect.further_terms_of)
        if whole is None:
            continue
        others = [other for other in chosen.values() if other not in (effect, whole)]
        groups, now = conditions(current), held_out(current)
        less = rebuilt(base, [*others, whole], work, "further terms")
        own = gain(now, held_out(less), groups)
        for form in whole.forms[1:]:
            instead = rebuilt(base, [*others, form], work, "further terms")
            if not (strength_told(instead, form) and terms_told(instead, whole)):
                continue
            lead = gain(now, held_out(instead), groups)
            if lead.z < settings.lookalike_z or lead.mean < criteria.CLOSE * own.mean:
                return instead, {whole.slug: (rebuilt(base, [*others, whole, effect], work, "further terms"),)}
        if not determined(current, effect):
            return less, {}
        if not determined(current, whole):
            return rebuilt(base, [*others, effect], work, "further terms"), {}
    return current, {}


def _in_place(
    base: Fit, current: Fit, effect: Effect, rounds: Sequence[Sequence[Scored]], settings: Settings, work: Pool
) -> tuple[str, tuple[Fit, ...], Gain]:
    """A chosen effect's slug, the fits of those that do as well in its place, best first, and its own gain.

    Its own gain is over the model with the other effects alone, and what a rival lacks is measured against that.
    """
    chosen = current.model.effects
    others, taken = [other for other in chosen if other is not effect], {each.slug for each in chosen}
    groups, now = conditions(current), held_out(current)
    under = rebuilt(base, others, work, "look-alikes") if others else base
    own = gain(now, held_out(under), groups)
    if others:
        made = work.fits("look-alikes", [(under, rival) for rival in _nearest(rounds, taken)])
    else:
        made = [s.fit for s in rounds[0] if s.slug not in taken]
    shown = [rival for rival in made if seen(rival, rival.model.effects[-1])]
    alike, fitted = [], within_tolerance(current)
    for rival, density in zip(shown, foretold(shown, work.map), strict=True):
        lead = gain(now, density, groups)
        close = _close(effect, rival.model.effects[-1]) if fitted else criteria.CLOSE_UNFITTED
        if lead.z < settings.lookalike_z or lead.mean < close * own.mean:
            alike.append((lead.mean, rival))
    alike.sort(key=lambda pair: pair[0])
    return effect.slug, tuple(rival for _, rival in alike), own


def _nearest(rounds: Sequence[Sequence[Scored]], taken: AbstractSet[str]) -> list[Effect]:
    """The best rivals of each round, which each look for another part of what is missing."""
    found: dict[str, Effect] = {}
    for each in rounds:
        left = [s.fit.model.effects[-1] for s in each if s.slug not in taken]
        found |= {effect.slug: effect for effect in left[: criteria.NEAREST] if effect.slug not in found}
    return list(found.values())


def _close(effect: Effect, rival: Effect) -> float:
    """Share of an effect's own gain that a rival may lack: more where an instrument stands against the tissue."""
    instrument = effect.description.acts_on != "body" and rival.description.acts_on == "body"
    return criteria.CLOSE_TISSUE if instrument else criteria.CLOSE
