"""The command as a whole: quick help, one paragraph for an error, tracebacks only where asked for."""

import os
import subprocess
import sys
import warnings
from importlib.metadata import version
from pathlib import Path

import pytest
from typer.main import get_command

from bench_hw.errors import DeviceError, InputError
from benchmark.child_processes import forbid_ending
from benchmark.cli import app
from benchmark.errors import InterruptedRunError

HEAVY = ("numpy", "scipy", "pandas", "pint", "pydantic", "skfem", "matplotlib", "pyvista", "statsmodels")


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys; from benchmark.cli.app import main; main(['--help']); "
        f"print([name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    for verb in ("run", "fit", "tissues", "scenarios", "verify"):
        assert verb in done.stdout


def test_the_module_runs_as_a_program(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "benchmark", "run", "nowhere.toml"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env={**os.environ, "NO_COLOR": "1"})
    assert done.returncode == 2
    assert done.stdout == ""
    assert "nowhere.toml" in done.stderr
    assert "Traceback" not in done.stderr


def test_debug_shows_where(benchmark_cli) -> None:
    assert "Traceback" in benchmark_cli("run", "nowhere.toml", "--debug").err


def test_a_fault_of_the_program_is_no_user_error(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(app, "app", lambda **_: 1 / 0)
    called = benchmark_cli("tissues")
    assert called.code == app.EXIT_BUG
    assert "ZeroDivisionError" in called.err


@pytest.mark.parametrize(("error", "code"), [(InputError("a grid of 1 x 1"), 2), (DeviceError("no box"), 5)])
def test_what_the_bench_refuses_is_no_fault_of_the_program(
    benchmark_cli, monkeypatch: pytest.MonkeyPatch, error: Exception, code: int
) -> None:
    def refused(**_: object) -> None:
        raise error

    monkeypatch.setattr(app, "app", refused)
    called = benchmark_cli("tissues")
    assert (called.code, called.err) == (code, f"error: {error}\n")


@pytest.mark.parametrize("word", ["os._exit(0)", "sys.exit(0)"])
def test_a_file_of_the_users_cannot_end_the_program_as_if_all_were_well(
    benchmark_cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, word: str
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(f"import os, sys\n\n\ndef observe():\n    {word}\n")
    monkeypatch.setattr("os._exit", os._exit)  # put back afterwards
    forbid_ending(str(file))
    theirs: dict[str, object] = {}
    exec(compile(file.read_text(), str(file), "exec"), theirs)
    monkeypatch.setattr(app, "app", lambda **_: theirs["observe"]())
    called = benchmark_cli("discover")
    assert called.code == 2
    assert "mine.py, line 5: the program was told to end there (exit code 0)" in " ".join(called.err.split())


def test_too_little_memory_is_no_fault_of_the_program(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def exhausted(**_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(app, "app", exhausted)
    called = benchmark_cli("tissues")
    assert called.code == 2
    assert "too little memory" in called.err


def test_an_interruption_has_its_own_code(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(**_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(app, "app", interrupted)
    assert benchmark_cli("tissues").code == app.EXIT_INTERRUPTED


def test_an_interruption_under_another_name_is_one_too(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def as_a_library_does(*_: object, **__: object) -> int:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt as met:
            raise ValueError("a callback failed") from met

    monkeypatch.setattr(app, "app", as_a_library_does)
    assert benchmark_cli("tissues").code == 130


def test_an_interruption_that_says_what_it_left_is_heard(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def as_a_long_run_does(*_: object, **__: object) -> int:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:
            raise InterruptedRunError("interrupted; what was computed is in .press.unfinished") from None

    monkeypatch.setattr(app, "app", as_a_long_run_does)
    called = benchmark_cli("tissues")
    assert called.code == 130
    assert ".press.unfinished" in called.err


def test_without_a_verb_the_help_is_shown_as_it_is(benchmark_cli) -> None:
    called = benchmark_cli()
    assert called.code == 2
    assert called.out == benchmark_cli("--help").out
    assert called.err == ""


def test_the_version_is_told(benchmark_cli) -> None:
    called = benchmark_cli("--version")
    assert (called.code, called.out) == (0, f"tissuebench {version('tissuebench')}\n")


def test_what_numpy_says_on_the_way_is_not_shown(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def overflowing(**_: object) -> int:
        warnings.warn("overflow encountered in exp", RuntimeWarning, stacklevel=1)
        return 0

    monkeypatch.setattr(app, "app", overflowing)
    assert benchmark_cli("tissues").err == ""


@pytest.mark.parametrize("verb", sorted(get_command(app.app).commands))
def test_every_verb_has_the_options_that_scripts_pass_everywhere(verb: str) -> None:
    options = {name for parameter in get_command(app.app).commands[verb].params for name in parameter.opts}
    assert {"--json", "--quiet", "--debug"} <= options


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("run", "nowhere.toml"), 2),
        (("run", "skin-5N", "--fields", "some"), 2),
        (("fit", "nowhere"), 2),
        (("report", "nowhere"), 2),
        (("check", "--baseline", "nowhere.json"), 3),
        (("tissues", "nowhere"), 2),
    ],
)
def test_without_a_result_json_leaves_stdout_empty_as_its_help_says(
    benchmark_cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words, code
) -> None:
    monkeypatch.chdir(tmp_path)
    called = benchmark_cli(*words, "--json")
    assert (called.code, called.out) == (code, "")
    assert called.err.startswith("error: ")
    assert "without a result stdout is empty" in " ".join(benchmark_cli(words[0], "--help").out.split())


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        (("sweep", "skin-5N"), "error: Missing option '--vary'. See python -m benchmark sweep --help."),
        (("sweep", "skin-5N", "--vary", "tool.radius=4 mm", "--sample", "foo"),
         "error: Invalid value for '--sample': 'foo' is not one of 'lhs', 'sobol'. See python -m benchmark sweep"),
        (("reference",), "error: Missing argument 'new'. See python -m benchmark reference --help."),
        (("tissues", "new"), "tissues new NAME. See python -m benchmark tissues --help."),
        (("run", "skin-5N", "--reference", "a.csv", "--reference=b.csv"),
         "error: --reference is given 2 times; it takes one value. See python -m benchmark run --help."),
        (("fit", "phantom", "--seed", "1", "--seed", "1"), "error: --seed is given 2 times"),
        (("nosuch",), "error: No such command 'nosuch'. See python -m benchmark --help."),
        (("Run",), "error: No such command 'Run'. Did you mean 'run'? See python -m benchmark --help."),
        (("session",), "error: Missing argument 'what'. Choose from: new. See python -m benchmark session --help."),
    ],
)  # fmt: skip
def test_what_is_typed_wrong_is_said_with_the_help_of_its_verb(benchmark_cli, typed, said) -> None:
    called = benchmark_cli(*typed)
    assert called.code == app.EXIT_USAGE
    assert said in " ".join(called.err.split())


def test_what_may_be_repeated_is(benchmark_cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """A setting for each value, and a flag, which says the same again."""
    given = {}
    monkeypatch.setattr("benchmark.runs.fit_to_folder", lambda request, *_: given.update(request.settings) or 1 / 0)
    benchmark_cli("fit", "phantom", "--set", "fem.mesh=fine", "--set", "tool.radius=4 mm", "--quiet", "--quiet")
    assert given == {"fem.mesh": "fine", "tool.radius": "4 mm"}
