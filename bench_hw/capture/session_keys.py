"""What `capture` may write into a `session.toml`: its keys, their units and bounds.

The file is read by other programs than this one, so that a value which they would refuse must not get into it. Keys
that a person sets are checked before anything moves, the whole file before it is put in place.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from bench_hw.configuration import StrictModel, parse_quantity, validated


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
