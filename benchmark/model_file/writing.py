"""`model.toml` as text."""

from __future__ import annotations

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

    return tomli_w.dumps(
        {
            "schema": SCHEMA,
            "base": {"tissue": model.tissue, "model": model.model},
            "effects": [_effect(effect) for effect in model.effects],
            "evidence": _without_nothing(model.evidence),
        }
    )


def _effect(effect: AddedEffect) -> dict[str, Any]:
    return {"name": effect.slug, "parameters": {name: _value(value) for name, value in effect.parameters.items()}}


def _value(value: Value) -> dict[str, Any]:
    dimension = dimension_of(value.unit)
    table: dict[str, Any] = {"value": format_quantity(value.value, dimension)}
    if value.ci95 is not None and all(math.isfinite(end) for end in value.ci95):
        table["ci95"] = [format_quantity(end, dimension) for end in value.ci95]
    return table


def _without_nothing(table: Mapping[str, Any]) -> dict[str, Any]:
    """TOML has no null and readers expect no NaN: what is not known is left out."""
    return {
        key: _without_nothing(value) if isinstance(value, Mapping) else value
        for key, value in table.items()
        if value is not None and not (isinstance(value, float) and not math.isfinite(value))
    }
