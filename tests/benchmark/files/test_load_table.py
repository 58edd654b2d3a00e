import pytest
from pydantic_core import PydanticCustomError

from benchmark.errors import InputError
from benchmark.files.load import Load
from benchmark.files.load_table import read_load_file
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
