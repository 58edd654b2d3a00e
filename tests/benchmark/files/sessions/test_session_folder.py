import os
from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.files.sessions.session_folder import fingerprint, inside, session_table


def entries(path: Path):
    return [(trial["file"], trial["condition"]) for trial in session_table(path)[0]["trials"]]


def test_a_session_file_is_read(session_folder):
    table, source = session_table(session_folder)
    assert table["name"] == "two presses"
    assert source.folder == session_folder
    assert session_table(session_folder / "session.toml")[0] == table


def test_without_one_the_folder_is_a_condition(tmp_path, write_trial):
    for name in ("t_10.csv", "t_2.csv", "t_1.CSV", ".hidden.csv", "~$t_2.csv"):
        write_trial(tmp_path / "day" / name)
    (tmp_path / "day" / "README.md").write_text("text")
    (tmp_path / "day" / "odd.csv").mkdir()
    assert entries(tmp_path / "day") == [("t_1.CSV", "day"), ("t_2.csv", "day"), ("t_10.csv", "day")]
    assert session_table(tmp_path / "day")[0]["name"] == "day"


def test_sub_folders_are_conditions(tmp_path, write_trial):
    for name in ("top.csv", "slow/a.csv", "fast/a.csv", ".git/a.csv", "slow/deeper/b.csv"):
        write_trial(tmp_path / "s" / name)
    assert entries(tmp_path / "s") == [("top.csv", "s"), ("fast/a.csv", "fast"), ("slow/a.csv", "slow")]


def test_marker_tracks_belong_to_the_trial_of_the_same_name(tmp_path, write_trial):
    for name in ("a.csv", "a_markers.csv", "b.csv", "slow/c_10.csv", "slow/c_10_markers.csv"):
        write_trial(tmp_path / "s" / name)
    assert session_table(tmp_path / "s")[0]["trials"] == [
        {"file": "a.csv", "markers": "a_markers.csv", "condition": "s"},
        {"file": "b.csv", "condition": "s"},
        {"file": "slow/c_10.csv", "markers": "slow/c_10_markers.csv", "condition": "slow"},
    ]


def test_marker_tracks_without_their_trial_are_refused(tmp_path, write_trial):
    alone = write_trial(tmp_path / "s" / "a_markers.csv")
    write_trial(tmp_path / "s" / "b.csv")
    for path in (tmp_path / "s", alone):
        with pytest.raises(InputError, match="marker tracks"):
            session_table(path)


def test_native_trials_count(tmp_path):
    (tmp_path / "s").mkdir()
    for name in ("a.mcap", "b.mcap.part"):
        (tmp_path / "s" / name).write_bytes(b"")
    assert entries(tmp_path / "s") == [("a.mcap", "s")]


def test_one_file_is_a_session_of_one_trial(tmp_path, write_trial):
    assert entries(write_trial(tmp_path / "one.csv")) == [("one.csv", "one")]


@pytest.mark.parametrize("name", ["none", "", "notes.md", "empty", "x" * 300, "a\0b"])
def test_what_is_no_session_is_refused(tmp_path, name):
    (tmp_path / "notes.md").write_text("text")
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError):
        session_table(tmp_path / name)


def test_a_file_of_another_kind_is_told_what_is_read_and_how_it_gets_there(tmp_path):
    (tmp_path / "a.vi").write_text("no table")
    with pytest.raises(InputError, match=r"\.csv, \.txt, .*\.lvm, .* exports them as csv or txt, with time, depth"):
        session_table(tmp_path / "a.vi")


def test_a_pipe_or_a_device_is_said_to_be_one(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path(os.devnull)):
        with pytest.raises(InputError, match=r"this is a pipe or a device; allowed: a session's folder or file"):
            session_table(path)


def test_files_inside_are_found(session_folder, write_trial):
    write_trial(session_folder / "sub" / "three.csv")
    for name in ("one.csv", "sub/three.csv", "./one.csv", "sub/../one.csv"):
        assert inside(session_folder, name, "here").is_file()


def test_a_link_inside_may_lead_inside(session_folder):
    (session_folder / "link.csv").symlink_to("one.csv")
    assert inside(session_folder, "link.csv", "here") == session_folder / "link.csv"


def test_nothing_outside_is_reached(session_folder, write_trial):
    outside = write_trial(session_folder.parent / "outside.csv")
    (session_folder / "link.csv").symlink_to(outside)
    (session_folder / "folder").symlink_to(session_folder.parent)
    (session_folder / "loop.csv").symlink_to("loop.csv")
    absolute = str((session_folder / "one.csv").absolute())
    for name in ("../outside.csv", str(outside), absolute, "link.csv", "folder/outside.csv", "loop.csv", ".."):
        with pytest.raises(InputError, match=r"^here: .* is outside the session's folder"):
            inside(session_folder, name, "here")


def test_what_is_missing_or_no_file_is_said(session_folder):
    (session_folder / "sub").mkdir()
    os.mkfifo(session_folder / "pipe.csv")
    for name in ("none.csv", "sub", "pipe.csv"):
        with pytest.raises(InputError, match="there is no file"):
            inside(session_folder, name, "here")


def test_a_fingerprint_is_of_names_and_contents_in_any_order(session_folder):
    one, two = session_folder / "one.csv", session_folder / "two.csv"
    first = fingerprint(session_folder, [one, two])
    assert len(first) == 64
    assert fingerprint(session_folder, [two, one, one]) == first
    assert fingerprint(session_folder, [one]) != first
    two.write_text(two.read_text() + "\n")
    assert fingerprint(session_folder, [one, two]) != first


@pytest.mark.parametrize(("document", "verb"), [("fit.json", "fit"), ("results.json", "run")])
def test_a_result_is_no_session(tmp_path, document, verb):
    """Its tables were taken for trials, and the refusal asked for their columns."""
    for name in (document, "tables/candidates.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x,y\n1,2\n")
    assert session_table(tmp_path)[0]["trials"]  # a document of that name may be anybody's
    (tmp_path / "manifest.json").write_text('{"program": "tissuebench", "schema": 1}')
    with pytest.raises(InputError, match=f"this is a result of `{verb}`, not a session"):
        session_table(tmp_path)
