"""The folder of a sweep: whose it is, and its points on disk as they finish."""

from __future__ import annotations

import io
import json
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bench_hw.storage.regular_file import DOCUMENT, read_regular
from benchmark.errors import InputError
from benchmark.resumable import Journal, begun, check_files, read_rows
from benchmark.runs.output.unfinished import is_kept
from benchmark.sweeps.design import Point
from benchmark.sweeps.parameter import Parameter
from benchmark.sweeps.plan import CODE, SCHEMA, SweepPlan, differences
from benchmark.sweeps.point import PointResult
from reports import extended_folder, write_json, write_text
from reports.manifest import MANIFEST, read_manifest, remove_known
from reports.result_folder import clear_leftovers, replace_file, settle

Columns = dict[str, list[Any]]


def point_columns(parameters: Sequence[Parameter], points: Sequence[Point], rows: Iterable[PointResult]) -> Columns:
    """Columns of finished points in the order of their numbers.

    A varied key has a column of its name with the value as `--set` takes it (a number where it has no unit), and, with
    a unit, one with the number, `KEY_UNIT`. Results that a point does not have are None.
    """
    ordered = sorted(rows, key=lambda row: row.point)
    columns: Columns = {"point": [row.point for row in ordered]}
    for place, parameter in enumerate(parameters):
        texts = [points[row.point - 1][place] for row in ordered]
        if parameter.unit or parameter.numbers is None:
            columns[parameter.key] = texts
        if parameter.numbers is not None:
            columns[parameter.column] = [parameter.number_of(text) for text in texts]
    names = dict.fromkeys(name for row in ordered for name in row.values)
    columns |= {name: [row.values.get(name) for row in ordered] for name in names}
    columns["status"] = [row.status for row in ordered]
    columns["reason"] = [row.reason for row in ordered]
    columns["warnings"] = [row.warnings for row in ordered]
    return columns


def write_points(path: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    """Write the columns as Parquet into a folder of ours; text, whole numbers and doubles keep their types."""
    import pyarrow
    from pyarrow import parquet

    texts = {"status", "reason", "warnings"}
    arrays = {}
    for name, values in columns.items():
        word = name in texts or any(isinstance(value, str) for value in values)
        kind = pyarrow.string() if word else pyarrow.int64() if name == "point" else pyarrow.float64()
        arrays[name] = pyarrow.array(values, type=kind)
    stream = io.BytesIO()
    parquet.write_table(pyarrow.table(arrays), stream)
    replace_file(path, stream.getvalue())


PLAN, JOURNAL, POINTS, UNFINISHED = "sweep.json", "journal.jsonl", "points.parquet", "unfinished"
DOING, GROWING = "sweep", (JOURNAL, UNFINISHED)
SCENARIO = "scenario.toml"
FILES = (PLAN, POINTS, SCENARIO, "sensitivity.csv", "environment.json", "report.html")
LEAST_PAUSE = 0.5
SHARE = 0.02
"""`points.parquet` is written anew as points finish, but takes no more than about this share of the time."""


class SweepFolder:
    """Finished points on disk: each in the journal at once, in `points.parquet` soon after.

    `changed` tells which lines of the journal were changed since they were written; their points are not finished.
    """

    def __init__(self, path: Path, plan: SweepPlan, journal: Journal):
        self.path = path
        self._plan, self._journal = plan, journal
        self.changed: list[str] = []
        rows = read_rows(path / JOURNAL, PointResult, self.changed.append)
        self.finished: dict[int, PointResult] = {row.point: row for row in rows}
        self._due = 0.0

    @property
    def unfinished(self) -> Path:
        """Where long points keep what they have so far; it need not exist."""
        return self.path / UNFINISHED

    def close(self) -> None:
        """End with what there is; once every point is there nothing is unfinished."""
        self._journal.close()
        if self.finished:
            self.write_table()
        if len(self.finished) == len(self._plan.points):
            remove_known(self.unfinished, is_kept)

    def add(self, row: PointResult) -> None:
        """Keep a finished point."""
        self._journal.add(row)
        self.finished[row.point] = row
        if time.monotonic() >= self._due:
            self.write_table()

    def write_table(self) -> None:
        """Write `points.parquet` with every finished point."""
        started = time.monotonic()
        columns = point_columns(self._plan.parameters, self._plan.points, self.finished.values())
        write_points(self.path / POINTS, columns)
        now = time.monotonic()
        self._due = now + max(LEAST_PAUSE, (now - started) / SHARE)


@contextmanager
def open_folder(path: Path, plan: SweepPlan) -> Iterator[SweepFolder]:
    """Take a new or empty folder for a sweep, or that of an earlier result, or go on with the same sweep in its folder.

    A complete result of another command steps aside as a whole, until `settle`. What somebody else put beside the sweep
    stays; a file of the sweep that was changed since is not replaced.

    Raises
    ------
    InputError
        The folder holds another sweep (the difference is named), or something else.
    """
    _check_holds(path, plan)
    clear_leftovers(path)
    _take(path, plan)
    folder = SweepFolder(path, plan, Journal(path / JOURNAL))
    try:
        yield folder
    finally:
        folder.close()
    if len(folder.finished) == len(plan.points):
        settle(path)


def _take(path: Path, plan: SweepPlan) -> None:
    """Begin a sweep in its folder, or go on with it there; one that is complete stays so."""
    there = read_manifest(path)
    known = there is not None and JOURNAL in {*there.files, *there.growing}
    planned = known and (path / PLAN).exists()
    finished = {row.point for row in read_rows(path / JOURNAL, PointResult)} if planned else set()
    if there is not None and not there.doing and len(finished) == len(plan.points):
        return
    with extended_folder(path, DOING, GROWING) if known else begun(path, DOING, GROWING) as new:
        if not planned:
            write_text(new / SCENARIO, plan.scenario.to_toml())
            write_json(new / PLAN, plan.document)


def _check_holds(path: Path, plan: SweepPlan) -> None:
    """Refuse what is not this sweep's folder."""
    if path.exists() and not path.is_dir():
        raise InputError(f"--out {path} is a file; it must be a folder that is new, empty, or of the same sweep")
    if (path / PLAN).is_file():
        there = _read_plan(path / PLAN)
        if there.get("schema") != SCHEMA:
            raise InputError(f"{path / PLAN} has the schema {there.get('schema')!r}; this version reads {SCHEMA}")
        here = json.loads(json.dumps(plan.document))
        apart = differences(there, here)
        if apart and {**there, CODE: None} == {**here, CODE: None}:
            raise InputError(
                f"--out {path} holds this sweep, begun by other code of the program: {apart[0]}; its rows would be of "
                "two codes. Give another --out, or go on with it by the code that began it"
            )
        if apart:
            raise InputError(
                f"--out {path} holds another sweep; it differs in {', '.join(apart)}. Give another --out, or the same "
                "command to go on with it"
            )
        if read_manifest(path) is None:
            raise InputError(
                f"--out {path} holds a sweep of an earlier version, without {MANIFEST}; move it away, or give another"
            )
    check_files(path, FILES, resumed=(path / PLAN).is_file(), no="not a sweep")


def _read_plan(path: Path) -> Mapping[str, Any]:
    try:
        table = json.loads(read_regular(path, DOCUMENT))
    except (ValueError, RecursionError):
        table = None
    if not isinstance(table, dict):
        raise InputError(f"{path} is no sweep of this program: it cannot be read as JSON")
    return table
