"""Tissues and scenarios from their files, with the command line's `--set` put in."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from benchmark.errors import InputError
from benchmark.files.load import Load
from benchmark.files.overrides import layer_path, parsed_value, put_in, unknown_key
from benchmark.files.physics import Physics
from benchmark.files.scenario import Comparison, FemOptions, Scenario, WaveOptions
from benchmark.files.schema import FileModel, check_schema, known_keys, validated
from benchmark.files.shipped import find
from benchmark.files.sources import KeyPath, Source, read_toml
from benchmark.files.tissue import Layer, Tissue
from benchmark.files.tool import Support, Tool

Overrides = Mapping[str, str]

SECTIONS: Final[Mapping[str, type[FileModel]]] = {
    "tool": Tool,
    "support": Support,
    "load": Load,
    "physics": Physics,
    "comparison": Comparison,
    "fem": FemOptions,
    "wave": WaveOptions,
}
"""The sections of a scenario besides its tissue."""

TISSUE_KEYS = ("citation", "max_force")
OTHER_FILES: Final[Mapping[str, str]] = {
    "layers": "this is a tissue file; a scenario presses it: python -m benchmark run skin-5N --tissue {file}",
    "trials": "this is a session file; its trials are run by: python -m benchmark run --trials {file}",
    "base": "this is a model file; its effects are switched on by: python -m benchmark run skin-5N --model {file}",
}
"""What another kind of file than a scenario is, by a key that it alone has, and how it is used."""
_FILE_KEYS = (("load", "file"), ("fem", "surface"))
_NO_OVERRIDES: Overrides = {}


def load_tissue(name_or_path: str | Path, base: Path | None = None, overrides: Overrides = _NO_OVERRIDES) -> Tissue:
    """Read a tissue.

    Parameters
    ----------
    name_or_path : str or Path
        A shipped name ("skin_forearm") or a path to a tissue file.
    base : Path, optional
        The folder that a relative path belongs to; the current one by default.
    overrides : mapping of str to str, optional
        `LAYER.key` or `key` to a value as typed ("120 kPa").

    Returns
    -------
    Tissue
        All values in SI units.

    Raises
    ------
    InputError
        One paragraph with file, line, key, value and what is allowed.
    """
    table, source = read_file(find(name_or_path, "tissue", base), "tissue")
    return tissue_from_table(table, source, overrides)


def tissue_from_table(table: Mapping[str, Any], source: Source, overrides: Overrides = _NO_OVERRIDES) -> Tissue:
    """A tissue from the table of a file, after overrides; raises like `load_tissue`."""
    paths = {key: _tissue_path(key, table) for key in overrides}
    changed, traced = put_in(table, source, paths, overrides)
    return _telling(validated(Tissue, changed, traced), overrides)


def _telling(tissue: Tissue, told: Iterable[str]) -> Tissue:
    """The tissue without what is told by these keys among what its trials do not determine."""
    keys = {key.removeprefix("tissue.") for key in told}
    left = tuple(key for key in tissue.not_determined or () if key not in keys)
    return tissue.model_copy(update={"not_determined": left or None})


def load_scenario(name_or_path: str | Path, overrides: Overrides = _NO_OVERRIDES) -> Scenario:
    """Read a scenario.

    Parameters
    ----------
    name_or_path : str or Path
        A shipped name ("skin-5N") or a path to a scenario file.
    overrides : mapping of str to str, optional
        What `--set KEY=VALUE` replaces: `load.peak`, `fem.kinematics`..., a layer's values by its name
        (`dermis.youngs_modulus`, or `tissue.dermis.youngs_modulus` where a layer is named like a section),
        `max_force`, or `tissue` for another tissue (a path is then relative to the current folder).

    Returns
    -------
    Scenario
        All values in SI units, the tissue inside.

    Raises
    ------
    InputError
        One paragraph with file, line and key, or the `--set` key, the value and what is allowed.
    """
    path = find(name_or_path, "scenario")
    table, source = read_file(path, "scenario")
    for key, means in OTHER_FILES.items():
        if key in table and "tissue" not in table:
            raise InputError(f"{path}: {means.format(file=shlex.quote(str(path)))}")
    return scenario_from_table(table, source, overrides)


def scenario_from_table(table: Mapping[str, Any], source: Source, overrides: Overrides = _NO_OVERRIDES) -> Scenario:
    """A scenario from a table as a file would hold it, after overrides; raises like `load_scenario`.

    Parameters
    ----------
    table : mapping
        TOML types, quantities as text; `tissue` may be a `Tissue`.
    source : Source
        Where it came from; relative paths in it belong to its folder, those of overrides to the current one.
    overrides : mapping of str to str, optional
        As in `load_scenario`.
    """
    check_schema(table, source)
    tissue, tissue_source = _tissue_of(table, source, overrides.get("tissue"))
    paths = {key: _scenario_path(key, tissue) for key in overrides if key != "tissue"}
    in_tissue = {key: path[1:] for key, path in paths.items() if path[0] == "tissue"}
    in_scenario = {key: path for key, path in paths.items() if path[0] != "tissue"}
    changed, traced = put_in(table, source, in_scenario, overrides)
    _find_from_here(changed, in_scenario.values())
    if isinstance(tissue, Mapping):
        tissue = _telling(validated(Tissue, *put_in(tissue, tissue_source, in_tissue, overrides)), in_tissue)
    if tissue is not None:
        changed["tissue"] = tissue
    return validated(Scenario, changed, traced)


def referred(source: Source, key: str, name: str) -> Path:
    """The tissue file that a key of another file names; raises InputError, with that key's place."""
    try:
        return find(name, "tissue", source.folder)
    except InputError as error:
        raise InputError(f"{source.place((key,), key)}: {error}") from None


def read_file(path: Path, what: str) -> tuple[dict[str, Any], Source]:
    """The table of a tissue, scenario or session file that states its schema; raises InputError."""
    table, source = read_toml(path, what)
    if "schema" not in table:
        raise InputError(f"{path}: the key schema is missing; a {what} file begins with schema = 1.")
    check_schema(table, source)
    return table, source


def _tissue_of(table: Mapping[str, Any], source: Source, chosen: str | None) -> tuple[Any, Source]:
    """What a scenario's tissue is before it is checked, and where it came from: a file's table or an inline one."""
    if chosen is not None:
        return read_file(find(str(parsed_value(chosen)), "tissue"), "tissue")
    given = table.get("tissue")
    if isinstance(given, str):
        return read_file(referred(source, "tissue", given), "tissue")
    if isinstance(given, Tissue):
        return given.to_table(), replace(source, prefix=("tissue",))
    return given, replace(source, prefix=("tissue",))


def _find_from_here(table: Mapping[str, Any], replaced: Collection[KeyPath]) -> None:
    """Make the files that the command line names absolute: they belong to the current folder, not the scenario's."""
    for section, key in _FILE_KEYS:
        if (section, key) in replaced and isinstance(table[section][key], str):
            table[section][key] = str(Path(table[section][key]).absolute())


def _scenario_path(key: str, tissue: Any) -> KeyPath:
    """Where a `--set` key points in a scenario; paths into its tissue begin with "tissue"."""
    head = key.partition(".")[0]
    if head in Scenario.model_fields or head == "schema":
        refuse_other_place(key, layer_names(tissue), _section_keys())
        return ("tissue", *_tissue_path(key, tissue)) if head == "tissue" else tuple(key.split("."))
    path = layer_path(key, layer_names(tissue))
    if path is None and head not in TISSUE_KEYS:
        raise unknown_key(key, [*_section_keys(), *tissue_keys(tissue)])
    return ("tissue", *(path or key.split(".")))


def refuse_other_place(key: str, layers: Iterable[str], sections: Iterable[str]) -> None:
    """Refuse the key of a layer that a section of the layer's name, with its dotted keys, takes for its own.

    Raises
    ------
    InputError
        It says which key is the layer's.
    """
    path = layer_path(key, layers)
    if path is not None and path[2] in known_keys(Layer) and key not in sections:
        name = key.partition(".")[0]
        raise InputError(
            f"--set {key}: {name} is a section here, which has no such key; of a layer of that name it is "
            f"--set tissue.{key}"
        )


def _tissue_path(key: str, tissue: Any) -> KeyPath:
    """Where a key points in a tissue's table: a layer by its name, or a key of the tissue itself."""
    key = key.removeprefix("tissue.")
    path = layer_path(key, layer_names(tissue))
    if path is None and key.partition(".")[0] not in known_keys(Tissue):
        raise unknown_key(key, [*known_keys(Tissue), *tissue_keys(tissue)])
    return path or tuple(key.split("."))


def layer_names(tissue: Any) -> list[str]:
    """The layers' names in a tissue's table that nobody has checked yet."""
    layers = tissue.get("layers") if isinstance(tissue, Mapping) else None
    entries = layers if isinstance(layers, list) else []
    names = [layer.get("name") if isinstance(layer, Mapping) else None for layer in entries]
    return [name if isinstance(name, str) else "" for name in names]


def _section_keys() -> list[str]:
    return [f"{name}.{key}" for name, model in SECTIONS.items() for key in known_keys(model)]


def tissue_keys(tissue: Any) -> list[str]:
    """What `--set` can replace in a tissue's table, layers by their names."""
    layers = [f"{name}.{key}" for name in layer_names(tissue) for key in known_keys(Layer)]
    return [*layers, *TISSUE_KEYS]
