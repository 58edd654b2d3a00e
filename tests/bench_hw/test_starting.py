"""Standard streams that are closed, broken or full, in processes of their own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

UNSAID = "error: standard output cannot be written: {}; results that are in their place stay there\n"
SAY = """
import sys
from bench_hw.starting import end, open_streams, unsaid
open_streams()
file = open("result.csv", "w")
print("to standard error", file=sys.stderr)
code = 0
try:
    print("to standard output")
    sys.stdout.flush()
except OSError:
    print(f"error: {unsaid()}", file=sys.stderr)
    code = 2
file.write("whole")
file.close()
sys.exit(end(code))
"""


def said(folder, shell, program=SAY):
    """Exit code, standard error, and what was written, of a program whose streams a shell has changed."""
    command = f'"$0" -c "$1" {shell}'
    environment = {**os.environ, "PYTHONPATH": str(Path.cwd())}
    environment.pop("PYTHONUNBUFFERED", None)
    ran = subprocess.run(
        ["sh", "-c", command, sys.executable, program], cwd=folder, env=environment, capture_output=True, text=True
    )
    return ran.returncode, ran.stderr, (folder / "result.csv").read_text()


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-"])
def test_what_is_closed_is_no_error_and_no_file_takes_its_place(tmp_path, closed):
    err = "" if "2>&-" in closed else "to standard error\n"
    assert said(tmp_path, closed) == (0, err, "whole")


def test_a_full_standard_error_is_no_error(tmp_path):
    assert said(tmp_path, "2> /dev/full") == (0, "", "whole")


def test_a_full_standard_output_is_told_once(tmp_path):
    err = "to standard error\n" + UNSAID.format("No space left on device")
    assert said(tmp_path, "> /dev/full") == (2, err, "whole")


def test_a_standard_output_that_is_full_at_the_very_end_is_told(tmp_path):
    program = SAY.replace("    sys.stdout.flush()\n", "")
    err = "to standard error\n" + UNSAID.format("No space left on device")
    assert said(tmp_path, "> /dev/full", program) == (2, err, "whole")


@pytest.mark.parametrize("words", [("benchmark", "--help"), ("bench_hw", "--help")])
def test_a_reader_that_went_away_is_told_and_no_fault_of_the_program(words):
    reader, writer = os.pipe()
    os.close(reader)
    ran = subprocess.run([sys.executable, "-m", *words], stdout=writer, stderr=subprocess.PIPE, text=True)
    os.close(writer)
    assert (ran.returncode, ran.stderr) == (2, UNSAID.format("Broken pipe"))


INTERRUPTED = """
import os, signal, sys
class Interrupted:
    def find_spec(self, name, *rest):
        if name == {name!r}:
            sys.meta_path.remove(self)
            os.kill(os.getpid(), signal.SIGINT)
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Interrupted())
from {package}.__main__ import start
sys.exit(start())
"""
AT_THE_END = """
import atexit, os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
atexit.register(os.kill, os.getpid(), signal.SIGINT)
sys.argv = ["program", "--version"]
from {package}.__main__ import start
sys.exit(start())
"""


def ended(program):
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    return ran.returncode, ran.stderr


@pytest.mark.parametrize("name", ["{}.cli", "bench_hw.starting", "typer"])
@pytest.mark.parametrize("package", ["benchmark", "bench_hw"])
def test_ctrl_c_while_modules_are_imported_is_one_line(package, name):
    if (package, name) == ("bench_hw", "bench_hw.starting"):
        pytest.skip("imported before its first line")
    code, err = ended(INTERRUPTED.format(package=package, name=name.format(package)))
    assert (code, err) == (130, "error: interrupted\n")


@pytest.mark.parametrize("package", ["benchmark", "bench_hw"])
def test_ctrl_c_while_python_ends_brings_no_traceback(package):
    code, err = ended(AT_THE_END.format(package=package))
    assert (code, err) == (-2, "")


@pytest.mark.parametrize("package", ["benchmark", "bench_hw"])
def test_a_library_that_is_not_installed_is_one_line_that_says_what_to_do(package):
    code, err = ended(WITHOUT_A_LIBRARY.format(package=package, missing="typer"))
    assert (code, err.count("\n")) == (2, 1)
    assert err.startswith(f"error: typer is not installed for {sys.executable}: ")
    assert "make run" in err


def test_a_module_of_ours_that_is_missing_is_no_library():
    code, err = ended(WITHOUT_A_LIBRARY.format(package="benchmark", missing="benchmark.cli.app"))
    assert code == 1
    assert "ModuleNotFoundError" in err


WITHOUT_A_LIBRARY = """
import sys
sys.modules["{missing}"] = None
sys.argv = ["program", "--version"]
from {package}.__main__ import start
sys.exit(start())
"""


SWALLOWED = """
import os, signal, sys
class Deaf:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
class Finder:
    def find_spec(self, name, *rest):
        if name == "typer":
            sys.meta_path.remove(self)
            Deaf()
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Finder())
sys.argv = ["program", "--version"]
from {package}.__main__ import start
sys.exit(start())
"""


@pytest.mark.parametrize("package", ["benchmark", "bench_hw"])
def test_ctrl_c_that_other_code_passes_over_ends_the_program(package):
    code, err = ended(SWALLOWED.format(package=package))
    assert code == 130
    assert err.startswith("error: interrupted")
    assert err.count("\n") == 1


def test_a_home_that_cannot_be_written_brings_no_words_of_a_library(tmp_path):
    """matplotlib told of its temporary cache on standard error, under --quiet, too."""
    home, temporary = tmp_path / "home", tmp_path / "temporary"
    home.touch()
    temporary.mkdir()
    unset = ("XDG_CACHE_HOME", "XDG_CONFIG_HOME", "MPLCONFIGDIR")
    environment = {key: value for key, value in os.environ.items() if key not in unset}
    words = ("-m", "bench_hw", "capture", "paper_press", "--dry-run", "--plot", str(tmp_path / "plot.svg"))
    ran = subprocess.run(
        [sys.executable, *words],
        capture_output=True,
        text=True,
        env=environment | {"HOME": str(home), "TMPDIR": str(temporary)},
    )
    assert (ran.returncode, ran.stderr) == (0, "")
    assert (tmp_path / "plot.svg").is_file()
    assert not list(temporary.iterdir())
