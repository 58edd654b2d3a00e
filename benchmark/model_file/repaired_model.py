"""A model under repair as `model.toml` holds it, and the text of that file: base, added effects, evidence."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.files.units import dimension_of, format_quantity

SCHEMA = 1


@dataclass(frozen=True)
class Value:
    """A parameter in SI, with its 95 % interval where one is known."""

    value: float
    unit: str
    ci95: tuple[float, float] | None = None


@dataclass(frozen=True)
class AddedEffect:
    """An effect of the catalogue with its parameters by name."""

    slug: str
    parameters: Mapping[str, Value]

    def values(self) -> dict[str, float]:
        """The parameters in SI."""
        return {name: each.value for name, each in self.parameters.items()}


@dataclass(frozen=True)
class RepairedModel:
    """Content of `model.toml`.

    Attributes
    ----------
    name : str
        What messages call it: the path as given.
    tissue, model : str
        The base: tissue and "wave" or "fem".
    large_press : str
        Elastic law of the wave that the effects were found on top of: "linear" or "corrected".
    effects : tuple of AddedEffect
        In the order in which they were found.
    evidence : mapping
        Session, its fingerprint, verdict, gap: for people.
    own_effects : Path or None
        Where effects that are not of the catalogue come from.
    """

    name: str
    tissue: str
    model: str
    effects: tuple[AddedEffect, ...]
    evidence: Mapping[str, Any]
    large_press: str = "linear"
    own_effects: Path | None = None

    @property
    def slugs(self) -> tuple[str, ...]:
        """The names of the effects."""
        return tuple(effect.slug for effect in self.effects)


def model_toml(model: RepairedModel) -> str:
    """The file: quantities are text that reads back as the same number."""
    import tomli_w

    base = {"tissue": model.tissue, "model": model.model, "large_press": model.large_press}
    head = tomli_w.dumps({"schema": SCHEMA, "base": base})
    tail = tomli_w.dumps({"evidence": _without_nothing(model.evidence)})
    return "\n".join([head, *map(_effect, model.effects), tail])


def _effect(effect: AddedEffect) -> str:
    lines = ["[[effects]]", f"name = {json.dumps(effect.slug)}", "[effects.parameters]"]
    return "\n".join([*lines, *(f"{name} = {_value(value)}" for name, value in effect.parameters.items()), ""])


def _value(value: Value) -> str:
    """A parameter as an inline table; JSON text is TOML text."""
    dimension = dimension_of(value.unit)
    text = f"value = {json.dumps(format_quantity(value.value, dimension))}"
    if value.ci95 is not None and all(math.isfinite(end) for end in value.ci95):
        text += f", ci95 = {json.dumps([format_quantity(end, dimension) for end in value.ci95])}"
    return f"{{ {text} }}"


def _without_nothing(table: Mapping[str, Any]) -> dict[str, Any]:
    """TOML has no null and readers expect no NaN: what is not known is left out, numbers have six digits."""
    kept = {key: _plain(value) for key, value in table.items()}
    return {key: value for key, value in kept.items() if value is not None}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return _without_nothing(value)
    if isinstance(value, float):
        return float(f"{value:.6g}") if math.isfinite(value) else None
    return value
