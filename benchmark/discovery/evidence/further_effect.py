"""What a further effect must show: that it carries over, and is more than what the forms of those before miss."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.bent_form import bent
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.criteria import Settings
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.evidence.gains import (
    Gain,
    Scored,
    broad,
    conditions,
    gain,
    held_out,
    refitted_conditions,
)
from benchmark.discovery.evidence.parameter_evidence import steady
from benchmark.physics.setup_entry import setup_key


def further(current: Fit, evident: Sequence[Scored], settings: Settings, within: float = 0.0) -> list[Scored]:
    """Those of a round's candidates that carry over and are more than what the forms of the effects before miss.

    What those forms miss at most is worked out once; `within` is the gain that they may miss.
    """
    carried, forms = [s for s in evident if carries_over(s)], _own_forms(current)
    instead = held_out(bent(current, forms)) if carried and forms else None
    return [s for s in carried if beats_bent(s, settings, instead, within)]


def carries_over(scored: Scored) -> bool:
    """Whether a condition that the fit has not seen gains from the candidate, too.

    What an effect's form misses of the true one differs from condition to condition; a further effect that follows it
    helps trials whose mates it has seen, and no others. Where one condition has nearly all of the gain and the others
    do not speak against its parameters, as with a limit that only the deeper presses reach, no other one can tell.
    """
    if scored.transfer is None:
        return True
    groups = conditions(scored.fit)
    parts = np.array([max(float(scored.gain.each[groups == number].sum()), 0.0) for number in np.unique(groups)])
    if parts.max() > criteria.ONE_ALONE * parts.sum() and steady(scored.fit, scored.slug):
        return True
    asked = criteria.CARRIED * scored.gain.mean
    if scored.transfer.mean >= asked:
        return True
    groups = conditions(scored.fit)
    return gain(refitted_conditions(scored.fit), refitted_conditions(scored.under), groups).mean >= asked


def beats_bent(scored: Scored, settings: Settings, instead: Array | None = None, within: float = 0.0) -> bool:
    """Whether a further effect is more than what the forms of those before miss of the true ones.

    It must foretell trials surely better than they do by being off without it (`instead` (R,), where it is known). Or
    it must have its evidence where those forms may be off; that must be most of what it gains where they may not, or it
    must not foretell trials surely worse than they do without it. What gains no more than `within` has the first way
    alone: a form that is off by a share of what it adds misses the square of that share of what it gains.
    """
    forms = _own_forms(scored.under)
    if not forms:
        return True
    if instead is None:
        instead = held_out(bent(scored.under, forms))
    groups = conditions(scored.under)
    straight = gain(held_out(scored.fit), instead, groups)
    if straight.z > settings.accept_z and straight.mean > 0.0:
        return True
    if scored.gain.mean <= within:
        return False
    beside = gain(held_out(bent(scored.fit, forms)), instead, groups)
    if not over_trials(beside, settings):
        return False
    return beside.mean > criteria.MOSTLY_OWN * scored.gain.mean or straight.z > -settings.lookalike_z


def is_form_of_others(scored: Scored, settings: Settings) -> bool:
    """Whether an effect is no more than what the others' forms miss, and these surely foretell more without it."""
    forms = _own_forms(scored.under)
    if not forms:
        return False
    instead = held_out(bent(scored.under, forms))
    surely = gain(held_out(scored.fit), instead, conditions(scored.under)).z < -settings.lookalike_z
    return surely and not beats_bent(scored, settings, instead)


def over_trials(gained: Gain, settings: Settings) -> bool:
    """Whether held-out trials surely gain: by their scatter, or all but one together."""
    return gained.z >= settings.accept_z or broad(gained) > criteria.BROAD


def _own_forms(fitted: Fit) -> list[str]:
    """Slugs of the effects that have a form of their own; that of a set-up entry is the finite elements'."""
    return [effect.slug for effect in fitted.model.effects if setup_key(effect.slug) is None]
