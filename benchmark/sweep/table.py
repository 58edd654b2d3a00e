"""`points.parquet`: one row a point with its varied keys, results, status and reason."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmark.sweep.design import Point
from benchmark.sweep.parameter import Parameter
from benchmark.sweep.point import PointResult
from reports.result_folder import replace_file

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
