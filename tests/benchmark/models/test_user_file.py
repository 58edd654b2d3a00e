"""Reading a user's file without running it, and running it so that every fault names file and line."""

import io
import sys

import pytest

from benchmark.errors import InputError
from benchmark.models import UncoveredError, read_user_file
from benchmark.models.user_file import UserCode


def test_the_name_is_the_users_or_the_files(user_file) -> None:
    assert user_file("NAME = 'spring bed'\n").name == "spring bed"
    assert user_file("NAME: str = 'spring bed'\n").name == "spring bed"
    assert user_file("x = 1\n").name == "my_model"
    assert user_file("x = 1\n", "FEM.py").name == "FEM.py", "tables call the other model fem"


def test_reading_runs_nothing(user_file) -> None:
    assert user_file("raise SystemExit(1)\n").text.startswith("raise")


def test_the_fingerprint_follows_the_text(user_file) -> None:
    assert user_file("x = 1\n").fingerprint != user_file("x = 2\n").fingerprint


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def deform(:\n", ["line 1", "no valid Python"]),
        ("x = 1\n\ny = (\n", ["line 3", "no valid Python"]),
        ("x = 1\n<<<<<<< HEAD\ny = 2\n", ["line 2", "conflict marker of git"]),
        ("NAME = 5\n", ["line 1", "NAME = 5", "60"]),
        ("x = 1\nNAME = ''\n", ["line 2", "NAME"]),
        ("NAME = 'a\\nb'\n", ["printable"]),
        ("NAME = 'fem'\n", ["line 1", "the FEM's place"]),
        ("x = '\0'\n", ["my_model.py"]),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_line(user_file, text: str, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        user_file(text)
    for word in ["my_model.py", *words]:
        assert word in str(caught.value)


def test_a_file_that_is_not_there_or_no_text(tmp_path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.py"):
        read_user_file(tmp_path / "nowhere.py")
    (tmp_path / "binary.py").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        read_user_file(tmp_path / "binary.py")


def test_an_exception_names_the_last_line_in_the_file(user_file) -> None:
    code = UserCode(
        user_file("import math\n\ndef inner(x):\n    return math.sqrt(x)\n\ndef deform(x):\n    return inner(x)\n")
    )
    assert code.call("deform", 4.0) == 2.0
    with pytest.raises(InputError, match=r"my_model\.py, line 4: ValueError: math domain error"):
        code.call("deform", -1.0)
    with pytest.raises(InputError, match=r"line 6: TypeError"):
        code.call("deform")


@pytest.mark.parametrize("text", ["x = 1\nraise ValueError('top')\n", "import sys\nsys.exit('top')\n"])
def test_a_fault_at_the_top_level_is_an_input_error(user_file, text: str) -> None:
    with pytest.raises(InputError, match=r"my_model\.py, line 2: .*top"):
        UserCode(user_file(text))


def test_not_implemented_means_not_covered(user_file) -> None:
    code = UserCode(user_file("def deform():\n    raise NotImplementedError('no holes')\n"))
    with pytest.raises(UncoveredError, match="no holes"):
        code.call("deform")


def test_it_may_import_its_neighbours_and_print(user_file, tmp_path, capfd) -> None:
    (tmp_path / "neighbour_of_mine.py").write_text("VALUE = 7\n")
    before = list(sys.path)
    code = UserCode(
        user_file("import neighbour_of_mine\nprint('loud')\ndef deform():\n    return neighbour_of_mine.VALUE\n")
    )
    assert code.call("deform") == 7
    out, err = capfd.readouterr()
    assert out == ""
    assert "loud" in err
    assert sys.path == before


def test_what_the_text_was_when_read_is_what_runs(user_file, tmp_path) -> None:
    file = user_file("def deform():\n    return 1\n")
    (tmp_path / "my_model.py").write_text("def deform():\n    return 2\n")
    assert UserCode(file).call("deform") == 1


def test_decorators_and_dataclasses_work(user_file) -> None:
    text = (
        "from __future__ import annotations\nfrom dataclasses import dataclass\nfrom functools import lru_cache\n\n"
        "@dataclass\nclass Bed:\n    stiffness: float\n\n@lru_cache\ndef deform(x):\n    return Bed(x).stiffness / 0\n"
    )
    with pytest.raises(InputError, match="line 11: ZeroDivisionError"):
        UserCode(user_file(text)).call("deform", 1.0)


def test_a_model_that_reads_its_input_finds_none(user_file, monkeypatch) -> None:
    """In a check it read the commands of its process, and the check waited for ever."""
    text = (
        "import subprocess, sys\ndef deform():\n    return input('go? ')\ndef rest():\n    return sys.stdin.read()\n"
        "def started():\n    found = subprocess.check_output('cat', stdin=sys.stdin)\n    sys.stdin.close()\n"
        "    return found\n"
    )
    code = UserCode(user_file(text))
    monkeypatch.setattr("sys.stdin", io.StringIO("commands\n"))
    with pytest.raises(InputError, match=r"my_model\.py, line 3: EOFError: .*no input to read"):
        code.call("deform")
    assert code.call("rest") == ""
    assert code.call("started") == b""
    assert code.call("rest") == ""
    assert sys.stdin.read() == "commands\n"


@pytest.mark.parametrize("raised", ["KeyboardInterrupt", "asyncio.CancelledError('later')", "GeneratorExit"])
def test_whatever_a_model_raises_is_told_with_its_line(user_file, raised: str) -> None:
    """A keyboard interrupt of its own ended as exit code 0 of its process."""
    code = UserCode(user_file(f"import asyncio\ndef deform():\n    raise {raised}\n"))
    with pytest.raises(InputError, match=r"my_model\.py, line 3: ") as caught:
        code.call("deform")
    assert "KeyboardInterrupt" not in str(caught.value), "the command line would take it for Ctrl-C"


def test_ctrl_c_while_a_model_runs_is_ctrl_c(user_file) -> None:
    code = UserCode(user_file("import signal\ndef deform():\n    signal.raise_signal(signal.SIGINT)\n"))
    with pytest.raises(KeyboardInterrupt):
        code.call("deform")
