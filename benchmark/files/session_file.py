"""The file `session.toml`: which trials there are, and what is known of the rig that made them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, StrictBool

from benchmark.files.base import FileModel, Name, Schema
from benchmark.files.quantities import Bounds, Length, Number

GridSize = Annotated[int, Number("1 to 1000 (a whole number)", Bounds(1, 1000), whole=True)]
MarkerNumber = Annotated[int, Number("0 to 1000000 (a whole number)", Bounds(0, 1_000_000), whole=True)]
Keys = Mapping[str, Any]


class TrialEntry(FileModel):
    """One trial.

    Attributes
    ----------
    file : str
        CSV or native trial file, inside the session's folder.
    condition : str
        What the trial shares with others: a speed, a depth, a day.
    markers : str or None
        CSV file of the marker tracks, inside the session's folder.
    """

    file: Name
    condition: Name
    markers: Name | None = None


class Drive(FileModel):
    """Which channel the rig prescribed: depth | force."""

    channel: Literal["depth", "force"] = "depth"


class Camera(FileModel):
    """The marker grid and the camera that sees it.

    Attributes
    ----------
    marker_rows, marker_columns : int
        Layout of the grid, whose markers are numbered row by row.
    marker_spacing : float
        m.
    distance : float or None
        Camera to lower face, m; None where it is not known.
    file : str or None
        A camera.toml inside the session's folder.
    centre_marker : int or None
        Number of the marker whose 3 x 3 block is taken; None for the one nearest the tool axis.
    """

    marker_rows: GridSize
    marker_columns: GridSize
    marker_spacing: Length
    distance: Length | None = None
    file: Name | None = None
    centre_marker: MarkerNumber | None = None


class ConditionKeys(FileModel):
    """What differs in one condition: some keys of the tool and of the support."""

    tool: Keys = Field(default_factory=dict)
    support: Keys = Field(default_factory=dict)


class SessionFile(FileModel):
    """The whole file; tool and support are some keys of a scenario's, checked once the rest is filled in."""

    schema_: Annotated[Schema, Field(alias="schema")] = 1
    name: Name
    specimen: Name | None = None
    trials: Annotated[tuple[TrialEntry, ...], Field(min_length=1, max_length=10_000)]
    tool: Keys = Field(default_factory=dict)
    support: Keys = Field(default_factory=dict)
    drive: Drive = Drive()
    camera: Camera | None = None
    synthetic: StrictBool = False
    conditions: Mapping[str, ConditionKeys] = Field(default_factory=dict)
