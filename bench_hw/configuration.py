"""Reading a TOML file into a checked model: one error, with file, key, value and what is allowed."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from bench_hw.errors import InputError

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError

Model = TypeVar("Model", bound="BaseModel")


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
    from pydantic import ValidationError

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
