"""A folder in which a result is built is told from what a dead process left, and from what is theirs."""

from reports.folders.building import building, dead_builds, remove_dead_builds
from reports.manifest import MANIFEST, PROGRAM, SCHEMA


def make_dead(parent, name, mark=True):
    folder = parent / f".{name}.0123abcd.part"
    folder.mkdir(parents=True)
    if mark:
        (folder / MANIFEST).write_text(f'{{"schema": {SCHEMA}, "program": "{PROGRAM}", "files": {{}}}}')
        (folder / "half.csv").write_text("a,b\n1,")
    return folder


def test_what_is_being_built_is_not_dead_and_leaves_nothing(tmp_path):
    with building(tmp_path / "deep" / "result") as folder:
        assert folder.is_dir()
        assert dead_builds(folder.parent) == []
    assert list(tmp_path.iterdir()) == []


def test_what_a_dead_process_left_goes_and_only_of_this_result(tmp_path):
    dead, other = make_dead(tmp_path, "result"), make_dead(tmp_path, "another")
    assert dead_builds(tmp_path) == [other, dead]
    remove_dead_builds(tmp_path / "result")
    assert dead_builds(tmp_path) == [other]
    assert not dead.exists()


def test_a_folder_of_theirs_with_such_a_name_stays(tmp_path):
    theirs = make_dead(tmp_path, "result", mark=False)
    (theirs / "notes.txt").write_text("mine")
    (tmp_path / ".result.fedcba98.part").symlink_to(theirs)
    remove_dead_builds(tmp_path / "result")
    assert (theirs / "notes.txt").read_text() == "mine"
