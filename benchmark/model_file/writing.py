"""`model.toml` as text."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from benchmark.files.units import format_quantity
from benchmark.model_file.model import AddedEffect, RepairedModel, Value
from benchmark.model_file.units import dimension_of

SCHEMA = 1


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
