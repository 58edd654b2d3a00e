"""Files and folders of the user's that have the name of a module are passed over, and said."""

import os
import subprocess
import sys

import pytest

ENVIRONMENT = {name: value for name, value in os.environ.items() if name not in ("PYTHONSAFEPATH", "PYTHONPATH")}
THEIRS = 'raise SystemExit("theirs was imported")\n'
PACKAGES = ("fem", "reports", "wavemodel", "bench_hw")


def call(folder, *arguments):
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, check=False)


def put(folder, *names):
    for name in names:
        path = folder / name / "__init__.py" if "." not in name else folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(THEIRS)


ONE = "has the name of a module and is"
SEVERAL = "have names of modules and are"


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (("fem",), f"fem/ in this folder {ONE}"),
        (("typing.py",), f"typing.py in this folder {ONE}"),
        (PACKAGES, f"bench_hw/, fem/, reports/, wavemodel/ in this folder {SEVERAL}"),
        (
            ("fem.py", "numpy.py", "pydantic.py", "typer.py"),
            f"fem.py, numpy.py, pydantic.py, typer.py in this folder {SEVERAL}",
        ),
    ],
)
def test_the_command_line_answers_as_ever_and_says_it(tmp_path, names, said):
    put(tmp_path, *names)
    done = call(tmp_path, "-m", "benchmark", "tissues", "skin_forearm")
    assert done.returncode == 0, done.stderr
    assert "skin_forearm" in done.stdout
    assert done.stderr == f"note: {said} not imported\n"


@pytest.mark.parametrize("names", [("benchmark.py", "fem.py", "numpy.py", "typer.py"), ("benchmark",)])
def test_the_bench_and_the_commands_too(tmp_path, names):
    put(tmp_path, *names)
    done = call(tmp_path, "-m", "bench_hw", "devices", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    for module in ("benchmark", "bench_hw"):
        begin = f"import sys; from {module}.__main__ import start; sys.argv = ['x', '--help']; sys.exit(start())"
        done = call(tmp_path, "-P", "-c", begin)
        assert done.returncode == 0, done.stderr
        assert "Usage" in done.stdout


def test_plain_folders_and_own_modules_are_nothing_to_speak_of(tmp_path):
    (tmp_path / "reports").mkdir()
    (tmp_path / "my_effects.py").write_text("")
    done = call(tmp_path, "-m", "benchmark", "tissues", "skin_forearm")
    assert (done.returncode, done.stderr) == (0, "")


DISCOVERER = """
import os
from benchmark.discovery import Discovery
def always(session, *, seed):
    raise ValueError("mine was called, in " + ("a child" if os.environ.get("OMP_NUM_THREADS") == "1" else "here"))
"""


@pytest.mark.slow
def test_processes_start_without_the_folder_and_own_modules_still_load(tmp_path):
    put(tmp_path, *PACKAGES, "numpy.py", "socket.py", "pickle.py")
    (tmp_path / "mine.py").write_text(DISCOVERER)
    command = ["-m", "benchmark", "blind", "--cases", "adhesion,dry_friction", "--discoverer", "mine:always"]
    done = call(tmp_path, *command, "--workers", "2", "--out", "blind")
    assert done.returncode == 0, done.stderr
    assert "mine was called" in (tmp_path / "blind" / "cases.csv").read_text()
    small = ["--set", "load.observations=4", "--set", "fem.mesh=coarse", "--set", "fem.kinematics=linear"]
    done = call(tmp_path, "-m", "benchmark", "run", "skin-5N", *small, "--out", "press", "--quiet")
    assert done.returncode == 0, done.stderr
    done = call(
        tmp_path, "-m", "benchmark", "sweep", "skin-5N", *small, "--vary", "tool.radius=4 mm,5 mm", "--out", "sweep"
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(os.name != "posix", reason="locales of POSIX")
def test_names_are_text_under_an_ascii_locale_too(tmp_path):
    environment = {**ENVIRONMENT, "PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"}
    command = [sys.executable, "-m", "benchmark", "tissues", "new", "Haut_Müller"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    assert [path.name for path in tmp_path.iterdir()] == ["Haut_Müller.toml"]
    assert "Haut_Müller.toml" in done.stdout.decode()
