"""Finding and reading rig files: a path, or the name of a shipped one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bench_hw.configuration import read_toml, validated
from bench_hw.errors import InputError

if TYPE_CHECKING:
    from bench_hw.rig.schema import Rig


@dataclass(frozen=True, slots=True)
class LoadedRig:
    """A rig, the text of its file and where that was; paths in it are relative to that folder."""

    rig: Rig
    text: str
    path: Path

    def resolve(self, name: str) -> Path:
        """Give the path of a file that the rig names."""
        return self.path.parent / name


def shipped_rigs() -> dict[str, Path]:
    """Give the shipped rigs: name to path."""
    folder = Path(str(files("bench_hw.rig") / "library"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_rig(name_or_path: str | Path) -> LoadedRig:
    """Read a rig file.

    Raises
    ------
    InputError
        No such file or shipped name, or the file says something that is not allowed.
    """
    from bench_hw.rig.schema import Rig

    name = str(name_or_path)
    path = Path(name)
    if not path.is_file():
        known = shipped_rigs()
        if name not in known:
            raise InputError(f"rig {name!r}: no such file; shipped are {', '.join(known)}")
        path = known[name]
    tables, text = read_toml(path)
    return LoadedRig(validated(Rig, tables, str(path)), text, path)


def simulated_rig(changes: Mapping[str, Mapping[str, Any] | None]) -> LoadedRig:
    """Give the shipped simulated rig with some keys changed, by section; None takes a section out.

    Raises
    ------
    InputError
        A key or value that a rig file may not have.
    """
    import tomli_w

    from bench_hw.rig.schema import Rig

    path = shipped_rigs()["simulated"]
    tables, _ = read_toml(path)
    for section, keys in changes.items():
        if keys is None:
            tables.pop(section, None)
        else:
            tables[section] = {**tables.get(section, {}), **keys}
    return LoadedRig(validated(Rig, tables, str(path)), tomli_w.dumps(tables), path)
