"""points.parquet: names, types, order, and empty cells."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from benchmark.sweep.parameter import parse_parameter
from benchmark.sweep.point import PointResult, failed
from benchmark.sweep.table import point_columns, write_points

PARAMETERS = [parse_parameter(text) for text in ("d.e=50 kPa:500 kPa:2", "d.nu=0.4,0.45", "tool.contact=a,b")]
POINTS = [("50 kPa", "0.4", "a"), ("500 kPa", "0.45", "b"), ("50 kPa", "0.45", "a")]
ROWS = [
    PointResult(3, "ok", None, "mind", {"x_mm": 3.0, "other_N": 1.0 / 3.0}),
    PointResult(1, "ok", None, None, {"x_mm": 0.1 + 0.2}),
    failed(2, "no luck"),
]


def test_the_table_reads_back(tmp_path) -> None:
    path = tmp_path / "points.parquet"
    write_points(path, point_columns(PARAMETERS, POINTS, ROWS))
    frame = pd.read_parquet(path)
    assert list(frame) == [
        "point", "d.e", "d.e_kPa", "d.nu", "tool.contact", "x_mm", "other_N", "status", "reason", "warnings",
    ]  # fmt: skip
    assert list(frame.point) == [1, 2, 3]
    assert list(frame["d.e"]) == ["50 kPa", "500 kPa", "50 kPa"]
    assert list(frame["d.e_kPa"]) == [50.0, 500.0, 50.0]
    assert list(frame["d.nu"]) == [0.4, 0.45, 0.45]
    assert list(frame["tool.contact"]) == ["a", "b", "a"]
    assert frame.x_mm[0] == 0.1 + 0.2
    np.testing.assert_array_equal(frame.other_N.isna(), [True, True, False])
    assert list(frame.status) == ["ok", "failed", "ok"]
    assert frame.reason[1] == "no luck"
    assert frame.reason.isna().sum() == 2


@pytest.mark.parametrize("rows", [ROWS, ROWS[2:], ROWS[1:2]])
def test_types_do_not_depend_on_what_is_there(tmp_path, rows) -> None:
    path = tmp_path / "points.parquet"
    write_points(path, point_columns(PARAMETERS, POINTS, rows))
    types = {field.name: str(field.type) for field in pq.read_schema(path)}
    assert types["point"] == "int64"
    assert types["d.e"] == types["status"] == types["reason"] == types["warnings"] == "string"
    assert {types[name] for name in types if name.endswith(("_mm", "_N", "_kPa", ".nu"))} == {"double"}
