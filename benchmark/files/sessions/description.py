"""The file `session.toml`: which trials there are, what is known of the rig, and what is assumed where it is silent."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Annotated, Any, Final, Literal, Self

from pydantic import Field, StrictBool, model_validator

from bench_hw.configuration import parse_quantity
from bench_hw.instrument_files.told import Told
from benchmark.errors import InputError
from benchmark.files.quantities import Bounds, Length, Margin, Number, problem
from benchmark.files.schema import FileModel, Name, Schema, nearest, validated
from benchmark.files.sessions.fit_table import FitTable
from benchmark.files.sources import Source
from benchmark.files.tool import TOUCHING, Support, Tool, check_hole

LEAST_MARKERS, MOST_MARKERS = 4, 2500
"""Of a grid: fewer tell no plane, more the tracker does not take."""
GridSize = Annotated[int, Number("1 to 1000 (a whole number)", Bounds(1, 1000), whole=True)]
MarkerNumber = Annotated[int, Number("0 to 1000000 (a whole number)", Bounds(0, 1_000_000), whole=True)]
Keys = Mapping[str, Any]


class ImportTable(FileModel):
    """What files of other instruments leave open: where columns stand and in which units, and how text is written.

    Attributes
    ----------
    time, depth, force, gap, stress, strain : str or None
        "COLUMN", "COLUMN:UNIT" or "#3:UNIT", with - before it where pressing is negative, + where it is positive.
    rate : str or None
        Rows per second, "100 Hz".
    decimal, delimiter, encoding : str or None
        Of text.
    drop_empty : bool
        Leave out rows in which a cell that is needed is no number.
    touch : str
        auto: depth from the first touch where a record begins in air; none: as the file has it.
    height, area : float or None
        Of a specimen between plates, m and m2.
    """

    time: Name | None = None
    depth: Name | None = None
    force: Name | None = None
    gap: Name | None = None
    stress: Name | None = None
    strain: Name | None = None
    rate: Name | None = None
    decimal: Literal[".", ","] | None = None
    delimiter: str | None = None
    encoding: Name | None = None
    drop_empty: bool = False
    touch: Literal["auto", "none"] = "auto"
    height: Length | None = None
    area: Name | None = None

    def with_own(self, own: ImportTable) -> ImportTable:
        """Give the table with what is told of one file in its place."""
        return self.model_copy(update={key: getattr(own, key) for key in own.model_fields_set})

    def told(self, sheet: str | None = None) -> Told:
        """As the reader takes it; raises InputError."""
        roles = ("time", "depth", "force", "gap", "stress", "strain")
        columns = {role: str(text) for role in roles if (text := getattr(self, role)) is not None}
        try:
            return Told(
                columns,
                _in_si("rate", self.rate, "Hz"),
                self.decimal or "",
                self.delimiter or "",
                self.encoding or "",
                () if sheet is None else (sheet,),
                self.drop_empty,
                self.touch,
                self.height,
                _in_si("area", self.area, "m^2"),
            )
        except ValueError as error:
            raise InputError(f"[import]: {error}") from None


def _in_si(key: str, text: str | None, unit: str) -> float | None:
    """A value of [import] in an SI unit; raises InputError."""
    try:
        return None if text is None else parse_quantity(text, unit)
    except ValueError as error:
        raise InputError(f"import.{key}: {error}") from None


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
    film : str or None
        Video of the markers, inside the session's folder, tracked in the run with the camera of [camera] file.
    sheet : str or None
        The sheet, group or test of an instrument's file; None: each that holds a record is a trial.
    import_ : ImportTable
        What is told of this file alone, as `import = { force = "Load:kgf" }`; it counts before [import].
    height : float or None
        Of the specimen under this trial, m, where specimens differ in height; layers keep their shares of it.
    """

    file: Name
    condition: Name
    markers: Name | None = None
    film: Name | None = None
    sheet: Name | None = None
    import_: Annotated[ImportTable, Field(alias="import")] = ImportTable()
    height: Length | None = None


class Drive(FileModel):
    """Which channel the rig prescribed: depth | force; left out: force where trials surely show that, else depth."""

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
    print_scatter : float or None
        Standard deviation by which markers are printed off their grid, along x and along y, m; None: the resting grid
        tells it.
    scale_uncertainty : float or None
        Relative standard uncertainty of the grid's scale beyond the print scatter's; None for none.
    clock : str
        shared: marker times are on the trial's clock; press: the film started at another time, found from the press.
    """

    marker_rows: GridSize
    marker_columns: GridSize
    marker_spacing: Length
    distance: Length | None = None
    file: Name | None = None
    centre_marker: MarkerNumber | None = None
    print_scatter: Length | None = None
    scale_uncertainty: Margin | None = None
    clock: Literal["shared", "press"] = "shared"

    @model_validator(mode="after")
    def _is_a_grid(self) -> Self:
        count = self.marker_rows * self.marker_columns
        if not LEAST_MARKERS <= count <= MOST_MARKERS:
            allowed = f"{LEAST_MARKERS} to {MOST_MARKERS} in all"
            raise problem(f"{self.marker_rows} x {self.marker_columns} markers; allowed: {allowed}", key="marker_rows")
        return self


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
    fit: FitTable = FitTable()
    import_: Annotated[ImportTable, Field(alias="import")] = ImportTable()
    conditions: Mapping[str, ConditionKeys] = Field(default_factory=dict)


_ASSUMED: Final[Mapping[str, str]] = {"radius": "5 mm", "contact": "rigid_bonded"}
ASSUMED_EDGE = 0.1
"""Edge radius over tool radius of a touching tool whose edge no one measured: finite strain needs a rounded one."""
_WHY: Final[Mapping[str, str]] = {
    "radius": "the tool's radius is not given: assumed 5 mm (--set tool.radius=...)",
    "contact": (
        "the tool's contact is not given: assumed rigid_bonded, a rigid tool to which the surface sticks "
        "(--set tool.contact=rigid_frictionless where it slides)"
    ),
}


class Setup(FileModel):
    """What one condition was measured with."""

    tool: Tool
    support: Support

    @model_validator(mode="after")
    def _tool_fits_the_hole(self) -> Self:
        check_hole(self.tool, self.support)
        return self


def base_setup(file: SessionFile, source: Source) -> Setup:
    """Tool and support where no condition says otherwise; raises InputError."""
    return _setup(file, ConditionKeys(), source)


def setups(file: SessionFile, conditions: Iterable[str], source: Source) -> dict[str, Setup]:
    """Tool and support of each condition.

    Raises
    ------
    InputError
        When a value is not allowed, or keys are given for a condition that no trial has.
    """
    names = list(conditions)
    for name in file.conditions:
        if name not in names:
            place = source.place(("conditions", name), f"conditions.{name}")
            raise InputError(f"{place}: no trial has this condition; {nearest(name, names)}")
    base = base_setup(file, source)
    return {
        name: _setup(file, keys, replace(source, prefix=("conditions", name)))
        if (keys := file.conditions.get(name))
        else base
        for name in names
    }


def assumed_edges(file: SessionFile, conditions: Mapping[str, Setup]) -> frozenset[float]:
    """Edge radii, m, that no one gave; `conditions` are the set-ups in use."""
    tools = [_given(file, file.conditions.get(name, ConditionKeys()))[0] for name in conditions]
    return frozenset(
        setup.tool.edge_radius
        for setup, tool in zip(conditions.values(), tools, strict=True)
        if setup.tool.edge_radius is not None and "edge_radius" not in tool
    )


def assumptions(file: SessionFile, conditions: Mapping[str, Setup]) -> list[str]:
    """One sentence for each key of tool and support that no one gave; `conditions` are the set-ups in use."""
    tools = [_given(file, file.conditions.get(name, ConditionKeys())) for name in conditions]
    said = [
        _WHY[key]
        for key in _ASSUMED
        if any(key not in tool and not (key == "radius" and "specimen_radius" in support) for tool, support in tools)
    ]
    said += [
        f"the tool's edge is not given: assumed rounded by {1e3 * edge:g} mm, a tenth of its radius; "
        f'state tool.edge_radius = "{1e3 * edge:g} mm" or the measured one'
        for edge in sorted(assumed_edges(file, conditions))
    ]
    if any("kind" not in support for _, support in tools):
        said.append(
            "the support is not given: assumed bonded to a rigid base (--set support.kind=hole, half_space, plates)"
        )
    return said


def _setup(file: SessionFile, condition: ConditionKeys, source: Source) -> Setup:
    """Tool and support of a condition; a touching tool without an edge gets the assumed one."""
    setup = validated(Setup, _tables(file, condition), source)
    tool = setup.tool
    if tool.contact not in TOUCHING or tool.edge_radius is not None or setup.support.cylinder:
        return setup
    return setup.model_copy(update={"tool": tool.model_copy(update={"edge_radius": ASSUMED_EDGE * tool.radius})})


def _given(file: SessionFile, condition: ConditionKeys) -> tuple[dict[str, Any], dict[str, Any]]:
    return {**file.tool, **condition.tool}, {**file.support, **condition.support}


def _tables(file: SessionFile, condition: ConditionKeys) -> dict[str, Any]:
    tool, support = _given(file, condition)
    covering = {"radius": support["specimen_radius"]} if "specimen_radius" in support else {}
    return {"tool": {**_ASSUMED, **covering, **tool}, "support": support}
