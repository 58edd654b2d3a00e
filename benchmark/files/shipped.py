"""What ships with the product: tissues and scenarios found by name, and a commented tissue file to start from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from benchmark.errors import InputError
from benchmark.files.schema import nearest
from benchmark.files.sources import is_file

_SHIPPED = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Entry:
    """One shipped file.

    Attributes
    ----------
    name : str
        What a scenario or the command line calls it.
    path : Path
        The file.
    """

    name: str
    path: Path


def shipped_tissues() -> Mapping[str, Entry]:
    """The shipped tissues by name, in alphabetical order."""
    return _entries("tissues")


def shipped_scenarios() -> Mapping[str, Entry]:
    """The shipped scenarios by name, in alphabetical order."""
    return _entries("scenarios")


def shipped_sessions() -> Mapping[str, Path]:
    """The folders of the shipped trial sessions by name, in alphabetical order."""
    return {file.parent.name: file.parent for file in sorted((_SHIPPED / "sessions").glob("*/session.toml"))}


def session_folder(path: Path) -> Path:
    """The shipped session that a bare name means where no file or folder is called so; any other path as it is."""
    if len(path.parts) == 1 and not path.exists():
        return shipped_sessions().get(path.name, path)
    return path


def said_of_name(name: str | Path, what: str) -> str:
    """One line where a shipped "tissue", "scenario" or "session" and a file here may both be meant; empty otherwise."""
    shipped = shipped_sessions() if what == "session" else _entries(f"{what}s")
    if str(name) not in shipped:
        return ""
    if is_file(Path(name)) or (what == "session" and Path(name).exists()):
        return f"{what} {name}: the one in this folder is taken, not the one of that name that ships"
    if is_file(Path(f"{name}.toml")):
        return f"{what} {name}: the one that ships is taken; the file here is {name}.toml"
    return ""


def find(name_or_path: str | Path, what: str, base: Path | None = None) -> Path:
    """The file that a name or a path means.

    Parameters
    ----------
    name_or_path : str or Path
        A shipped name, or a path: anything that ends in .toml or has a separator in it, or that a file is called.
    what : str
        "tissue" or "scenario".
    base : Path, optional
        The folder that a relative path belongs to; the current one by default.

    Returns
    -------
    Path
        A path that was asked for as one need not exist.

    Raises
    ------
    InputError
        When nothing of that name ships; it lists the nearest names.
    """
    text = str(name_or_path)
    path = (base or Path()) / text
    if isinstance(name_or_path, Path) or text.endswith(".toml") or "/" in text or "\\" in text:
        return path
    entries = _entries(f"{what}s")
    if text and is_file(path):
        return path
    if text in entries:
        return entries[text].path
    if text and is_file(Path(f"{path}.toml")):
        raise InputError(f"no {what} {text!r} ships with tissuebench; did you mean the file {text}.toml?")
    if what == "scenario" and text in shipped_tissues():
        raise InputError(
            f"{text!r} is a tissue; a scenario presses it: python -m benchmark run skin-5N --tissue {text}"
        )
    raise InputError(
        f"no {what} {text!r} ships with tissuebench and there is no file of that name; {nearest(text, entries)} "
        f"A path to a file of your own ends in .toml."
    )


def _entries(kind: str) -> dict[str, Entry]:
    files = sorted((_SHIPPED / kind).glob("*.toml"))
    return {file.stem: Entry(file.stem, file) for file in files}


TEMPLATE: Final = """# A tissue of your own. Values are text with units; --set LAYER.key="VALUE" changes one.
# Use it as `tissue = "{file}"` in a scenario, or: python -m benchmark run skin-5N --tissue {file}
schema = 1
name = "{name}"
citation = ""                       # where the values come from: reports show it beside every result
# max_force = "5 N"                 # the largest press that the sources cover; a run beyond it warns

# Layers from the surface down. The last one lies on the support.
[[layers]]
name = "dermis"                     # one of its own in the file; --set dermis.thickness="2 mm" finds it by this
thickness = "1.5 mm"                # undeformed
density = "1100 kg/m^3"
youngs_modulus = "500 kPa"          # initial: for small strain, before anything relaxes
poisson_ratio = 0.48                # 0 to 0.49999; soft tissue is nearly incompressible

[[layers]]
name = "fat"
thickness = "10 mm"
density = "970 kg/m^3"
youngs_modulus = "50 kPa"
poisson_ratio = 0.48
# Optional, in any layer (without `hyperelastic` the layer is neo-Hookean with the moduli above):
# hyperelastic = {{ law = "yeoh", c10 = "8.4 kPa", c20 = "2.5 kPa" }}
# relaxation = [{{ g = 0.3, tau = "0.5 s" }}, {{ g = 0.2, tau = "10 s" }}]   # fractions of the stiffness that fade
# fibre = {{ angle = "0 deg", k1 = "3 kPa", k2 = 1.0 }}                     # a fibre family, angle in the layer's plane
"""


def write_new_tissue(name: str) -> Path:
    """Write a commented tissue file and return its path.

    Parameters
    ----------
    name : str
        The tissue's name, for `NAME.toml` in the current folder, or a path that ends in .toml.

    Raises
    ------
    InputError
        There is such a file, such a tissue ships, the folder is missing or cannot be written, or the name cannot be
        one. No file is left then.
    """
    from reports.atomic import write_text

    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    stem = path.stem
    if not stem.strip() or not stem.isprintable() or any(sign in stem for sign in '"\\'):
        raise InputError(f"{name!r} is no name for a tissue; allowed: printable characters without quotes")
    if stem in shipped_tissues():
        raise InputError(f"a tissue {stem!r} ships with tissuebench; give yours another name")
    if path.exists() or path.is_symlink():
        raise InputError(f"{path} is there already and is left as it is; give another name")
    if not path.absolute().parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}; make it first, or give another name")
    try:
        return write_text(path, TEMPLATE.format(name=stem, file=path))
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror or error}") from error
