from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.files.sessions.description import TrialEntry
from benchmark.files.sessions.trials import (
    is_synthetic,
    read_markers,
    read_table,
    trial_names,
    trial_paths,
)
from benchmark.files.sources import Source

FOLDER = Path("s")


@pytest.mark.parametrize(
    ("files", "names"),
    [
        (["a.csv", "b.csv"], ["a", "b"]),
        (["slow/a.csv", "fast/a.csv"], ["slow/a", "fast/a"]),
        (["a.csv", "a.mcap", "b.csv"], ["a.csv", "a.mcap", "b"]),
        (["a.csv", "b.csv", "a.csv"], ["a.csv #1", "b", "a.csv #3"]),
    ],
)
def test_each_trial_has_a_name_of_its_own(files, names):
    assert trial_names([FOLDER / file for file in files], FOLDER) == names


def test_files_are_looked_for_inside(session_folder):
    source = Source("session.toml", folder=session_folder)
    entries = [TrialEntry(file="one.csv", condition="a", markers="two.csv"), TrialEntry(file="two.csv", condition="a")]
    assert trial_paths(entries, source)[:2] == (
        [session_folder / "one.csv", session_folder / "two.csv"],
        [session_folder / "two.csv", None],
    )
    with pytest.raises(InputError, match=r"trials\[#1\]\.file: '\.\./x\.csv' is outside"):
        trial_paths([TrialEntry(file="../x.csv", condition="a")], source)
    with pytest.raises(InputError, match=r"trials\[#1\]\.markers: there is no file"):
        trial_paths([TrialEntry(file="one.csv", condition="a", markers="no.csv")], source)


def test_a_table_is_read_in_si(session_folder):
    table = read_table(session_folder / "one.csv")
    assert (table.depth[2], table.force[2], table.extra["gap"][2]) == pytest.approx((0.1e-3, 0.02, 7.9e-3), rel=1e-12)


HEAD = "time_s,depth_mm,force_N\n"
ROWS = [f"{0.1 * row:.1f},1,1" for row in range(30)]


@pytest.mark.parametrize(
    "text",
    [
        "",
        HEAD,
        HEAD + "\n".join(ROWS[:3]),
        HEAD + "\n".join([*ROWS[:-1], "2.9,x,1"]),
        HEAD + "\n".join([*ROWS[:-1], "2.9,nan,1"]),
        HEAD + "\n".join([*ROWS[:-1], "2.9,inf,1"]),
        HEAD + "\n".join([*ROWS[:-1], "1.0,1,1"]),
        HEAD.replace("force_N", "force") + "\n".join(ROWS),
    ],
    ids=["empty", "no rows", "3 rows", "text", "NaN", "infinite", "backwards", "no force"],
)
def test_a_bad_table_is_an_input_error_that_names_its_file(tmp_path, text):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(InputError) as refusal:
        read_table(path)
    assert str(path) in str(refusal.value)
    assert "allowed" in str(refusal.value)
    with pytest.raises(InputError):
        read_markers(path)


@pytest.mark.parametrize("synthetic", [True, False])
def test_a_native_trial_is_read_and_says_what_made_it(tmp_path, write_native_trial, synthetic):
    path = write_native_trial(tmp_path / "trial.mcap", synthetic)
    table = read_table(path)
    assert table.depth[20] == pytest.approx(1e-3, rel=1e-9)
    assert table.force[20] == pytest.approx(0.2, rel=1e-9)
    assert is_synthetic(path) == synthetic


def test_a_csv_file_cannot_say_what_made_it(session_folder):
    assert not is_synthetic(session_folder / "one.csv")


def test_a_native_file_that_is_none_is_an_input_error(tmp_path):
    path = tmp_path / "bad.mcap"
    path.write_bytes(b"not a trial")
    with pytest.raises(InputError, match=r"bad\.mcap"):
        read_table(path)
