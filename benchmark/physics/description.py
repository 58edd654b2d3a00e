"""How an effect is declared, once: what people read of it, its parameters, and how a scenario states them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, TypeAlias

Sign: TypeAlias = Literal["unloading", "hold", "second_rate", "lift_off", "interface", "free_force"]
SIGNS = MappingProxyType[Sign, str](
    {
        "unloading": "unloading",
        "hold": "a hold",
        "second_rate": "a second rate",
        "lift_off": "a lift-off",
        "interface": "a second layer or a clamp",
        "free_force": "a force that answers a depth (here it was prescribed, and stands because it was held)",
    }
)
"""What a session's motion, drive or set-up may have, in words, without which some effects cannot show."""


@dataclass(frozen=True)
class Option:
    """A parameter as a key of a scenario's `[physics]`: what may be written, and what holds where it is left out.

    Attributes
    ----------
    low, high : float
        What is allowed, SI; a fit searches within the narrower bounds of its parameter.
    above : bool
        Whether the lower bound itself is excluded.
    default : float or None
        What holds beside the effect's other keys where this one is left out; None: the effect needs it.
    key : str
        Its name in `[physics]`; "" where that is the parameter's own.
    example : str
        A value that one could give, as it is written.
    """

    low: float
    high: float
    above: bool = False
    default: float | None = None
    key: str = ""
    example: str = ""


@dataclass(frozen=True)
class EffectParameter:
    """A parameter of an effect, in SI.

    Attributes
    ----------
    name : str
        As in `discovery.json`, `model.toml` and, with an `option`, in a scenario's `[physics]`.
    unit : str
        That pint reads; "" without dimension.
    start : tuple of float
        Where a fit begins, each in turn.
    low, high : float
        Bounds of a fit.
    logarithmic : bool
        Whether it is fitted by its logarithm (then low > 0).
    meaning : str
        One phrase.
    option : Option or None
        How a scenario states it; None where it tells of markers or rate alone.
    formerly : str
        Name of the same quantity in older model files; "" without.
    stated : (float, float) or None
        Bounds of what a model file may state, where a fit searches less; see `allowed`.
    """

    name: str
    unit: str
    start: tuple[float, ...]
    low: float
    high: float
    logarithmic: bool
    meaning: str
    option: Option | None = None
    formerly: str = ""
    stated: tuple[float, float] | None = None

    @property
    def allowed(self) -> tuple[float, float]:
        """Bounds of what a model file may state."""
        return self.stated or (self.low, self.high)

    @property
    def key(self) -> str | None:
        """Its name in a scenario's `[physics]`; None where it has none."""
        return None if self.option is None else self.option.key or self.name


@dataclass(frozen=True)
class EffectDescription:
    """What people read of an effect.

    Attributes
    ----------
    slug : str
    acts_on : str
        "drive", "body" or "observation"; "setup" for an entry of the set-up.
    sentence : str
        What it is.
    equation : str
        Its term, in plain text.
    source : str
        Where the equation is from.
    parameters : tuple of EffectParameter
    options : tuple of EffectParameter
        Further keys of `[physics]` for the same physics, which a model has by itself and no fit searches.
    in_wave, in_fem : str
        How the wave and the FEM carry it; "" where they do not.
    retired : tuple of (str, str)
        Parameters of older model files that cannot be converted, and what to do instead.
    needs : tuple of tuples of str
        What trials must have to show it, one of each tuple; without it nothing tells it from the base's own form.
    may_lack : tuple of tuples of str
        Parameters of each further term of its richer forms; a model file leaves out the last ones, each whole, where a
        plainer form is meant.
    """

    slug: str
    acts_on: Literal["drive", "body", "observation", "setup"]
    sentence: str
    equation: str
    source: str
    parameters: tuple[EffectParameter, ...]
    options: tuple[EffectParameter, ...] = ()
    in_wave: str = ""
    in_fem: str = ""
    retired: tuple[tuple[str, str], ...] = ()
    needs: tuple[tuple[Sign, ...], ...] = ()
    may_lack: tuple[tuple[str, ...], ...] = ()

    def may_end_before(self, missing: Collection[str]) -> bool:
        """Whether a plainer form has all but these parameters."""
        tails = [[name for term in self.may_lack[first:] for name in term] for first in range(len(self.may_lack))]
        return any(set(missing) == set(tail) for tail in tails)

    @property
    def keys(self) -> dict[str, EffectParameter]:
        """Its keys in a scenario's `[physics]`."""
        return {key: each for each in (*self.parameters, *self.options) if (key := each.key) is not None}


def option(name: str, unit: str, low: float, high: float, meaning: str) -> EffectParameter:
    """A key of `[physics]` that no fit searches."""
    return EffectParameter(name, unit, (), low, high, False, meaning, Option(low, high))


def linear(
    name: str,
    unit: str,
    low: float,
    high: float,
    meaning: str,
    *start: float,
    option: Option | None = None,
    formerly: str = "",
    stated: tuple[float, float] | None = None,
) -> EffectParameter:
    """A parameter fitted as it is; without a start it begins where it does nothing, at zero or its lower bound."""
    return EffectParameter(name, unit, start or (max(low, 0.0),), low, high, False, meaning, option, formerly, stated)


def logarithmic(
    name: str,
    unit: str,
    low: float,
    high: float,
    meaning: str,
    *start: float,
    option: Option | None = None,
    formerly: str = "",
    stated: tuple[float, float] | None = None,
) -> EffectParameter:
    """A positive parameter fitted by its logarithm; without a start it begins at the middle of its range."""
    first = start or ((low * high) ** 0.5,)
    return EffectParameter(name, unit, first, low, high, True, meaning, option, formerly, stated)
