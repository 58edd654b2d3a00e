"""The file reference from the schemas: `python -m benchmark.files.reference > docs/reference-files.md`."""

from __future__ import annotations

import inspect
import math
import re
import types
import typing
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from benchmark.files.quantities import Number, Quantity
from benchmark.files.scenario import Scenario
from benchmark.files.schema import FileModel
from benchmark.files.sessions.description import SessionFile
from benchmark.files.tissue import Tissue
from benchmark.files.units import format_quantity
from benchmark.physics import EffectDescription, catalogue

HEAD = """# File reference

Every key of the files that people write, from the schemas that read them; made by
`python -m benchmark.files.reference`. Quantities are text with a unit, such as `"120 kPa"`; the examples in
[Files](files.md) show them at work. A quantity may carry its standard uncertainty, `"5 mm +/- 0.05 mm"` or
`"120 kPa +/- 30 %"`.
"""
EFFECTS = """## Effects

What a model can lack, by the name that `discover`, `model.toml` and reports use, in the order of the catalogue. Keys of
`[physics]` state the same quantities in a scenario. "On top" acts on the force of an elastic press (quasi-linear).
"""
ROOTS: tuple[tuple[str, type[FileModel]], ...] = (
    ("Tissue", Tissue),
    ("Scenario", Scenario),
    ("session.toml", SessionFile),
)
ENTRY = re.compile(r"^(?P<names>\w+(?:, \w+)*)(?: : .*)?$")


def reference() -> str:
    """The whole page as Markdown."""
    done: set[type[FileModel]] = set()
    sections = [HEAD, *(line for title, model in ROOTS for line in _section(title, model, done))]
    effects = (line for effect in catalogue() for line in _effect(effect.forms[-1].description))
    return "\n".join([*sections, EFFECTS, *effects])


def _section(title: str, model: type[FileModel], done: set[type[FileModel]]) -> Iterator[str]:
    """Heading and table of a model, then those of the models inside it; each once."""
    if model in done:
        return
    done.add(model)
    summary = inspect.cleandoc(model.__doc__ or "").partition("\n\n")[0].replace("\n", " ")
    yield from (f"## {title}", "", summary, "", "| key | allowed | without it | is |", "|---|---|---|---|")
    described = _descriptions(model)
    inside: list[tuple[str, type[FileModel]]] = []
    for name, field in model.model_fields.items():
        key = field.alias or name
        cells = (f"`{key}`", _allowed(field), _default(field), described.get(name, ""))
        yield "| " + " | ".join(cell.replace("|", "or") for cell in cells) + " |"
        inside += [(f"{title}: {key}", found) for found in _models(field.annotation)]
    yield ""
    for subtitle, found in inside:
        yield from _section(subtitle, found, done)


def _descriptions(model: type[FileModel]) -> dict[str, str]:
    """What the docstring says of each attribute; alternatives of a word are in the column of what is allowed."""
    lines = inspect.cleandoc(model.__doc__ or "").partition("----------\n")[2].splitlines()
    found: dict[str, str] = {}
    names: list[str] = []
    for line in lines:
        entry = ENTRY.match(line)
        if entry is not None:
            names = entry["names"].split(", ")
        elif line.startswith("    "):
            found |= {name: f"{found.get(name, '')} {line.strip()}".strip() for name in names}
    return found


def _parts(annotation: Any) -> Iterator[Any]:
    """An annotation and everything it is made of."""
    yield annotation
    for part in typing.get_args(annotation):
        yield from _parts(part)


def _models(annotation: Any) -> list[type[FileModel]]:
    return [each for each in _parts(annotation) if isinstance(each, type) and issubclass(each, FileModel)]


def _allowed(field: FieldInfo) -> str:
    every = [*field.metadata, *_parts(field.annotation)]
    origins = [typing.get_origin(each) for each in every]
    pair = any(_is_pair(each) for each in every)
    for each in every:
        if isinstance(each, Quantity | Number):
            return f"two in a list, each {each.allowed}" if pair else each.allowed
    words = [f'`"{word}"`' for each in every if typing.get_origin(each) is typing.Literal for word in each.__args__]
    if words:
        return ", ".join(words).replace('`"1"`', "`1`")
    named = Mapping in origins
    if _models(field.annotation):
        if named:
            return "tables by their names, see below"
        return "tables `[[...]]`, see below" if tuple in origins else "a table, see below"
    if named:
        return "a table"
    kinds = {bool: "true or false", str: "text", float: "a quantity with its unit", int: "a whole number"}
    kind = next((text for kind, text in kinds.items() if kind in every), "see its description")
    if origins.count(tuple) > 1:
        return f"a list of rows, each of two, {kind} each"
    return f"two in a list, {kind} each" if pair else f"a list, {kind} each" if tuple in origins else kind


def _is_pair(annotation: Any) -> bool:
    inside = typing.get_args(annotation)
    return typing.get_origin(annotation) is tuple and len(inside) == 2 and Ellipsis not in inside


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "needed"
    value = field.get_default(call_default_factory=False)
    if value is PydanticUndefined or value is None or isinstance(value, FileModel | types.MappingProxyType):
        automatic = any(getattr(each, "automatic", False) for each in [*field.metadata, *_parts(field.annotation)])
        return '`"auto"`' if automatic else "left out"
    for each in [*field.metadata, *_parts(field.annotation)]:
        if isinstance(each, Quantity) and isinstance(value, float):
            if math.isinf(value):
                return "endless"
            return f'`"{format_quantity(value, each.dimension)}"`'
        if isinstance(each, Quantity) and value and isinstance(value, tuple):
            return f"`{[format_quantity(one, each.dimension) for one in value]}`".replace("'", '"')
    return f'`"{value}"`' if isinstance(value, str) else "none" if value == () else f"`{str(value).lower()}`"


def _effect(effect: EffectDescription) -> Iterator[str]:
    """An effect's equation, source, how wave and FEM carry it, and its parameters with their bounds."""
    yield from (f"### `{effect.slug}`", "", f"{effect.sentence} Acts on: {effect.acts_on}.", "")
    yield from (f"    {effect.equation}", "", f"Source: {effect.source}.")
    if effect.acts_on == "body":
        yield from ("", f"Wave: {effect.in_wave or 'not carried'}. FEM: {effect.in_fem or 'not carried'}.")
    yield from ("", "| parameter | unit | a fit searches | key of `[physics]` | is |", "|---|---|---|---|---|")
    for each in effect.parameters:
        key = f"`{each.key}`" if each.key else ""
        yield f"| `{each.name}` | {each.unit} | {each.low:g} to {each.high:g} | {key} | {each.meaning} |"
    for each in effect.options:
        yield f"| | {each.unit} | not searched | `{each.key}` | {each.meaning} |"
    yield ""


if __name__ == "__main__":
    print(reference(), end="")
