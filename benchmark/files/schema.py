"""What every input file shares: frozen models without unknown keys, and what is wrong with a file said to a person.

Which keys a file has is said by its own module.
"""

from __future__ import annotations

import difflib
import typing
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Annotated, Any, Final, Literal, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    ModelWrapValidatorHandler,
    PrivateAttr,
    SerializerFunctionWrapHandler,
    ValidationError,
    model_serializer,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError
from pydantic_core.core_schema import SerializationInfo

from benchmark.errors import InputError
from benchmark.files.quantities import problem, quantity_of, shortened, without_uncertainty
from benchmark.files.sources import KeyPath, Source
from benchmark.files.units import FRACTION, format_quantity, split_uncertainty

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
    """Base of the file models: values are SI floats, instances are immutable and compare by value.

    A quantity may carry its standard uncertainty, "5 mm +/- 0.05 mm" or "120 kPa +/- 30 %", which is kept beside it.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=False)
    _uncertainties: dict[str, float] = PrivateAttr(default_factory=dict)

    @property
    def own_uncertainties(self) -> Mapping[str, float]:
        """Standard uncertainties that were stated, as shares of their values, by the keys of this table."""
        return MappingProxyType(self._uncertainties)

    def keeping_uncertainties(self, stated: Mapping[str, float]) -> Self:
        """A copy with other uncertainties, shares of the values of this table's keys."""
        copy = self.model_copy()
        copy._uncertainties = dict(stated)
        return copy

    @model_validator(mode="wrap")
    @classmethod
    def _uncertainties_apart(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if not isinstance(data, Mapping):
            return handler(data)
        plain, stated = dict(data), {}
        for key, field in cls.model_fields.items():
            if isinstance(value := data.get(key), str) and split_uncertainty(value)[1] is not None:
                plain[key], share = _apart(value, field, key)
                if share is not None:
                    stated[key] = share
        model = handler(plain)
        if stated:
            model._uncertainties = stated
        return model

    @model_serializer(mode="wrap")
    def _with_uncertainties(self, handler: SerializerFunctionWrapHandler, info: SerializationInfo) -> dict[str, Any]:
        table: dict[str, Any] = handler(self)
        if info.mode == "json":
            for key, share in self._uncertainties.items():
                table[key] = f"{table[key]} +/- {format_quantity(share, FRACTION)}"
        return table

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


def _apart(value: str, field: FieldInfo, key: str) -> tuple[str, float | None]:
    """A value's text without its uncertainty, and that."""
    dimension = next((found for each in (*field.metadata, field.annotation) if (found := quantity_of(each))), None)
    if dimension is None:
        return value, None
    try:
        return without_uncertainty(value, dimension)
    except PydanticCustomError as error:
        raise problem(error.message(), key=key) from None


Model = TypeVar("Model", bound=BaseModel)


def validated(model: type[Model], table: Mapping[str, Any], source: Source) -> Model:
    """Make a model of a table read from a file.

    Parameters
    ----------
    model : type of FileModel
        What the table should be.
    table : mapping
        As TOML gives it; quantities are text with units.
    source : Source
        Where it came from.

    Returns
    -------
    Model
        With SI floats inside.

    Raises
    ------
    InputError
        One paragraph: the first problem with its place and what is allowed, and the keys of the others.
    """
    check_schema(table, source)
    try:
        return model.model_validate(table, context=source.context())
    except ValidationError as error:
        details = sorted(error.errors(include_url=False), key=lambda each: each["type"] != "extra_forbidden")
        first = _sentence(details[0], model, table, source)
        paths = [_path(each, table) for each in details]
        others = [source.key(shown_path(each, table)) for each in paths[1:] if not _holds_another(each, paths)]
        more = f" Also wrong: {', '.join(dict.fromkeys(others))}." if others else ""
        raise InputError(f"{first}{more}") from None


def _holds_another(path: KeyPath, paths: Iterable[KeyPath]) -> bool:
    """Whether another wrong value lies within this one, of which it is then wrong."""
    return any(len(each) > len(path) and each[: len(path)] == path for each in paths)


def check_schema(table: Mapping[str, Any], source: Source) -> None:
    """Refuse a file of another schema number before its keys are looked at."""
    number = table.get("schema", SCHEMA)
    if number != SCHEMA or isinstance(number, bool):
        place = source.place(("schema",), "schema")
        raise InputError(f"{place}: {shortened(number)} is not a schema that this version reads; allowed: {SCHEMA}.")


def nearest(word: str, known: Iterable[str]) -> str:
    """The words nearest to one that is not known, whatever its capitals, to end a sentence with; all where none is."""
    words = list(known)
    lower = [each.casefold() for each in words]
    found = difflib.get_close_matches(word.casefold(), dict.fromkeys(lower), n=3, cutoff=0.6)
    near = [words[lower.index(each)] for each in found]
    if near:
        return f"did you mean {' or '.join(near)}?"
    return f"known: {', '.join(words)}."


def shown_path(path: KeyPath, table: Any) -> str:
    """A key path for a person: `layers[dermis].thickness`, or `trials[#2].file` for a list without names."""
    text, node = "", table
    for part in path:
        node = _child(node, part)
        if isinstance(part, int):
            name = node.get("name") if isinstance(node, Mapping) else None
            text += f"[{_word(name)}]" if isinstance(name, str) else f"[#{part + 1}]"
        else:
            text += f".{_word(part)}" if text else _word(part)
    return text


def _word(name: str) -> str:
    """A key or a name as it is, where it is one short word or line; quoted and shortened otherwise."""
    return name if name.isprintable() and 0 < len(name) <= 60 else _shortened(repr(name))


def _sentence(error: ErrorDetails, model: type[BaseModel], table: Mapping[str, Any], source: Source) -> str:
    path = _path(error, table)
    place = source.place(path, shown_path(path, table))
    kind = error["type"]
    if kind == "missing":
        what = "this key" if isinstance(path[-1], str) else f"entry {path[-1] + 1}"
        return f"{place}: {what} is missing; it is needed."
    if kind == "extra_forbidden":
        return f"{place}: this key is not known; {_meant(str(path[-1]), model, path[:-1], table)}"
    words = {**error.get("ctx", {}), "input": _shortened(repr(error["input"])), "msg": error["msg"]}
    return f"{place}: {_SENTENCES.get(kind, '{msg}').format(**words).rstrip('.')}."


_SENTENCES: Final[Mapping[str, str]] = {
    "literal_error": "{input} is not allowed; allowed: {expected}",
    "union_tag_invalid": "the law is not known; allowed: {expected_tags}",
    "union_tag_not_found": 'it must name its law, such as law = "yeoh"',
    "string_type": "{input} is not text; write it in quotes",
    "bool_type": "{input} is not allowed; allowed: true, false",
    "bool_parsing": "{input} is not allowed; allowed: true, false",
    "model_type": "{input} is no table of keys and values",
    "model_attributes_type": "{input} is no table of keys and values",
    "dict_type": "{input} is no table of keys and values",
    "mapping_type": "{input} is no table of keys and values",
    "tuple_type": "{input} is no list",
    "list_type": "{input} is no list",
    "float_type": "{input} is no number",
    "finite_number": "{input} is not finite",
    "greater_than": "{input} is not allowed; allowed: more than {gt:g}",
    "too_short": "it has {actual_length} entries; allowed: at least {min_length}",
    "too_long": "it has too many entries; allowed: at most {max_length}",
}
"""What is wrong, by pydantic's kind of error; its own message stands where the kind is not here."""


def _path(error: ErrorDetails, table: Any) -> KeyPath:
    """The key path of an error in the file's own terms: without union tags, with the key that a rule named."""
    path: KeyPath = ()
    node: Any = table
    for part in error["loc"]:
        if isinstance(node, Mapping) and isinstance(part, str) and part == node.get("law") and part not in node:
            continue
        path, node = (*path, part), _child(node, part)
    key = error.get("ctx", {}).get("key") if error["type"] == "tissuebench" else None
    return path + tuple(int(part) if part.isdecimal() else part for part in key.split(".")) if key else path


def _shortened(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:77]}..."


def _child(node: Any, part: str | int) -> Any:
    if isinstance(node, Mapping):
        return node.get(part)
    if isinstance(node, list | tuple) and isinstance(part, int) and part < len(node):
        return node[part]
    return None


def _meant(word: str, model: type[BaseModel], parents: KeyPath, table: Any) -> str:
    """What may have been meant by a key that is not known: the field's other names first (`other_names`)."""
    models = _models_at(model, parents, table)
    named = [names[word] for each in models if word in (names := getattr(each, "other_names", {}))]
    return named[0] if named else nearest(word, dict.fromkeys(key for each in models for key in known_keys(each)))


def _models_at(model: type[BaseModel], parents: KeyPath, table: Any) -> list[type[BaseModel]]:
    """The models that the table at a path may be of."""
    models: list[type[BaseModel]] = [model]
    node = table
    for part in parents:
        node = _child(node, part)
        if isinstance(part, str):
            fields = [field for each in models for key, field in _fields(each).items() if key == part]
            models = [found for field in fields for found in _models_in(field)] or models  # a mapping's own keys
    law = node.get("law") if isinstance(node, Mapping) else None
    laws = {each: _fields(each).get("law") for each in models}
    return [each for each in models if law is None or laws[each] is None or law in typing.get_args(laws[each])]


def known_keys(model: type[BaseModel]) -> list[str]:
    """The keys that the table of a model may have in a file."""
    return [*_fields(model), *getattr(model, "other_keys", ())]


def _fields(model: type[BaseModel]) -> dict[str, Any]:
    """Each key of a model as files spell it, with its annotation."""
    return {field.alias or name: field.annotation for name, field in model.model_fields.items()}


def _models_in(annotation: Any) -> list[type[BaseModel]]:
    """The models that a field's annotation can hold."""
    if typing.get_origin(annotation) is None and isinstance(annotation, type):
        return [annotation] if issubclass(annotation, BaseModel) else []
    return [found for part in typing.get_args(annotation) for found in _models_in(part)]
