import subprocess
import sys
from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.runs.output.destination import destination
from reports import whole_folder


def test_default_is_a_fresh_dated_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    first = destination(None, "skin 5/N <b>")
    assert first.parent == Path("results")
    assert first.name.startswith("skin-5-N-b-2")
    first.mkdir(parents=True)
    assert destination(None, "skin 5/N <b>") != first


def test_an_earlier_result_may_be_replaced_and_one_without_a_manifest_not(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with whole_folder(out) as new:
        (new / "report.html").touch()
    assert destination(out, "x") == out
    (out / "manifest.json").unlink()
    with pytest.raises(InputError, match=r"report\.html and no manifest\.json: it is not a result .*earlier version"):
        destination(out, "x")


@pytest.mark.parametrize("out", ["session", "session/fit", "session/../session", ".", "way/out"])
def test_an_output_in_or_around_an_input_is_refused(tmp_path: Path, out: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "session").mkdir()
    (tmp_path / "session" / "a.csv").touch()
    (tmp_path / "way").symlink_to("session")
    with pytest.raises(InputError, match="which is read"):
        destination(Path(out), "x", (Path("session"),))
    with pytest.raises(InputError, match="which is read"):
        destination(Path("session"), "x", ("session/a.csv", None, "skin-5N"))
    assert destination(Path("beside"), "x", (Path("session"), "session/a.csv")) == Path("beside")


def test_a_name_that_ships_is_no_input_in_the_way(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "skin-5N").mkdir()
    assert destination(Path("skin-5N"), "x", ("skin-5N",)) == Path("skin-5N")


@pytest.mark.parametrize("out", ["thesis.tex", "thesis.tex/deeper", "n" * 250])
def test_a_place_that_cannot_be_written_is_refused_before(tmp_path: Path, out: str) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(InputError, match=r"is a file|cannot be written"):
        destination(tmp_path / out, "x")
    assert [each.name for each in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_full_disk_is_found_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(InputError, match="cannot be written: No space left"):
        destination(tmp_path / "new", "x")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="results cannot be written: No space left"):
        destination(None, "x")


def test_new_and_empty_folders_are_taken(tmp_path: Path) -> None:
    assert destination(tmp_path, "x") == tmp_path
    assert destination(tmp_path / "new", "x") == tmp_path / "new"


def test_anything_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(InputError, match="not a result of this program"):
        destination(tmp_path, "x")
    with pytest.raises(InputError, match="is a file"):
        destination(tmp_path / "thesis.tex", "x")


def test_two_that_begin_in_the_same_second_get_names_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    module = "benchmark.runs.output.destination"
    code = f"from {module} import destination; print(destination(None, 'x'), flush=True); input()"
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    both = [subprocess.Popen([sys.executable, "-c", code], **pipes) for _ in range(2)]
    names = [each.stdout.readline().strip() for each in both]
    assert names[0] != names[1]
    both[0].kill()
    both[0].communicate()
    assert both[1].communicate("\n")[0] == ""
    assert [each.name for each in (tmp_path / "results").iterdir()] in ([], [f".{Path(names[0]).name}.lock"])
    again = destination(None, "x")  # it removes what the killed one left, whose name it has within the same second
    assert again.parent == Path("results")
    assert [each.name for each in (tmp_path / "results").iterdir()] == [f".{again.name}.lock"]


def test_a_name_is_not_needed_to_look_at_the_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert destination(None, "") == Path("results")
    assert not (tmp_path / "results").exists()
