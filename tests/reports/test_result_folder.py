import errno
import hashlib
import json
import os
import shutil
import tempfile
from pathlib import Path

import pytest

from reports import result_folder
from reports.atomic import write_text
from reports.manifest import MANIFEST, ForeignFilesError, foreign_files, read_manifest
from reports.result_folder import KeptElsewhereError, check_place, extended_folder, recover, whole_folder, write_whole


def names(folder):
    return sorted(item.name for item in folder.iterdir())


def tree(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def make(target, **texts):
    with whole_folder(target) as folder:
        for name, text in texts.items():
            write_text(folder / "tables" / name, text)
    return target


def test_a_folder_appears_when_it_is_complete(tmp_path):
    target = tmp_path / "deep" / "result"
    with whole_folder(target) as folder:
        write_text(folder / "tables" / "a.csv", "1")
        assert not target.exists()
        assert folder.parent == target.parent
    assert (target / "tables" / "a.csv").read_text() == "1"
    assert names(target.parent) == ["result"]


def test_the_manifest_names_every_file_with_size_and_hash(tmp_path):
    table = json.loads((make(tmp_path / "result", a="one") / MANIFEST).read_text())
    entry = {"size": 3, "sha256": hashlib.sha256(b"one").hexdigest()}
    assert table == {"schema": 1, "program": "tissuebench", "files": {"tables/a": entry}}


def test_a_new_folder_replaces_the_whole_old_one(tmp_path):
    target = make(tmp_path / "result", old="x")
    with whole_folder(target) as folder:
        (folder / "new").touch()
        assert (target / "tables" / "old").is_file()
    assert names(target) == [MANIFEST, "new"]
    assert names(tmp_path) == ["result"]


def fail(folder, error):
    (folder / "new").touch()
    raise error


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_an_exception_leaves_the_old_folder(tmp_path, error):
    target = make(tmp_path / "result", old="x")
    before = tree(target)
    with pytest.raises(error), whole_folder(target) as folder:
        fail(folder, error)
    assert tree(target) == before
    assert names(tmp_path) == ["result"]


def test_an_exception_leaves_no_new_parents(tmp_path):
    with pytest.raises(ValueError, match="bad input"), whole_folder(tmp_path / "a" / "b" / "c"):
        raise ValueError("bad input")
    assert names(tmp_path) == []


def test_an_old_folder_comes_back_and_the_new_one_is_kept_if_it_cannot_take_its_place(tmp_path, monkeypatch):
    target = make(tmp_path / "result", old="x")
    before = tree(target)
    rename = Path.rename

    def refuse_the_place(self, to):
        if to == target and (self / "new").exists():
            raise OSError("no rename today")
        return rename(self, to)

    monkeypatch.setattr(Path, "rename", refuse_the_place)
    with (
        pytest.raises(KeptElsewhereError, match=r"no rename today.*kept in .*result-2"),
        whole_folder(target) as folder,
    ):
        (folder / "new").touch()
    assert tree(target) == before
    assert names(tmp_path) == ["result", "result-2"]
    assert names(tmp_path / "result-2") == [MANIFEST, "new"]


def test_a_file_is_no_place_for_a_folder(tmp_path):
    path = write_text(tmp_path / "result", "mine")
    with pytest.raises(FileExistsError, match="is a file"), whole_folder(path):
        pass
    assert path.read_text() == "mine"


def test_a_link_to_a_folder_stays_a_link(tmp_path):
    real = tmp_path / "real"
    real.mkdir()
    link = tmp_path / "latest"
    link.symlink_to(real)
    with whole_folder(link) as folder:
        (folder / "new").touch()
    assert link.is_symlink()
    assert names(real) == [MANIFEST, "new"]


def note(folder):
    (folder / "notes.txt").write_text("mine")


def raw_data(folder):
    (folder / "data").mkdir()
    (folder / "data" / "raw.csv").write_text("1,2")


def repository(folder):
    (folder / ".git").mkdir()
    (folder / ".git" / "HEAD").write_text("ref")


def edit(folder):
    (folder / "tables" / "a").write_text("corrected")


def empty_folder(folder):
    (folder / "figures").mkdir()


def link(folder):
    (folder / "tables" / "a").unlink()
    (folder / "tables" / "a").symlink_to("/etc/hostname")


def part_of_theirs(folder):
    (folder / ".thesis.tex.01234567.part").write_text("mine")


def no_manifest(folder):
    (folder / MANIFEST).unlink()


def other_manifest(folder):
    (folder / MANIFEST).write_text('{"name": "a web page"}')


@pytest.mark.parametrize(
    ("do", "named"),
    [
        (note, "notes.txt"),
        (raw_data, "data/raw.csv"),
        (repository, ".git/HEAD"),
        (edit, "tables/a"),
        (empty_folder, "figures"),
        (link, "tables/a"),
        (part_of_theirs, ".thesis.tex.01234567.part"),
        (no_manifest, "earlier version"),
        (other_manifest, "manifest.json"),
    ],
)
def test_what_is_not_ours_is_refused_before_and_survives(tmp_path, do, named):
    target = make(tmp_path / "result", a="1", b="2")
    do(target)
    before = tree(target)
    with pytest.raises(ForeignFilesError, match=named):
        check_place(target)
    with pytest.raises(ForeignFilesError, match=named), whole_folder(target):
        raise AssertionError("the work must not begin")
    assert tree(target) == before
    assert names(tmp_path) == ["result"]


def test_what_comes_while_the_work_is_done_survives_and_the_result_is_kept_beside(tmp_path):
    target = make(tmp_path / "result", a="1")

    def work():
        with whole_folder(target) as folder:
            (folder / "new").touch()
            note(target)

    with pytest.raises(KeptElsewhereError, match=r"notes.txt.*result-2"):
        work()
    assert (target / "notes.txt").read_text() == "mine"
    assert (target / "tables" / "a").read_text() == "1"
    assert names(tmp_path / "result-2") == [MANIFEST, "new"]


def test_what_comes_between_the_check_and_the_renames_survives(tmp_path, monkeypatch):
    target = make(tmp_path / "result", a="1")
    aside = result_folder._step_aside

    def late(place, previous):
        note(place)
        aside(place, previous)

    monkeypatch.setattr(result_folder, "_step_aside", late)
    with pytest.raises(KeptElsewhereError, match=r"notes.txt"), whole_folder(target) as folder:
        (folder / "new").touch()
    assert (target / "notes.txt").read_text() == "mine"
    assert names(tmp_path) == ["result", "result-2"]


def test_a_missing_file_of_ours_is_no_obstacle(tmp_path):
    target = make(tmp_path / "result", a="1", b="2")
    (target / "tables" / "a").unlink()
    make(target, c="3")
    assert names(target / "tables") == ["c"]


def test_folders_with_manifests_of_their_own_are_judged_by_them(tmp_path):
    target = tmp_path / "both"
    with whole_folder(target) as folder:
        make(folder / "skin", a="1")
        write_text(folder / "report.html", "page")
    with extended_folder(target / "skin") as new:
        write_text(new / "tables" / "a", "2")
    assert foreign_files(target) == []
    note(target / "skin")
    assert foreign_files(target) == ["skin/notes.txt"]
    (target / "skin" / "notes.txt").unlink()
    make(target, b="3")
    assert names(target) == [MANIFEST, "tables"]
    assert names(tmp_path) == ["both"]


def test_files_are_added_and_replaced_but_not_those_that_were_changed(tmp_path):
    target = make(tmp_path / "result", a="1", b="2")
    note(target)
    with extended_folder(target) as new:
        write_text(new / "tables" / "a", "again")
        write_text(new / "more.txt", "more")
    assert foreign_files(target) == ["notes.txt"]
    edit(target)
    with pytest.raises(ForeignFilesError, match="tables/a"), extended_folder(target) as new:
        write_text(new / "tables" / "a", "lost?")
    with pytest.raises(ForeignFilesError, match=r"notes\.txt"), extended_folder(target) as new:
        write_text(new / "notes.txt", "lost?")
    assert (target / "tables" / "a").read_text() == "corrected"
    assert (target / "notes.txt").read_text() == "mine"


STEPS = ("rename", "replace", "unlink", "rmdir", "mkdir")


def killed_at(step, work):
    """Whether `work` in a process of its own was ended at its `step`-th change of the file system."""
    child = os.fork()
    if child == 0:
        left = [step]

        def counted(method):
            def call(self, *args, **kwargs):
                if left[0] == 0:
                    os._exit(9)
                left[0] -= 1
                return method(self, *args, **kwargs)

            return call

        for name in STEPS:
            setattr(Path, name, counted(getattr(Path, name)))
        try:
            work()
        finally:
            os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9


def at_every_kill(tmp_path, prepare, work):
    for step in range(200):
        place = tmp_path / str(step)
        place.mkdir(parents=True)
        prepare(place)
        if not killed_at(step, lambda place=place: work(place)):
            assert step > 5
            return
        yield place
    raise AssertionError("it never came to its end")


def test_no_kill_loses_the_old_result_or_stands_in_the_way_of_the_next(tmp_path):
    def first(place):
        make(place / "out", a="old", b="old")

    def second(place):
        make(place / "out", b="new", c="new")

    first(tmp_path)
    old = tree(tmp_path / "out")
    shutil.rmtree(tmp_path / "out")
    second(tmp_path)
    new = tree(tmp_path / "out")
    shutil.rmtree(tmp_path / "out")
    for place in at_every_kill(tmp_path, first, second):
        check_place(place / "out")
        assert tree(place / "out") in (old, new)
        assert not (place / ".out.previous").exists()
        second(place)
        assert tree(place / "out") == new


def test_no_kill_makes_a_folder_that_grows_foreign(tmp_path):
    def first(place):
        with extended_folder(place / "out", growing=("journal",)) as new:
            write_text(new / "a", "old")
        write_text(place / "out" / "journal", "1")

    def second(place):
        with extended_folder(place / "out") as new:
            write_text(new / "a", "new")
            write_text(new / "b", "new")

    for place in at_every_kill(tmp_path, first, second):
        assert foreign_files(place / "out") == []
        second(place)
        result_folder.clear_leftovers(place / "out")
        assert tree(place / "out").keys() == {"a", "b", "journal", MANIFEST}
        assert foreign_files(place / "out") == []


def begin(target):
    with whole_folder(target, "sweep", ("journal", "unfinished")) as new:
        write_text(new / "plan", "new")
    (target / "journal").write_text("1")
    (target / "unfinished" / "point_1").mkdir(parents=True)
    (target / "unfinished" / "point_1" / "fem_steps.kept").write_text("2")


def test_an_earlier_result_waits_until_one_that_grows_is_complete_whenever_it_is_killed(tmp_path):
    def first(place):
        make(place / "out", a="old", b="old")

    def second(place):
        begin(place / "out")
        result_folder.settle(place / "out")

    first(tmp_path)
    old = tree(tmp_path / "out")
    for place in at_every_kill(tmp_path / "kills", first, second):
        target, aside = place / "out", place / ".out.previous"
        recover(target)
        assert aside.exists() or "plan" not in tree(target) or read_manifest(target).doing == ""
        if "plan" in tree(target) and aside.exists():
            with pytest.raises(ForeignFilesError, match=r"an unfinished sweep \(.*plan.*\); the command that began it"):
                make(target, c="another")
            assert read_manifest(target).doing == "sweep"
            shutil.rmtree(target)
            recover(target)
        assert not aside.exists()
        assert tree(target) == old or set(tree(target)) >= {"plan", MANIFEST}


@pytest.mark.parametrize("page", [True, False])
def test_what_grew_is_replaced_once_it_is_complete_and_never_before(tmp_path, page):
    """Versions before `doing` left files that grow in the manifest of a complete result; its page tells it."""
    with extended_folder(tmp_path / "out", growing=("journal", "unfinished")) as new:
        write_text(new / ("report.html" if page else "plan"), "old")
    write_text(tmp_path / "out" / "journal", "1")
    before = tree(tmp_path)
    if page:
        make(tmp_path / "out", a="new")
        assert set(tree(tmp_path)) == {"out/tables/a", f"out/{MANIFEST}"}
    else:
        with pytest.raises(ForeignFilesError, match=r"an unfinished result \(journal, plan\)"):
            make(tmp_path / "out", a="new")
        assert tree(tmp_path) == before


def test_what_is_theirs_in_a_folder_that_grew_is_named_and_stays(tmp_path):
    begin(tmp_path / "out")
    note(tmp_path / "out" / "unfinished")
    result_folder.settle(tmp_path / "out")
    before = tree(tmp_path)
    with pytest.raises(ForeignFilesError, match=r"unfinished/notes\.txt"):
        make(tmp_path / "out", a="new")
    assert tree(tmp_path) == before
    begin(tmp_path / "grows")
    note(tmp_path / "grows" / "unfinished")
    assert foreign_files(tmp_path / "grows") == ["unfinished/notes.txt"]


def test_an_earlier_result_comes_back_into_an_empty_folder(tmp_path):
    make(tmp_path / "out", a="1").rename(tmp_path / ".out.previous")
    (tmp_path / "out").mkdir()
    recover(tmp_path / "out")
    assert set(tree(tmp_path)) == {"out/tables/a", f"out/{MANIFEST}"}


@pytest.mark.parametrize("there", [True, False])
@pytest.mark.parametrize("with_notes", [True, False])
def test_what_an_earlier_version_left_of_a_sweep_goes_with_the_next(tmp_path, with_notes, there):
    aside = tmp_path / ".out.previous"
    if there:
        make(tmp_path / "out", a="1")
    begin(aside)
    (aside / "plan").unlink()
    if with_notes:
        note(aside / "unfinished")
    if with_notes:
        with pytest.raises(ForeignFilesError, match="other files"):
            make(tmp_path / "out", a="2")
        assert (aside / "unfinished" / "notes.txt").read_text() == "mine"
    else:
        make(tmp_path / "out", a="2")
        assert names(tmp_path) == ["out"]


def test_an_earlier_result_is_not_removed_for_what_is_not_ours(tmp_path):
    make(tmp_path / "out", a="1").rename(tmp_path / ".out.previous")
    (tmp_path / "out").mkdir()
    note(tmp_path / "out")
    before = tree(tmp_path)
    with pytest.raises(ForeignFilesError, match=r"notes\.txt"):
        make(tmp_path / "out", a="2")
    assert tree(tmp_path) == before


def test_a_folder_of_theirs_where_a_result_steps_aside_is_left(tmp_path):
    aside = tmp_path / ".result.previous"
    aside.mkdir()
    note(aside)
    with pytest.raises(ForeignFilesError, match=r"\.result\.previous"):
        check_place(tmp_path / "result")
    assert tree(aside) == {"notes.txt": b"mine"}


def full_disk(folder):
    """Fill a folder until the disk is full, at its second file."""

    def fill(new):
        (new / "one").write_text("1")
        if new.parent == folder:
            raise OSError(errno.ENOSPC, "No space left on device")
        (new / "two").write_text("2")

    return fill


def test_a_result_that_cannot_be_written_is_kept_elsewhere_and_said(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "other"))
    with pytest.raises(KeptElsewhereError, match=r"No space left on device; the new result is kept in (.*)") as caught:
        write_whole(tmp_path / "result", full_disk(tmp_path))
    kept = tmp_path / "other" / "tissuebench-kept" / "result-2"
    assert str(caught.value).endswith(str(kept))
    assert sorted(path.name for path in kept.iterdir()) == ["manifest.json", "one", "two"]
    assert [path.name for path in tmp_path.iterdir()] == ["other"], "nothing half-written where it should have gone"


def test_without_any_room_the_first_error_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "file"))
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "file")
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(OSError, match="No space left") as caught:
        write_whole(tmp_path / "result", full_disk(tmp_path))
    assert not isinstance(caught.value, KeptElsewhereError)


def test_what_was_left_of_building_a_result_goes_with_the_next(tmp_path):
    dead = tmp_path / ".result.0123abcd.part"
    dead.mkdir()
    (dead / "manifest.json").write_text('{"schema": 1, "program": "tissuebench", "files": {}}')
    (dead / "half").write_text("1")
    with whole_folder(tmp_path / "result") as new:
        (new / "whole").write_text("2")
    assert [path.name for path in tmp_path.iterdir()] == ["result"]


def test_adding_to_a_result_removes_what_killed_ones_left_beside_it(tmp_path):
    dead = tmp_path / ".result.0123abcd.part"
    dead.mkdir()
    (dead / "manifest.json").write_text('{"schema": 1, "program": "tissuebench", "files": {}}')
    (dead / "half").write_text("1")
    with extended_folder(tmp_path / "result") as new:
        (new / "table.csv").write_text("a\n1\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result"]


@pytest.mark.parametrize("with_notes", [True, False])
def test_what_came_into_its_place_meanwhile_stays_and_the_result_lies_beside(tmp_path, with_notes):
    place = tmp_path / "result"
    if with_notes:
        place.mkdir()
        (place / "notes").write_text("mine")
    else:
        place.write_text("mine")
    with pytest.raises(KeptElsewhereError, match=r"the new result is kept in .*result-2"):
        write_whole(place, lambda new: (new / "table.csv").write_text("a\n1\n"))
    assert (place / "notes" if with_notes else place).read_text() == "mine"
    assert sorted(path.name for path in (tmp_path / "result-2").iterdir()) == ["manifest.json", "table.csv"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["result", "result-2"]
