import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from benchmark.errors import InputError
from benchmark.files.load import Load, load_history, read_load_file
from benchmark.files.quantities import FROM_FILE


def write(folder, text):
    path = folder / "load.csv"
    path.write_text(text)
    return path


def test_reads_the_column_of_its_control(tmp_path):
    path = write(tmp_path, "time_s,force_N,depth_mm,note\n0,0,0,a\n0.5,2,1.5,b\n")
    assert read_load_file(path, "force") == ((0.0, 0.0), (0.5, 2.0))
    assert read_load_file(path, "depth") == ((0.0, 0.0), (0.5, 1.5e-3))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "empty"),
        ("time_s,force_N\n", "at least one row after 0 s"),
        ("time_s,force_N\n0,1\n", "at least one row after 0 s"),
        ("time_s,force_N\n-1,0\n1,1\n", "at least one row after 0 s and none before"),
        ("time_s\n1\n", "'force_N'"),
        ("t,force_N\n1,1\n", "'time_s'"),
        ("time_s,force_N\n1,1\n1,2\n", "does not increase"),
        ("time_s,force_N\n2,1\n1,2\n", "does not increase"),
        ("time_s,force_N\n1,nan\n", "finite"),
        ("time_s,force_N\n1,much\n", "'much'"),
        ("time_s,force_N\n1,\n", "empty"),
    ],
)
def test_a_table_that_cannot_be_applied_is_refused_with_its_file(tmp_path, text, says):
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=says) as refusal:
        read_load_file(path, "force")
    assert str(path) in str(refusal.value)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_load_file(tmp_path / "none.csv", "force")


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (5, "list of pairs"),
        ([["1 s"]], "list of pairs"),
        ([["1 s", "1 N", "2 N"]], "list of pairs"),
        (["1 s"], "list of pairs"),
        ([["1 s", "1 mm"]], "row 1: '1 mm' is a length"),
        ([["1 s", "1 N"], [2, "1 N"]], "row 2: the bare number 2"),
        ([["1 s", "1 N"], ["1 s", "2 N"]], "row 2 is at 1 s after 1 s"),
        ([["-1 s", "1 N"]], "row 1: '-1 s' is outside"),
        ([], "at least one row after 0 s"),
    ],
)
def test_rows_in_the_scenario_are_checked_alike(table, says):
    with pytest.raises(ValueError, match=says):
        Load.model_validate({"shape": "table", "table": table}, context=FROM_FILE)


def test_the_error_of_a_row_is_pydantics_own_kind():
    assert issubclass(PydanticCustomError, ValueError)


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


def test_the_triangle_behind_table_2():
    time, value = load_history(Load(peak=50.0, duration=10.0, observations=100))
    np.testing.assert_allclose(time, np.arange(1, 101) / 10, rtol=1e-15)
    np.testing.assert_allclose(value, [*range(1, 51), *range(49, -1, -1)], rtol=1e-15)


def test_its_statistics_are_those_the_article_prints():
    value = load_history(Load(peak=0.11016, observations=100)).value
    assert round(value.mean(), 5) == 0.05508
    assert round(value.var(ddof=1), 6) == 0.001022


@given(half=st.integers(1, 300), peak=st.floats(1e-3, 1e3), duration=st.floats(1e-3, 1e4))
def test_a_triangle_rises_to_its_peak_in_the_middle_and_ends_unloaded(half, peak, duration):
    time, value = load_history(Load(peak=peak, duration=duration, observations=2 * half))
    assert value.argmax() == half - 1
    assert value[half - 1] == peak
    assert value[-1] == 0.0
    assert time[-1] == duration
    assert time[0] > 0
    np.testing.assert_allclose(value[: half - 1], value[half:-1][::-1], rtol=1e-12)


def test_an_odd_triangle_steps_over_its_peak():
    value = load_history(Load(peak=5.0, observations=5)).value
    np.testing.assert_allclose(value, [2, 4, 4, 2, 0])


def test_a_ramp_ends_at_its_peak():
    time, value = load_history(Load(peak=-4.0, shape="ramp", duration=2.0, observations=4))
    np.testing.assert_allclose(time, [0.5, 1, 1.5, 2])
    np.testing.assert_allclose(value, [-1, -2, -3, -4])


def test_ramp_and_hold_share_the_rows_by_duration():
    time, value = load_history(Load(peak=3.0, shape="ramp_hold", duration=3.0, hold=1.0, observations=8))
    np.testing.assert_allclose(time, np.arange(1, 9) / 2)
    np.testing.assert_allclose(value, [0.5, 1, 1.5, 2, 2.5, 3, 3, 3])


@given(duration=st.floats(1e-3, 1e3), hold=st.floats(1e-3, 1e3), count=st.integers(2, 200))
def test_the_end_of_the_ramp_and_of_the_hold_are_always_rows(duration, hold, count):
    load = Load(peak=1.0, shape="ramp_hold", duration=duration, hold=hold, observations=count)
    time, value = load_history(load)
    assert len(time) == len(value) == count
    assert (np.diff(time) > 0).all()
    assert time[-1] == duration + hold
    assert value[time == duration].tolist() == [1.0]
    assert value[-1] == 1.0


def table(**keys):
    return Load(shape="table", table=((0.0, 1.0), (1.0, 3.0), (4.0, 0.0)), **keys)


def test_the_rows_of_a_table_are_its_observations():
    time, value = load_history(table())
    assert time.tolist() == [1.0, 4.0]
    assert value.tolist() == [3.0, 0.0]


def test_a_table_is_interpolated_when_observations_are_given():
    time, value = load_history(table(observations=8))
    np.testing.assert_allclose(time, np.arange(1, 9) / 2)
    np.testing.assert_allclose(value, [2, 3, 2.5, 2, 1.5, 1, 0.5, 0])


def test_a_table_without_a_row_at_zero_begins_unloaded():
    load = Load(shape="table", table=((1.0, 2.0), (2.0, 4.0)), observations=4)
    np.testing.assert_allclose(load_history(load).value, [1, 2, 3, 4])


def test_a_table_of_depths():
    load = Load(control="depth", shape="table", table=((1.0, 2e-3),))
    assert load_history(load).value.tolist() == [2e-3]
    assert load.peak == 2e-3


@pytest.mark.parametrize("count", [2, 3, 100, 101])
def test_there_is_no_row_at_time_zero(count):
    assert load_history(Load(peak=1.0, observations=count)).time.min() > 0
