"""`import`: files of other rigs, their layouts, units and mistakes."""

import json

import numpy as np
import pytest

from bench_hw.tables import read_marker_csv, read_trial_csv

COUNT = 30


@pytest.fixture
def machine(tmp_path):
    """A testing machine's file: title lines, units below the header, tabs, decimal commas, pull positive."""
    lines = ["Testing machine 7", "", "Time (ms)\tPosition [um]\tLoad: cell 1\tNote", "ms\tum\tgf\t"]
    for n in range(COUNT):
        cells = (f"{n * 10}", f"{1500 + n * 12.5}", f"{-n * 2.5}", "ok")
        lines.append("\t".join(cells).replace(".", ","))
    path = tmp_path / "run1.txt"
    path.write_text("\n".join(lines) + "\n", encoding="latin-1")
    return path


LAYOUT = ("--delimiter", "tab", "--decimal", ",", "--encoding", "latin-1", "--skip-lines", "2", "--skip-rows", "1")
MAPS = ("--map", "time_s=Time (ms):ms", "--map", "depth_mm=Position [um]:um", "--map", "force_N=Load: cell 1:gf")


def test_a_testing_machines_file_becomes_a_trial(run, machine, tmp_path):
    ran = run(
        "import",
        machine,
        "--out",
        tmp_path / "trials",
        *LAYOUT,
        *MAPS,
        "--negate",
        "force_N",
        "--zero",
        "depth_mm",
        "--json",
    )
    assert (ran.exit_code, ran.stderr) == (0, "")
    out = tmp_path / "trials" / "run1.csv"
    assert json.loads(ran.stdout) == {
        "schema": 1,
        "files": [
            {
                "source": str(machine),
                "out": str(out),
                "rows": COUNT,
                "dropped": 0,
                "columns": {"time_s": "Time (ms)", "depth_mm": "Position [um]", "force_N": "Load: cell 1"},
            }
        ],
    }
    table = read_trial_csv(out)
    np.testing.assert_allclose(table.time, np.arange(COUNT) * 0.01)
    np.testing.assert_allclose(table.depth, np.arange(COUNT) * 12.5e-6, atol=1e-12)
    np.testing.assert_allclose(table.force, np.arange(COUNT) * 2.5 * 9.80665e-3)


def write_csv(path, header, rows):
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_columns_under_their_own_names_need_no_map_and_more_can_be_taken(run, tmp_path):
    rows = (f"{n / 10},{n / 4},{n / 8},{n * 0.001}" for n in range(COUNT))
    path = write_csv(tmp_path / "a.csv", "time_s,depth_mm,force_N,h", rows)
    ran = run("import", path, "--out", tmp_path / "b.csv", "--map", "gap_mm=h:inch", "--map", "cycle=#1")
    assert (ran.exit_code, ran.stderr) == (0, "")
    table = read_trial_csv(tmp_path / "b.csv")
    np.testing.assert_allclose(table.extra["gap"], np.arange(COUNT) * 0.001 * 0.0254)
    np.testing.assert_allclose(table.extra["cycle"], np.arange(COUNT) / 10)


def test_a_file_without_header_and_times(run, tmp_path):
    path = tmp_path / "bare.dat"
    path.write_text("# remark\n" + "".join(f"{n};{2 * n}\n" for n in range(COUNT)))
    ran = run(
        "import",
        path,
        "--out",
        tmp_path / "out",
        "--no-header",
        "--comment",
        "#",
        "--rate",
        "0.5 kHz",
        "--map",
        "depth_mm=#1:um",
        "--map",
        "force_N=#2:mN",
    )
    assert (ran.exit_code, ran.stderr) == (0, "")
    table = read_trial_csv(tmp_path / "out" / "bare.csv")
    np.testing.assert_allclose(table.time, np.arange(COUNT) / 500)
    np.testing.assert_allclose(table.depth, np.arange(COUNT) * 1e-6)
    np.testing.assert_allclose(table.force, np.arange(COUNT) * 2e-3)


def test_a_file_without_header_loses_no_row_to_one(run, tmp_path):
    """Its first row was taken for names, and missing from the result, without a word."""
    path = tmp_path / "bare.csv"
    path.write_text("".join(f"{n / 10},{n},{n / 5}\n" for n in range(COUNT)))
    maps = ("--map", "time_s=#1:s", "--map", "depth_mm=#2:mm", "--map", "force_N=#3:N")
    ran = run("import", path, "--out", tmp_path / "out")
    assert "bench_hw import: --no-header --map time_s=#1:s" in ran.stderr.replace("\n", " ")
    ran = run("import", path, "--out", tmp_path / "out", *maps)
    assert ran.exit_code == 2
    assert "(row 1, value '0.0, 0, 0.0'): the header is a row of numbers" in ran.stderr.replace("\n", " ")
    ran = run("import", path, "--out", tmp_path / "out", "--no-header", *maps)
    assert (ran.exit_code, ran.stderr) == (0, "")
    assert len(read_trial_csv(tmp_path / "out" / "bare.csv").time) == COUNT


def test_rows_with_an_empty_cell_are_dropped_only_on_request(run, tmp_path):
    rows = [f"{n / 10},{n},{n if n != 7 else ''}" for n in range(COUNT)]
    path = write_csv(tmp_path / "a.csv", "time_s,depth_mm,force_N", rows)
    ran = run("import", path, "--out", tmp_path / "b.csv")
    assert ran.exit_code == 2
    assert "row 9, column 'force_N'" in ran.stderr
    assert "the cell is empty" in ran.stderr
    ran = run("import", path, "--out", tmp_path / "b.csv", "--drop-empty")
    assert "29 rows, 1 with an empty cell left out" in ran.stdout
    assert 0.7 not in read_trial_csv(tmp_path / "b.csv").time


def test_markers(run, tmp_path):
    rows = (f"{k * 40},{m},{m * 5000 + k},{k}" for k in range(10) for m in range(3))
    path = write_csv(tmp_path / "tracks.csv", "t,id,px,py", rows)
    maps = ("time_s=t:ms", "marker=id", "x_mm=px:um", "y_mm=py:um")
    options = [item for text in maps for item in ("--map", text)]
    assert run("import", path, "--out", tmp_path / "m.csv", *options).exit_code == 0
    table = read_marker_csv(tmp_path / "m.csv")
    assert len(table.time) == 30
    assert table.x.max() == pytest.approx(10e-3 + 9e-6)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--map", "depth_mm"), "--map 'depth_mm'; allowed: TARGET=SOURCE"),
        (("--map", "depth_mm=d:V"), "'V' is no unit that converts to mm"),
        (("--map", "depth_mm=d:nonsense"), "'nonsense' is no unit that converts to mm"),
        (("--map", "cycle=d:mm"), "'cycle' has no unit to convert to"),
        (("--map", "depth_mm=none:mm"), "column 'none'): the column is missing; allowed: one of 't', 'd', 'f'"),
        (("--map", "depth_mm=#9"), "the row has 3 cells"),
        (("--map", "depth_mm=d", "--map", "depth_mm=f"), "'depth_mm' is given twice"),
        (("--negate", "gap_mm"), "--negate 'gap_mm' is no column of the result"),
        (("--rate", "100 Hz"), "--rate 100.0 Hz; allowed: a rate above zero, and no --map of time_s"),
        (("--decimal", ";"), "--decimal ';'; allowed: . or ,"),
        (("--skip-lines", "500"), "the file is empty"),
        (("--encoding", "utf-9"), "no utf-9 text"),
        (("--skip-rows", "20"), "the table has 10 rows; allowed: at least 20 rows"),
    ],
)
def test_what_is_wrong_is_exit_two_with_the_way_out(run, tmp_path, options, reason):
    path = write_csv(tmp_path / "a.csv", "t,d,f", (f"{n},{n},{n}" for n in range(COUNT)))
    base = ["--map", "time_s=t", "--map", "force_N=f"]
    base += [] if "depth_mm" in str(options) else ["--map", "depth_mm=d"]
    ran = run("import", path, "--out", tmp_path / "out", *base, *options)
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert reason in ran.stderr
    assert ran.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("row", "reason"),
    [
        ("5,abc,1", "row 7, column 'd', value 'abc'): the cell is no finite number"),
        ("5,nan,1", "row 7, column 'd', value 'nan'"),
        ("4,1,1", "row 7, column 'time_s'): time_s does not increase: 4.0 follows 4.0"),
        ("5,1", "row 7, column 'f'): the row has 2 cells; allowed: at least 3"),
        ('5,1,"1', "row 7): the row cannot be split"),
    ],
)
def test_a_wrong_row_is_named(run, tmp_path, row, reason):
    rows = [f"{n},{n},{n}" for n in range(COUNT)]
    rows[5] = row
    path = write_csv(tmp_path / "a.csv", "t,d,f", rows)
    maps = ("--map", "time_s=t", "--map", "depth_mm=d", "--map", "force_N=f")
    ran = run("import", path, "--out", tmp_path / "out", *maps)
    assert ran.exit_code == 2
    assert f"{path} ({reason}" in ran.stderr
    assert not (tmp_path / "out").exists()


def test_a_missing_map_lists_the_files_columns(run, tmp_path):
    path = write_csv(tmp_path / "a.csv", "t,d,f", (f"{n},{n},{n}" for n in range(COUNT)))
    ran = run("import", path, "--out", tmp_path / "out", "--map", "time_s=t")
    assert "no column for depth_mm; allowed: --map depth_mm=SOURCE:UNIT" in ran.stderr
    assert "'t', 'd', 'f'" in ran.stderr


def test_several_files_are_imported_all_or_none(run, tmp_path):
    good = write_csv(tmp_path / "a.csv", "time_s,depth_mm,force_N", (f"{n},{n},{n}" for n in range(COUNT)))
    bad = write_csv(tmp_path / "b.csv", "time_s,depth_mm,force_N", (f"{n},{n},x" for n in range(COUNT)))
    assert run("import", good, bad, "--out", tmp_path / "out").exit_code == 2
    assert not (tmp_path / "out").exists()
    ran = run("import", good, "--out", tmp_path / "out")
    assert ran.exit_code == 0
    ran = run("import", good, "--out", tmp_path / "out")
    assert (ran.exit_code, "the file exists" in ran.stderr) == (2, True)
    assert run("import", good, "--out", tmp_path / "out", "--overwrite").exit_code == 0
    for out, reason in ((tmp_path / "one.csv", "one table for 2 files"), (tmp_path, "file to import itself")):
        ran = run("import", good, bad, "--out", out)
        assert (ran.exit_code, reason in ran.stderr) == (2, True)


@pytest.mark.parametrize("options", [(), ("--map", "force_N=force_N:N")])
def test_what_a_logger_writes_over_its_range_is_refused_with_its_row(run, tmp_path, options):
    """It was imported, and the table refused later."""
    path = tmp_path / "run.csv"
    rows = [f"{n / 10},{n / 20},{'9.9e37' if n == 7 else n / 50}" for n in range(COUNT)]
    path.write_text("\n".join(["time_s,depth_mm,force_N", *rows]) + "\n")
    ran = run("import", path, "--out", tmp_path / "out.csv", *options)
    said = " ".join(ran.stderr.split())
    assert ran.exit_code == 2
    assert "row 9, column 'force_N', value '9.9e+37'): the number is too large; allowed: numbers from -1e+09" in said
    assert not (tmp_path / "out.csv").exists()
