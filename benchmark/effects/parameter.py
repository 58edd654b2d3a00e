"""Short-hand for the parameters on a card."""

from __future__ import annotations

from benchmark.effects.effect import EffectParameter


def linear(name: str, unit: str, low: float, high: float, meaning: str, *start: float) -> EffectParameter:
    """A parameter fitted as it is; without a start it begins where it does nothing, at zero or its lower bound."""
    return EffectParameter(name, unit, start or (max(low, 0.0),), low, high, False, meaning)


def logarithmic(name: str, unit: str, low: float, high: float, meaning: str, *start: float) -> EffectParameter:
    """A positive parameter fitted by its logarithm; without a start it begins at the middle of its range."""
    return EffectParameter(name, unit, start or ((low * high) ** 0.5,), low, high, True, meaning)
