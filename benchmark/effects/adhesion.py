"""Adhesion: the tool is held on lift-off."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Effect, Surroundings, Values

CARD = Card(
    slug="adhesion",
    acts_on="body",
    sentence="The tissue sticks to the tool: lifting it takes a pull before it lets go.",
    equation="F = -f(|d|) above the surface until -F exceeds the pull-off force",
    source="K. Kendall 1971, J Phys D 4:1186",
    parameters=(linear("pull_off", "N", 0.0, 100.0, "force at which the tissue lets go"),),
)


def _body(values: Values, around: Surroundings) -> Mapping[str, Any]:
    from wavemodel.physics import Adhesion

    return {"adhesion": Adhesion(values["pull_off"])}


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    return tuple({"pull_off": share * around.peak_force} for share in (0.01, 0.03, 0.1, 0.3))


EFFECT = Effect(CARD, "pull_off", body=_body, starts=_starts)
