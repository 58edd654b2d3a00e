"""Reading `model.toml`: strict, with units and bounds as each effect declares them.

A quantity that has another name by now is read by its older one; what cannot be converted is refused with what to do.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from benchmark.errors import InputError
from benchmark.files.schema import FileModel, Name, Schema, nearest, validated
from benchmark.files.sources import KeyPath, Source, read_toml
from benchmark.files.units import QuantityError, dimension_of, parse_quantity, shown
from benchmark.model_file.repaired_model import AddedEffect, RepairedModel, Value
from benchmark.physics.description import EffectDescription, EffectParameter


class _Base(FileModel):
    tissue: Name
    model: Literal["wave", "fem"]
    large_press: Literal["linear", "corrected"] = "linear"


class _Parameter(FileModel):
    value: str
    ci95: tuple[str, str] | None = None

    @model_validator(mode="before")
    @classmethod
    def _alone(cls, given: Any) -> Any:
        """A value may stand alone, without its table."""
        return given if isinstance(given, Mapping) else {"value": given}


class _Effect(FileModel):
    name: str
    parameters: dict[str, _Parameter] = Field(default_factory=dict)


class _File(FileModel):
    schema_: Annotated[Schema, Field(alias="schema")]
    base: _Base
    effects: tuple[_Effect, ...] = ()
    evidence: dict[str, Any] = Field(default_factory=dict)


def read_model(path: Path, known: Mapping[str, EffectDescription]) -> RepairedModel:
    """Read a model file.

    Parameters
    ----------
    path : Path
        As `discover` writes it; a parameter may also be one text, NAME = "0.31".
    known : mapping of str to EffectDescription
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
    effects = tuple(_effect(effect, place, known, source) for place, effect in enumerate(file.effects))
    repeated = {effect.slug for effect in effects if sum(effect.slug == other.slug for other in effects) > 1}
    if repeated:
        raise InputError(f"{path}: the effect {min(repeated)} is there twice; each effect may be there once.")
    base = file.base
    return RepairedModel(str(path), base.tissue, base.model, effects, file.evidence, base.large_press)


def _effect(effect: _Effect, place: int, known: Mapping[str, EffectDescription], source: Source) -> AddedEffect:
    at = ("effects", place)
    if effect.name not in known:
        raise _wrong(
            source, (*at, "name"), f"the effect {effect.name!r} is not known; {nearest(effect.name, sorted(known))}"
        )
    description = known[effect.name]
    parameters = {parameter.name: parameter for parameter in description.parameters}
    older = {each.formerly: each for each in description.parameters if each.formerly}
    values: dict[str, Value] = {}
    for name, given in effect.parameters.items():
        where = (*at, "parameters", name)
        parameter = parameters.get(name) or older.get(name)
        if parameter is None:
            reason = dict(description.retired).get(name) or f"has no such parameter; {nearest(name, parameters)}"
            raise _wrong(source, where, f"{effect.name}: {reason}")
        if parameter.name in values:
            raise _wrong(source, where, f"{effect.name} has {parameter.name} already; give one of the two")
        values[parameter.name] = _value(given, parameter, where, source)
    missing = [name for name in parameters if name not in values]
    if missing and not description.may_end_before(missing):
        raise _wrong(source, (*at, "parameters"), f"{effect.name} needs the parameter {missing[0]}; it is missing")
    return AddedEffect(effect.name, values)


def _value(texts: _Parameter, parameter: EffectParameter, at: KeyPath, source: Source) -> Value:
    value = _number(texts.value, parameter, at, source)
    least, most = parameter.allowed
    if not least <= value <= most:
        low, unit = shown(least, parameter.unit)
        high, _ = shown(most, parameter.unit)
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
