"""A sweep's folder and its points.parquet: names, types, order and empty cells, and whose the folder is."""

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from benchmark.errors import InputError
from benchmark.sweeps.parameter import parse_parameter
from benchmark.sweeps.point import PointResult, failed
from benchmark.sweeps.sweep_folder import open_folder, point_columns, write_points
from reports import whole_folder, write_text
from reports.manifest import foreign_files, read_manifest

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


VARY = "tool.radius=2 mm,3 mm,5 mm"
ROW = PointResult(2, "ok", None, None, {"x_mm": 1.0})


def test_points_are_in_the_table_as_they_come_and_at_the_end(plan_of, tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    with open_folder(out, plan_of(VARY)) as folder:
        folder.add(ROW)
        assert list(pd.read_parquet(out / "points.parquet").point) == [2]
        folder.add(failed(1, "no luck"))
    assert list(pd.read_parquet(out / "points.parquet").point) == [1, 2]
    names = {path.name for path in out.iterdir()}
    assert names == {"sweep.json", "scenario.toml", "journal.jsonl", "points.parquet", "manifest.json"}


def test_the_same_sweep_goes_on(plan_of, tmp_path: Path) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(ROW)
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        assert folder.finished == {2: ROW}


def test_unfinished_points_stay_until_all_are_there(plan_of, tmp_path: Path) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        (folder.unfinished / "point_000003").mkdir(parents=True)
        folder.add(ROW)
    assert (tmp_path / "unfinished" / "point_000003").is_dir()
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(failed(1, "no luck"))
        folder.add(failed(3, "no luck"))
    assert not (tmp_path / "unfinished").exists()


def test_an_interrupted_sweep_keeps_its_points(plan_of, tmp_path: Path) -> None:
    def interrupted() -> None:
        with open_folder(tmp_path, plan_of(VARY)) as folder:
            folder.add(failed(1, "no luck"))
            folder.add(ROW)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert list(pd.read_parquet(tmp_path / "points.parquet").point) == [1, 2]


@pytest.mark.parametrize(
    ("vary", "settings", "word"),
    [
        ("tool.radius=2 mm,3 mm", {}, "vary.tool.radius"),
        ("tool.radius=2 mm,3 mm,5 mm", {"load_peak": "1 N"}, "scenario.load.peak"),
        ("dermis.thickness=2 mm,3 mm,5 mm", {}, "vary.dermis.thickness"),
    ],
)
def test_another_sweep_is_refused_with_the_difference(plan_of, tmp_path: Path, vary, settings, word) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(ROW)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(InputError, match="another sweep") as caught, open_folder(tmp_path, plan_of(vary, **settings)):
        pass
    assert word in str(caught.value)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_the_same_sweep_of_other_code_is_refused(plan_of, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(ROW)
    before = tree(tmp_path)
    monkeypatch.setattr("benchmark.sweeps.plan.code_version", lambda: "another")
    match = r"begun by other code of the program: code_sha256 \(.* there, 'another' here\).* another --out"
    with pytest.raises(InputError, match=match), open_folder(tmp_path, plan_of(VARY)):
        pass
    assert tree(tmp_path) == before


def test_a_row_changed_by_hand_is_computed_again(plan_of, tmp_path: Path) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        all_points(folder)
        folder.add(ROW)
    journal = tmp_path / "journal.jsonl"
    journal.write_text(journal.read_text().replace('"x_mm": 1.0', '"x_mm": 7.0').replace("no luck", "bad luck", 1))
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        assert {*folder.finished} == {2, 3}
        assert folder.finished[2].status == "failed"
        assert [said.partition(" was changed")[0] for said in folder.changed] == [f"{journal} line {n}" for n in (1, 4)]


def test_a_folder_of_something_else_is_refused(plan_of, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="not a sweep"), open_folder(tmp_path, plan_of(VARY)):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]
    with pytest.raises(InputError, match="is a file"), open_folder(tmp_path / "thesis.tex", plan_of(VARY)):
        pass


@pytest.mark.parametrize("text", ["[]", "no json", "{}"])
def test_a_plan_that_is_none_is_refused(plan_of, tmp_path: Path, text: str) -> None:
    (tmp_path / "sweep.json").write_text(text)
    with pytest.raises(InputError, match=r"sweep\.json"), open_folder(tmp_path, plan_of(VARY)):
        pass


def test_what_a_crash_left_half_written_is_removed(plan_of, tmp_path: Path) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(ROW)
    (tmp_path / ".points.parquet.1234abcd.part").write_bytes(b"half")
    (tmp_path / "sweep.json").unlink()  # a crash came before it
    ours = {"sweep.json", "scenario.toml", "journal.jsonl", "points.parquet", "manifest.json"}
    with open_folder(tmp_path, plan_of(VARY)):
        assert {path.name for path in tmp_path.iterdir()} == ours


def test_what_is_not_of_the_sweep_stays_and_what_was_changed_is_refused(plan_of, tmp_path: Path) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(ROW)
    for name in ("notes.txt", ".mine.part", "unfinished/notes.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("mine")
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        folder.add(failed(1, "no luck"))
        folder.add(failed(3, "no luck"))
    assert all((tmp_path / name).read_text() == "mine" for name in ("notes.txt", ".mine.part", "unfinished/notes.txt"))
    (tmp_path / "points.parquet").write_bytes(b"corrected by hand")
    with pytest.raises(InputError, match=r"points\.parquet"), open_folder(tmp_path, plan_of(VARY)):
        pass
    assert (tmp_path / "points.parquet").read_bytes() == b"corrected by hand"


def tree(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def all_points(folder) -> None:
    for point in (1, 2, 3):
        folder.add(failed(point, "no luck"))


def test_a_result_of_another_command_waits_as_a_whole_and_goes_once_the_sweep_is_complete(plan_of, tmp_path) -> None:
    out, aside = tmp_path / "p", tmp_path / ".p.previous"
    with whole_folder(out) as new:
        for name in ("results.json", "scenario.toml", "report.html"):
            write_text(new / name, "{}" if name.endswith("json") else "")
    before = tree(out)
    with open_folder(out, plan_of(VARY)) as folder:
        folder.add(ROW)
    assert tree(aside) == before
    assert {"results.json", "report.html"}.isdisjoint(tree(out))
    with open_folder(out, plan_of(VARY)) as folder:
        assert folder.finished == {2: ROW}
        assert tree(aside) == before
        all_points(folder)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p"]


def test_a_complete_sweep_is_replaced_with_its_journal_and_stays_as_it_is_when_it_is_looked_at(plan_of, tmp_path):
    out = tmp_path / "p"
    with open_folder(out, plan_of(VARY)) as folder:
        all_points(folder)
    assert "journal.jsonl" in read_manifest(out).files
    before = tree(out)
    with open_folder(out, plan_of(VARY)) as folder:
        assert len(folder.finished) == 3
        assert not read_manifest(out).doing
    assert {name: data for name, data in tree(out).items() if name == "journal.jsonl"}.items() <= before.items()
    with whole_folder(out) as new:
        write_text(new / "a", "1")
    assert set(tree(tmp_path)) == {"p/a", "p/manifest.json"}


def test_points_taken_out_of_the_journal_of_a_complete_sweep_are_computed_again(plan_of, tmp_path) -> None:
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        all_points(folder)
    lines = (tmp_path / "journal.jsonl").read_bytes().splitlines(keepends=True)
    (tmp_path / "journal.jsonl").write_bytes(b"".join(lines[:2]))
    with open_folder(tmp_path, plan_of(VARY)) as folder:
        assert set(folder.finished) == {1, 2}
        assert read_manifest(tmp_path).doing == "sweep"
        folder.add(ROW)
        all_points(folder)
    assert foreign_files(tmp_path) == []
