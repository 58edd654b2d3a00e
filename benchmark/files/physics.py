"""The scenario's `[physics]`: what the body does beyond the laws of its layers, as `benchmark.physics` declares it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import create_model, model_validator

from benchmark.files.quantities import Bounds, Number, Quantity, problem
from benchmark.files.schema import FileModel
from benchmark.files.units import dimension_of, shown
from benchmark.physics import EffectDescription, EffectParameter, option_effects


class _Options(FileModel):
    """Rules over several keys."""

    @model_validator(mode="after")
    def _options_are_complete(self) -> Self:
        for effect in option_effects():
            given = [key for key in effect.description.keys if getattr(self, key) is not None]
            for key, words in _incomplete(effect.description.keys, given):
                raise problem(words, key=key)
        return self


def _incomplete(keys: Mapping[str, EffectParameter], given: list[str]) -> list[tuple[str, str]]:
    """Keys of an effect that are wrong as they stand, and why."""
    needed = {key: each.option for key, each in keys.items() if each.option and _belongs(each) and not _rests(each)}
    missing = [key for key in needed if key not in given]
    wrong = []
    for key in given:
        if missing and key in needed:
            wrong.append((missing[0], f"{key} needs it; give both or neither"))
        elif missing and _belongs(keys[key]):
            option = needed[missing[0]]
            example = option.example if option else ""
            text = f"it has no meaning without {missing[0]}; give {missing[0]}, such as {example}, too"
            wrong.append((key, text))
    return wrong


def _belongs(parameter: EffectParameter) -> bool:
    """Whether a key acts only beside the effect's others; one that no fit searches stands alone."""
    return bool(parameter.start)


def _rests(parameter: EffectParameter) -> bool:
    return parameter.option is not None and parameter.option.default is not None


def _field(parameter: EffectParameter) -> tuple[Any, None]:
    """A key that may be left out, with its unit and bounds."""
    option = parameter.option
    assert option is not None, "a key of a scenario has an option"
    bounds = Bounds(option.low, option.high, option.above)
    if not parameter.unit:
        return Annotated[float, Number(f"{option.low:g} to {option.high:g}", bounds)] | None, None
    return Annotated[float, Quantity(dimension_of(parameter.unit), bounds)] | None, None


def _meaning(effect: EffectDescription, key: str) -> str:
    """What a key is: its unit, what it goes with, and what holds without it."""
    parameter = effect.keys[key]
    option = parameter.option
    text = parameter.meaning[0].upper() + parameter.meaning[1:] + (f", {parameter.unit}" if parameter.unit else "")
    if option is not None and option.default:
        default, unit = shown(option.default, parameter.unit)
        return f"{text}; without it {default:g} {unit}".rstrip() + f" ({effect.slug})."
    others = [name for name, each in effect.keys.items() if name != key and _belongs(each) and not _rests(each)]
    beside = f"; with {' and '.join(others)}" if others and _belongs(parameter) else ""
    return f"{text}{beside} ({effect.slug})."


def _declared() -> tuple[dict[str, Any], str]:
    """The fields of the table, and its docstring, which the reference page prints."""
    fields, lines = {}, ["Options of the body, each off where it is not given.", "", "Attributes", "----------"]
    for effect in option_effects():
        for key, parameter in effect.description.keys.items():
            fields[key] = _field(parameter)
            lines += [f"{key} : float or None", f"    {_meaning(effect.description, key)}"]
    return fields, "\n".join(lines)


if TYPE_CHECKING:

    class Physics(_Options):
        """Options of the body, each off where it is not given: the keys that `benchmark.physics` declares."""

        def __getattr__(self, key: str) -> float | None: ...
else:
    _FIELDS, _DOC = _declared()
    Physics = create_model("Physics", __base__=_Options, __doc__=_DOC, __module__=__name__, **_FIELDS)
