"""What every model of an input file shares: frozen, no unknown keys, written back with units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict

from benchmark.files.quantities import problem

SCHEMA = 1
"""The number of the tissue, scenario and session schemas that this version reads and writes."""

Schema = Literal[1]


def _printable(text: str) -> str:
    if not text.strip() or not text.isprintable() or len(text) > 200:
        raise problem(f"{text[:60]!r} is no name; allowed: 1 to 200 printable characters on one line")
    return text


Name = Annotated[str, AfterValidator(_printable)]
"""One line of printable text; it may hold anything else, HTML included, so whoever shows it escapes it."""


class FileModel(BaseModel):
    """Base of the file models: values are SI floats, instances are immutable and compare by value."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=False)

    def to_table(self) -> dict[str, Any]:
        """The model as TOML types, every default explicit, quantities as text with units."""
        table: dict[str, Any] = _without_none(self.model_dump(mode="json", by_alias=True))
        return table

    def to_toml(self) -> str:
        """The model as a TOML document that reads back as an equal model."""
        import tomli_w

        return tomli_w.dumps(self.to_table())


def _without_none(value: Any) -> Any:
    """TOML has no null: what is not given is left out."""
    if isinstance(value, Mapping):
        return {key: _without_none(item) for key, item in value.items() if item is not None}
    if isinstance(value, list):
        return [_without_none(item) for item in value]
    return value
