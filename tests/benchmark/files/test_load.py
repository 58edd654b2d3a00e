import pytest
from pydantic import ValidationError

from benchmark.files.load import Load
from benchmark.files.quantities import FROM_FILE


def read(folder=".", **table):
    return Load.model_validate(table, context={**FROM_FILE, "folder": folder})


def refusal(folder=".", **table):
    with pytest.raises(ValidationError) as error:
        read(folder, **table)
    return error.value.errors()[0]["msg"]


def test_a_load_is_a_triangle_of_ten_seconds_in_a_hundred_rows():
    load = read(peak="5 N")
    assert (load.control, load.shape, load.peak) == ("force", "triangle", 5.0)
    assert (load.duration, load.observations) == (10.0, 100)


def test_the_peak_is_a_force_or_a_depth():
    assert read(control="depth", peak="2 mm").peak == 2e-3
    assert read(control="force", peak="-0.5 N").peak == -0.5
    assert "is a length, not a force" in refusal(control="force", peak="2 mm")
    assert "is a force, not a length" in refusal(control="depth", peak="2 N")
    assert "the bare number 5 has no unit" in refusal(peak=5)


@pytest.mark.parametrize("peak", ["0 N", "0.0 N", "-0 N", "0 kN"])
def test_a_peak_of_zero_is_no_press(peak):
    assert "is no press; allowed: any force but zero" in refusal(peak=peak)


def test_a_small_and_a_large_peak():
    assert read(peak="0.001 N").peak == 1e-3
    assert read(peak="77.8 kN").peak == 77.8e3


def test_ramp_hold_needs_a_hold_and_others_ignore_it():
    assert "needs it" in refusal(peak="5 N", shape="ramp_hold")
    assert read(peak="5 N", shape="ramp_hold", hold="3 s").hold == 3.0
    assert read(peak="5 N", shape="triangle", hold="3 s").hold == 3.0


@pytest.mark.parametrize("shape", ["triangle", "ramp_hold"])
def test_two_parts_need_two_observations(shape):
    assert "at least 2 observations, not 1" in refusal(peak="5 N", shape=shape, hold="1 s", observations=1)
    assert read(peak="5 N", shape="ramp", observations=1).observations == 1


@pytest.mark.parametrize("count", [0, -1, 2_000_000, 1.5, "ten"])
def test_observations_are_counted(count):
    assert "1 to 1000000" in refusal(peak="5 N", observations=count)


def test_a_table_comes_from_a_file(tmp_path):
    (tmp_path / "load.csv").write_text("time_s,depth_mm,force_N\n0,0,0\n1,1,0.5\n3,-2,1\n")
    load = read(tmp_path, control="depth", shape="table", file="load.csv", peak="9 mm", duration="99 s")
    assert load.table == ((0.0, 0.0), (1.0, 1e-3), (3.0, -2e-3))
    assert (load.peak, load.duration, load.observations) == (-2e-3, 3.0, None)
    assert read(tmp_path, shape="table", file="load.csv").peak == 1.0


def test_a_table_may_stand_in_the_scenario_and_is_written_there():
    load = read(shape="table", table=[["0.1 s", "1 N"], ["0.2 s", "3 N"]])
    assert load.table == ((0.1, 1.0), (0.2, 3.0))
    assert load.to_table()["table"] == [["0.1 s", "1 N"], ["0.2 s", "3 N"]]
    assert Load.model_validate(load.to_table(), context=FROM_FILE) == load


def test_a_table_must_come_from_somewhere_and_press(tmp_path):
    assert "needs it; give a CSV file" in refusal(shape="table")
    assert "both `file` and `table`" in refusal(shape="table", file="x.csv", table=[["1 s", "1 N"]])
    assert "is no file name" in refusal(shape="table", file=5)
    assert "is no press" in refusal(shape="table", table=[["1 s", "0 N"]])


def test_a_table_is_dropped_with_its_shape():
    load = read(shape="ramp", peak="5 N", file="gone.csv")
    assert load.table is None
    assert "file" not in load.to_table()


def test_a_wrong_control_is_what_is_reported():
    assert "'force' or 'depth'" in refusal(control="speed", peak="5 N")
    assert "'force' or 'depth'" in refusal(control="speed", shape="table", file="x.csv")
