"""What `capture` may write into a `session.toml`: its keys, their units and bounds.

The file is read by other programs than this one, so that a value which they would refuse must not get into it. Keys
that a person sets are checked before anything moves, the whole file before it is put in place.
"""

from __future__ import annotations

import tomllib
from difflib import get_close_matches
from importlib.metadata import entry_points
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from bench_hw.configuration import StrictModel, parse_quantity, read_toml, validated
from bench_hw.errors import InputError


def _in(unit: str) -> BeforeValidator:
    """A quantity in `unit`, which may carry its standard uncertainty ("5 mm +/- 0.05 mm")."""
    return BeforeValidator(lambda text: parse_quantity(_without_uncertainty(text), unit))


def _without_uncertainty(text: object) -> object:
    return text.replace("±", "+/-").partition("+/-")[0].strip() if isinstance(text, str) else text


def _printable(text: str) -> str:
    if not text.strip() or not text.isprintable():
        raise ValueError("allowed are printable characters on one line")
    return text


Name = Annotated[str, Field(min_length=1, max_length=200), AfterValidator(_printable)]
Length = Annotated[float, _in("m"), Field(ge=1e-9, le=1e5)]
Place = Annotated[float, _in("m"), Field(ge=-1e5, le=1e5)]
Tilt = Annotated[float, _in("rad"), Field(ge=-1.0472, le=1.0472)]
Count = Annotated[int, Field(ge=1, le=1000, strict=True)]


class ToolKeys(StrictModel):
    """The tool."""

    radius: Length | None = None
    contact: Literal["uniform_pressure", "rigid_bonded", "rigid_frictionless", "rigid_frictional"] | None = None
    edge_radius: Length | None = None
    position: tuple[Place, Place] | None = None
    tilt: Tilt | None = None


class SupportKeys(StrictModel):
    """What the specimen lies on."""

    kind: Literal["bonded", "hole", "half_space", "plates", "grips"] | None = None
    hole_radius: Length | None = None
    clamp: Literal["plate", "rim"] | None = None
    specimen_radius: Length | None = None


class DriveKeys(StrictModel):
    """The channel that the rig prescribed."""

    channel: Literal["depth", "force"] | None = None


class CameraKeys(StrictModel):
    """The marker grid and the camera that sees it."""

    marker_rows: Count | None = None
    marker_columns: Count | None = None
    marker_spacing: Length | None = None
    distance: Length | None = None
    file: Name | None = None
    centre_marker: Annotated[int, Field(ge=0, le=1_000_000, strict=True)] | None = None
    print_scatter: Length | None = None
    scale_uncertainty: Any = None
    clock: Literal["shared", "press"] | None = None


class ConditionKeys(StrictModel):
    """What differs in one condition."""

    tool: ToolKeys | None = None
    support: SupportKeys | None = None


class TrialKeys(StrictModel):
    """One trial."""

    file: Name
    condition: Name
    markers: Name | None = None
    film: Name | None = None
    sheet: Name | None = None
    height: Name | None = None
    import_: Annotated[dict[str, Any] | None, Field(alias="import")] = None


class SessionKeys(StrictModel):
    """A whole session file."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    name: Name | None = None
    specimen: Name | None = None
    trials: tuple[TrialKeys, ...] = ()
    tool: ToolKeys | None = None
    support: SupportKeys | None = None
    drive: DriveKeys | None = None
    camera: CameraKeys | None = None
    synthetic: Annotated[bool, Field(strict=True)] = False
    conditions: dict[str, ConditionKeys] | None = None
    fit: dict[str, Any] | None = None
    import_table: Annotated[dict[str, Any] | None, Field(alias="import")] = None


def check_session(tables: dict[str, Any], source: str) -> None:
    """Refuse what the readers of a session file would refuse.

    Parameters
    ----------
    tables : dict
        As TOML gives it; it need not be complete.
    source : str
        Where it comes from, for the error.

    Raises
    ------
    InputError
        Names key, value and what is allowed.
    """
    validated(SessionKeys, tables, source)


def check_session_file(path: Path) -> None:
    """Read a session file back, as `check_session`."""
    check_session(tomllib.loads(path.read_text(encoding="utf-8")), str(path))


TISSUES = "tissuebench.tissues"
"""The group of entry points by which programs that read sessions tell the tissues they ship: what they give, called,
holds the names."""


def specimen_source(name: str, folder: Path) -> Path | None:
    """Where the tissue that a session will name is: a file to be copied into its folder, or None, where it is known.

    Parameters
    ----------
    name : str
        A shipped tissue, a file in the session's folder, or a tissue file elsewhere.
    folder : pathlib.Path
        The session's folder, which need not exist.

    Raises
    ------
    InputError
        There is no such tissue, or the file is none.
    """
    known = sorted({each for point in entry_points(group=TISSUES) for each in point.load()()})
    path = Path(name)
    inside = not path.is_absolute() and (folder / path).is_file()
    if name in known or inside:
        return None
    if path.is_file():
        if "layers" not in read_toml(path)[0]:
            raise InputError(f"--specimen {name}: this file has no [[layers]]; allowed is a tissue file")
        return path
    if not known and path.suffix != ".toml":
        return None  # no program here says which tissues there are
    near = get_close_matches(name, known, n=1)
    meant = f"did you mean {near[0]}? " if near else ""
    shipped = f"a shipped tissue ({', '.join(known)}) or " if known else ""
    raise InputError(
        f"--specimen {name}: there is no such tissue; {meant}allowed is {shipped}a tissue file that exists"
    )
