"""What an entry of the catalogue says of itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class EffectParameter:
    """A parameter of an effect, in SI.

    Attributes
    ----------
    name : str
        As in `discovery.json` and `model.toml`.
    unit : str
        That pint reads; "" without dimension.
    start : tuple of float
        Where a fit begins, each in turn.
    low, high : float
        Bounds.
    logarithmic : bool
        Whether it is fitted by its logarithm (then low > 0).
    meaning : str
        One phrase.
    """

    name: str
    unit: str
    start: tuple[float, ...]
    low: float
    high: float
    logarithmic: bool
    meaning: str


@dataclass(frozen=True)
class EffectDescription:
    """What people read of an effect.

    Attributes
    ----------
    slug : str
    acts_on : str
        "drive", "body" or "observation".
    sentence : str
        What it is.
    equation : str
        Its term, in plain text.
    source : str
        Where the equation is from.
    parameters : tuple of EffectParameter
    """

    slug: str
    acts_on: Literal["drive", "body", "observation"]
    sentence: str
    equation: str
    source: str
    parameters: tuple[EffectParameter, ...]


def linear(name: str, unit: str, low: float, high: float, meaning: str, *start: float) -> EffectParameter:
    """A parameter fitted as it is; without a start it begins where it does nothing, at zero or its lower bound."""
    return EffectParameter(name, unit, start or (max(low, 0.0),), low, high, False, meaning)


def logarithmic(name: str, unit: str, low: float, high: float, meaning: str, *start: float) -> EffectParameter:
    """A positive parameter fitted by its logarithm; without a start it begins at the middle of its range."""
    return EffectParameter(name, unit, start or ((low * high) ** 0.5,), low, high, True, meaning)
