"""TOML files of the bench, checked against a model: one error with file, key, value and what is allowed.

Quantities are texts with a unit in the file and SI floats inside. `Length`, `Speed` and so on are field types for
pydantic models: a field of type `Length` takes `"2 mm"` and holds `0.002`. Bounds are added at the field
(`Annotated[Length, Field(gt=0)]`) and are in SI.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from difflib import get_close_matches
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError

from bench_hw.errors import InputError
from bench_hw.storage.regular_file import read_regular

if TYPE_CHECKING:
    from collections.abc import Callable

Model = TypeVar("Model", bound=BaseModel)
_QUANTITY = re.compile(r"\s*(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?P<unit>[^\d\s+\-].*)", re.DOTALL)


class StrictModel(BaseModel):
    """Base of what a file may say: unknown keys are refused, nothing is changed afterwards."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def shipped_files(package: str) -> dict[str, Path]:
    """Give the TOML files in a package's `library`: name to path."""
    folder = Path(str(files(package) / "library"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def find_file(kind: str, name_or_path: str | Path, shipped: Mapping[str, Path]) -> Path:
    """Give the path of a file by its path or its shipped name; `kind` says what it is, for the error.

    Raises
    ------
    InputError
        No such file or shipped name.
    """
    path = Path(name_or_path)
    if _is_there(path):
        return path
    if str(name_or_path) not in shipped:
        raise InputError(f"{kind} {str(name_or_path)!r}: no such file; shipped are {', '.join(shipped)}")
    return shipped[str(name_or_path)]


def _is_there(path: Path) -> bool:
    """Whether there is anything but a folder of this name; what no file can be called is not there."""
    try:
        return path.exists() and not path.is_dir()
    except (OSError, ValueError):
        return False


def read_toml(path: Path) -> tuple[dict[str, Any], str]:
    """Read a TOML file.

    Returns
    -------
    tuple of dict and str
        The tables, and the text as it stands in the file.

    Raises
    ------
    InputError
        The file is missing, unreadable, not UTF-8 or not TOML.
    """
    try:
        text = read_regular(path).decode("utf-8-sig")
        return tomllib.loads(text), text
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start})") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not a TOML file: {error}") from error
    except (RecursionError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from error


def validated(model: type[Model], tables: dict[str, Any], source: str) -> Model:
    """Check tables against a model.

    Parameters
    ----------
    model : type of pydantic.BaseModel
        What the file must look like.
    tables : dict
        The file's content.
    source : str
        Name of the file, for the error.

    Raises
    ------
    InputError
        A key is missing, unknown or has a value that is not allowed; the message names each.
    """
    try:
        return model.model_validate(tables)
    except ValidationError as error:
        mistakes = dict.fromkeys(_mistake(part, tables, model) for part in _own_mistakes(error))
        raise InputError(f"{source}: {'; '.join(mistakes)}") from error


_WORDS: Mapping[str, str] = {
    "missing": "is missing",
    "extra_forbidden": "is unknown here",
    "literal_error": "allowed is {expected}",
    "union_tag_invalid": "{tag!r} is no kind of this; allowed is {expected_tags}",
    "union_tag_not_found": "its kind is missing; write kind = ...",
    "string_type": "is no text; write it in quotes",
    "string_too_short": "allowed are at least {min_length} characters",
    "string_too_long": "allowed are at most {max_length} characters",
    "int_type": "allowed is a whole number",
    "int_parsing": "allowed is a whole number",
    "int_from_float": "allowed is a whole number",
    "int_parsing_size": "allowed is a whole number of fewer digits",
    "float_type": "allowed is a number",
    "float_parsing": "allowed is a number",
    "finite_number": "allowed is a finite number",
    "bool_type": "allowed is true or false",
    "bool_parsing": "allowed is true or false",
    "tuple_type": "allowed is a list",
    "list_type": "allowed is a list",
    "dict_type": "allowed is a table of keys and values",
    "model_type": "allowed is a table of keys and values",
    "model_attributes_type": "allowed is a table of keys and values",
    "too_short": "it has {actual_length} entries; allowed are at least {min_length}",
    "too_long": "it has too many entries; allowed are at most {max_length}",
}
"""What is wrong, by pydantic's kind of error; its own message stands where the kind is not here."""

_BOUNDS = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}
_SHOWN = {"m": (1e3, "mm"), "m/s": (1e3, "mm/s"), "s": (1.0, "s"), "N": (1.0, "N"), "Hz": (1.0, "Hz")}
"""Factor and name of the unit in which a bound in SI is shown."""
_LONGEST = 60


def _own_mistakes(error: ValidationError) -> list[Any]:
    """What is wrong, without a list's being too short for no other reason than a wrong entry."""
    parts: list[Any] = list(error.errors(include_url=False))
    places = [part["loc"] for part in parts]
    return [
        part
        for part in parts
        if part["type"] != "too_short"
        or not any(place != part["loc"] and place[: len(part["loc"])] == part["loc"] for place in places)
    ]


def _mistake(part: Any, tables: Any, model: type[BaseModel]) -> str:
    """One mistake: key, value and what is allowed, in the file's own terms and units."""
    key = _key(part, tables)
    context = part.get("ctx", {})
    bounds = [
        f"allowed is {words} {_bound(context[end], part['input'])}" for end, words in _BOUNDS.items() if end in context
    ]
    reason = bounds[0] if bounds else _WORDS.get(part["type"], str(part["msg"])).format(**context)
    reason = reason.removeprefix("Value error, ")
    if not key:
        return reason
    if part["type"] in ("missing", "extra_forbidden"):
        return f"key {key}: {reason}{_meant(part, model)}"
    value = repr(part["input"])
    plain = not isinstance(part["input"], Mapping | list)
    return f"key {key}{f' = {value}' if plain and value not in reason and len(value) <= _LONGEST else ''}: {reason}"


def _meant(part: Any, model: type[BaseModel]) -> str:
    """The known key that is nearest to one that is unknown."""
    *places, word = part["loc"]
    near = get_close_matches(str(word), _known(model, places), n=1) if part["type"] == "extra_forbidden" else []
    return f"; did you mean {near[0]}?" if near else ""


def _known(model: type[BaseModel], places: list[Any]) -> list[str]:
    """The keys of a table, by its place: fields, numbers of a list, and pydantic's names of kinds."""
    models = [model]
    for place in places:
        fields = [field for each in models for name, field in each.model_fields.items() if place in (name, field.alias)]
        of_kind = [each for each in models if place in _kinds(each)]
        models = [found for field in fields for found in _models(field.annotation)] or of_kind or models
    return [field.alias or name for each in models for name, field in each.model_fields.items()]


def _kinds(model: type[BaseModel]) -> tuple[Any, ...]:
    return get_args(model.model_fields["kind"].annotation) if "kind" in model.model_fields else ()


def _models(annotation: Any) -> list[type[BaseModel]]:
    """The models that a field's type names."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for part in get_args(annotation) for found in _models(part)]


def _bound(value: Any, given: object) -> str:
    """A bound with the unit of what was given; of a bare number without."""
    match = _QUANTITY.fullmatch(given) if isinstance(given, str) else None
    if match is None:
        return f"{value:g}" if isinstance(value, int | float) else str(value)
    dimension = _registry().Unit(match["unit"]).dimensionality
    unit = next((unit for unit in _SHOWN if _registry().Unit(unit).dimensionality == dimension), None)
    factor, name = _SHOWN.get(unit or "", (1.0, ""))
    return f"{value * factor:g} {name}".rstrip()


def _key(part: Any, tables: Any) -> str:
    """The key of a mistake as it stands in the file, without pydantic's names of kinds, lists from 1; or none."""
    text, node = "", tables
    places = part["loc"]
    for number, place in enumerate(places, start=1):
        last_missing = number == len(places) and part["type"] == "missing"
        if isinstance(place, int):
            text += f"[{place + 1}]"
            node = node[place] if isinstance(node, list | tuple) and place < len(node) else None
        elif last_missing or (isinstance(node, Mapping) and place in node):
            text += f".{place}" if text else str(place)
            node = node.get(place) if isinstance(node, Mapping) else None
    return text


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def parse_quantity(text: object, unit: str) -> float:
    """Read one quantity and give its value in `unit`.

    Parameters
    ----------
    text : str
        A number with a unit, for instance `"2 mm"` or `"1 mm/s"`. A bare zero (`"0"` or 0) is taken too.
    unit : str
        The SI unit wanted, for instance `"m/s"`.

    Returns
    -------
    float
        The value in `unit`.

    Raises
    ------
    ValueError
        Not a number with a unit, not finite, or of another dimension.
    """
    if not isinstance(text, bool) and text in (0, "0"):
        return 0.0
    allowed = f"allowed is a text with a unit that converts to {unit}"
    if not isinstance(text, str):
        raise ValueError(f"{text!r} has no unit: {allowed}")
    parts = _QUANTITY.fullmatch(text)
    try:
        value = float(_registry().Quantity(float(parts["number"]), parts["unit"]).to(unit).magnitude) if parts else None
    except Exception as error:
        raise ValueError(f"{text!r} is no quantity in {unit}: {allowed}") from error
    if value is None:
        raise ValueError(f"{text!r} is no number with a unit: {allowed}")
    if not math.isfinite(value):
        raise ValueError(f"{text!r} is not finite: {allowed}")
    return value


def _in(unit: str) -> Callable[[object], float]:
    return lambda text: parse_quantity(text, unit)


Length = Annotated[float, BeforeValidator(_in("m"))]
"""A length: text in the file, metres inside."""
Speed = Annotated[float, BeforeValidator(_in("m/s"))]
"""A speed: text in the file, m/s inside."""
Duration = Annotated[float, BeforeValidator(_in("s"))]
"""A time: text in the file, seconds inside."""
Force = Annotated[float, BeforeValidator(_in("N"))]
"""A force: text in the file, newtons inside."""
Frequency = Annotated[float, BeforeValidator(_in("Hz"))]
"""A rate: text in the file, Hz inside."""
