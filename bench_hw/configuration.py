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
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError

from bench_hw.errors import InputError

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
    if path.is_file():
        return path
    if str(name_or_path) not in shipped:
        raise InputError(f"{kind} {str(name_or_path)!r}: no such file; shipped are {', '.join(shipped)}")
    return shipped[str(name_or_path)]


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
        text = path.read_bytes().decode("utf-8")
        return tomllib.loads(text), text
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start})") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not a TOML file: {error}") from error


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
        raise InputError(f"{source}: {describe(error)}") from error


def describe(error: ValidationError) -> str:
    """Say in one line what a model refused: key, value and reason of each mistake."""
    return "; ".join(_mistake(part) for part in error.errors(include_url=False))


def _mistake(part: Any) -> str:
    key = ".".join(str(place) for place in part["loc"]) or "the file"
    reason = str(part["msg"]).removeprefix("Value error, ")
    if part["type"] == "missing":
        return f"key {key}: is missing"
    if part["type"] == "extra_forbidden":
        return f"key {key}: is unknown here"
    value = repr(part["input"])
    shown = "" if value in reason or len(value) > 60 else f" = {value}"
    return f"key {key}{shown}: {reason}"


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
