"""Reading `model.toml`: strict, with units and bounds checked against what the catalogue says of each effect."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from benchmark.errors import InputError
from benchmark.files.schema import FileModel, Name, Schema, nearest, validated
from benchmark.files.sources import KeyPath, Source, read_toml
from benchmark.files.units import QuantityError, parse_quantity
from benchmark.model_file.model import AddedEffect, RepairedModel, Value
from benchmark.model_file.units import dimension_of, shown
from benchmark.physics.description import EffectDescription, EffectParameter


class _Base(FileModel):
    tissue: Name
    model: Literal["wave", "fem"]
    large_press: Literal["linear", "corrected"] = "linear"


class _Parameter(FileModel):
    value: str
    ci95: tuple[str, str] | None = None


class _Effect(FileModel):
    name: str
    parameters: dict[str, _Parameter | str] = Field(default_factory=dict)


class _File(FileModel):
    schema_: Annotated[Schema, Field(alias="schema")]
    base: _Base
    effects: tuple[_Effect, ...] = ()
    evidence: dict[str, Any] = Field(default_factory=dict)


def read_model(path: Path, cards: Mapping[str, EffectDescription]) -> RepairedModel:
    """Read a model file.

    Parameters
    ----------
    path : Path
        As `discover` writes it; a parameter may also be one text, NAME = "0.31".
    cards : mapping of str to EffectDescription
        The effects that are known, by slug.

    Raises
    ------
    InputError
        File, line, key, value and what is allowed.
    """
    table, source = read_toml(path, "model")
    if "schema" not in table:
        raise InputError(f"{path}: the key schema is missing; a model file begins with schema = 1.")
    file = validated(_File, table, source)
    effects = tuple(_effect(effect, place, cards, source) for place, effect in enumerate(file.effects))
    repeated = {effect.slug for effect in effects if sum(effect.slug == other.slug for other in effects) > 1}
    if repeated:
        raise InputError(f"{path}: the effect {min(repeated)} is there twice; each effect may be there once.")
    base = file.base
    return RepairedModel(str(path), base.tissue, base.model, effects, file.evidence, base.large_press)


def _effect(effect: _Effect, place: int, cards: Mapping[str, EffectDescription], source: Source) -> AddedEffect:
    at = ("effects", place)
    if effect.name not in cards:
        raise _wrong(
            source, (*at, "name"), f"the effect {effect.name!r} is not known; {nearest(effect.name, sorted(cards))}"
        )
    known = {parameter.name: parameter for parameter in cards[effect.name].parameters}
    for name in effect.parameters:
        if name not in known:
            where = (*at, "parameters", name)
            raise _wrong(source, where, f"{effect.name} has no such parameter; {nearest(name, known)}")
    missing = [name for name in known if name not in effect.parameters]
    if missing and not _optional(missing, effect):
        raise _wrong(source, (*at, "parameters"), f"{effect.name} needs the parameter {missing[0]}; it is missing")
    values = {
        name: _value(given, known[name], (*at, "parameters", name), source) for name, given in effect.parameters.items()
    }
    return AddedEffect(effect.name, values)


def _optional(missing: list[str], effect: _Effect) -> bool:
    """A second Prony term is left out as a whole where one was enough."""
    return all(name.endswith("_2") for name in missing) and not any(name.endswith("_2") for name in effect.parameters)


def _value(given: _Parameter | str, parameter: EffectParameter, at: KeyPath, source: Source) -> Value:
    texts = _Parameter(value=given) if isinstance(given, str) else given
    value = _number(texts.value, parameter, at, source)
    if not parameter.low <= value <= parameter.high:
        low, unit = shown(parameter.low, parameter.unit)
        high, _ = shown(parameter.high, parameter.unit)
        raise _wrong(
            source, at, f"{texts.value!r} is outside what is allowed: {f'{low:g} to {high:g} {unit}'.rstrip()}"
        )
    ends = None if texts.ci95 is None else tuple(_number(end, parameter, (*at, "ci95"), source) for end in texts.ci95)
    return Value(value, parameter.unit, None if ends is None else (ends[0], ends[1]))


def _number(text: str, parameter: EffectParameter, at: KeyPath, source: Source) -> float:
    try:
        return parse_quantity(text, dimension_of(parameter.unit))
    except QuantityError as error:
        raise _wrong(source, at, str(error)) from None


def _wrong(source: Source, path: KeyPath, text: str) -> InputError:
    shown_key = ".".join(f"[{part + 1}]" if isinstance(part, int) else part for part in path).replace(".[", "[")
    return InputError(f"{source.place(path, shown_key)}: {text.rstrip('.')}.")
