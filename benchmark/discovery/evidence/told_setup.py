"""Whether an answer on the set-up as told stands against a set-up that is off by no more than people are wrong.

A base that may be off in every thickness and modulus takes up much of what a smooth effect of the body does; one that
is trusted to the last digit takes the error of a set-up for an effect. So effects are looked for on the set-up as told,
and what is found must hold against the other base: that base must not gain by moving once the effects are there, and
without any one of them it must not do as well by moving alone, or better with another effect in its place. Otherwise
the search is made on the base that moves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import first_guess
from benchmark.discovery.base.effect_model import EffectModel, Fit, fit
from benchmark.discovery.base.setup_priors import is_setup
from benchmark.discovery.evidence.gains import broad, foretold, held_out
from benchmark.discovery.evidence.parameter_evidence import seen
from benchmark.discovery.evidence.pool import Pool
from benchmark.discovery.evidence.selection import Selection, rebuilt_each, usable
from benchmark.discovery.evidence.shortlist import screen
from benchmark.physics import Effect
from benchmark.physics.setup_entry import effect_name, setup_key

SHOWN_MOVE = 0.5
"""Of a set-up parameter's standard deviation, from which it is told to have moved. First choice."""


def on_told(moving: Fit, told: Mapping[str, float]) -> Fit:
    """The base of a fit with the set-up as told: only the keys of `told` may be others, by their standard deviations.

    The fit itself where it moves no more than that. A set-up that went far has taken the other nuisances with it to
    where no step leads back, so that it is fitted from the first guess, too, and the better fit is taken.
    """
    problem = moving.model.problem
    if set(problem.setup) <= set(told):
        return moving
    fixed = replace(problem, setup={key: size for key, size in told.items() if key in problem.setup})
    kept = [k for k, name in enumerate(problem.shapes) if not is_setup(name) or name in fixed.setup]
    model = EffectModel(fixed, ())
    starts = ((moving.vector[kept], moving.nuisance), first_guess(fixed))
    return min((fit(model, *start, most=8) for start in starts), key=lambda each: each.objective)


def stands(chosen: Fit, told: Fit, moving: Fit, known: Sequence[Effect], work: Pool) -> bool:
    """Whether the effects of a fit on the set-up as told hold against the base that moves; so does no effect at all.

    Where effects gain much, their form is what leaves most: a base that moves follows some of it, so that a small share
    of what they gain does not count. Nor may that base foretell more with one of `known` in the place of one of them.
    """
    effects = chosen.model.effects
    if not effects:
        return True
    found = float(held_out(chosen).sum())
    if found - float(held_out(moving).sum()) < criteria.OVER_SETUP:
        return False
    rows = [effects[:left] + effects[left + 1 :] for left in range(len(effects))]
    rebuilt = rebuilt_each(moving, [*rows, effects], work, "set-up")
    *less, whole = foretold(rebuilt, work.map)
    if any(found - float(each.sum()) < criteria.OVER_SETUP for each in less):
        return False
    slack = max(criteria.OVER_SETUP, criteria.TIE * (found - float(held_out(told).sum())))
    if float(whole.sum()) - found >= slack:
        return False
    instead = _others_in_place(chosen, rebuilt[:-1], known, work)
    return all(float(each.sum()) - found < slack for each in foretold(instead, work.map))


def _others_in_place(chosen: Fit, without: Sequence[Fit], known: Sequence[Effect], work: Pool) -> list[Fit]:
    """Of each fit that lacks one of the chosen effects, that with the most promising other one, where it comes near."""
    taken = {effect.slug for effect in chosen.model.effects}
    pairs = []
    for less in without:
        first = screen(less, [each for each in known if each.slug not in taken and usable(less, each)])[:1]
        near = less.objective - chosen.objective - criteria.OVER_SETUP
        pairs += [(less, each.effect) for each in first if each.won > near]
    return [each for each in work.fits("set-up", pairs) if seen(each, each.model.effects[-1])]


def setup_first(told: Selection) -> bool:
    """Whether what was found on the set-up as told is that the set-up is another, on good evidence.

    Then that is the answer, with what looks like it, though a base that may be so far off needs none.
    """
    first = told.steps[0] if told.steps else None
    return first is not None and setup_key(first.slug) is not None and broad(first.gain) > criteria.BROAD


def _instead(told: Selection) -> list[str]:
    """The effect that does best in the place of each set-up entry, where one does as well."""
    entries = [effect.slug for effect in told.chosen.model.effects if setup_key(effect.slug) is not None]
    alike = ([slug for slug in told.lookalikes[entry] if setup_key(slug) is None] for entry in entries)
    return list(dict.fromkeys(each[0] for each in alike if each))


def taken_up(told: Selection, moving: Selection) -> tuple[str, ...]:
    """A remark where effects that the set-up as told would need are gone on one that moves: neither is shown.

    Where another effect came in, that may have taken their place. A set-up exactly as told would need what looks like
    one of its entries in that one's place.
    """
    needed = [effect.slug for effect in told.chosen.model.effects if setup_key(effect.slug) is None]
    found = [effect.slug for effect in moving.chosen.model.effects]
    gone = [slug for slug in (*needed, *_instead(told)) if slug not in found]
    if not gone or not set(found) <= set(needed):
        return ()
    base, names = moving.base, " and ".join(map(effect_name, gone))
    beside = f" beside {' and '.join(map(effect_name, found))}" if found else ""
    problem = base.model.problem
    moved = [
        name
        for (name, size), value in zip(problem.shape_priors.items(), base.vector, strict=False)
        if name in problem.setup and abs(value) > SHOWN_MOVE * size
    ]
    return (
        f"a set-up exactly as told would need {names}{beside}; one that is off by what people are usually wrong by "
        f"({', '.join(moved) or 'everything a little'}) explains the trials as well, and these data do not tell which: "
        'state how well the set-up is known, as in "4 mm +/- 1 %", or calibrate',
    )
