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
class Card:
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
