"""The catalogue of physical effects that a model can lack: one file an effect."""

from benchmark.effects.effect import Card, EffectParameter
from benchmark.effects.registry import SLUGS, catalogue, load_effects
from benchmark.effects.term import Answer, Effect, Motion, Press, Readings, Spread, Surroundings

__all__ = [
    "SLUGS",
    "Answer",
    "Card",
    "Effect",
    "EffectParameter",
    "Motion",
    "Press",
    "Readings",
    "Spread",
    "Surroundings",
    "catalogue",
    "load_effects",
]
