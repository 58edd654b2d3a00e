"""The command line as a whole: its help, its start, its last resort."""

import json
import re
import signal
import subprocess
import sys

import pytest

from bench_hw.cli import _app
from bench_hw.cli._report import print_json

VERBS = ("inspect", "recover", "export", "import")


def bench(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "bench_hw", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_it_says_its_version():
    assert re.fullmatch(r"tissuebench \d+\.\d+\.\d+\n", bench("--version").stdout)


def test_help_lists_the_verbs_and_loads_nothing_heavy():
    ran = bench("--help")
    assert ran.returncode == 0
    for verb in VERBS:
        assert f"  {verb} " in ran.stdout
    heavy = "import sys, bench_hw.cli; print(sorted({'numpy', 'mcap', 'pandas', 'pint', 'cv2'} & set(sys.modules)))"
    loaded = subprocess.run([sys.executable, "-c", heavy], capture_output=True, text=True, check=True, timeout=60)
    assert loaded.stdout == "[]\n"


@pytest.mark.parametrize("verb", VERBS)
def test_each_verb_explains_itself(run, verb):
    ran = run(verb, "--help")
    assert ran.exit_code == 0
    assert "--json" in ran.stdout
    assert "without a result stdout is empty" in " ".join(ran.stdout.split())
    assert "--debug" in ran.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("inspect",), "Missing argument 'file'. See python -m bench_hw inspect --help."),
        (("inspect", "a", "--unknown"), "No such option: --unknown"),
        (("nonsense",), "No such command 'nonsense'. See python -m bench_hw --help."),
        (("Capture",), "No such command 'Capture'. Did you mean 'capture'? See python -m bench_hw --help."),
        (("recover", "a"), "Missing option '--out'. See python -m bench_hw recover --help."),
        (("simulate", "netft", "--http-port", "70000"), "See python -m bench_hw simulate netft --help."),
    ],
)
def test_a_wrong_use_is_exit_two_and_one_line(monkeypatch, capsys, arguments, said):
    monkeypatch.setattr(sys, "argv", ["bench_hw", *arguments])
    assert _app.main() == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith("error: ")
    assert said in printed.err
    assert printed.err.count("\n") == 1


@pytest.mark.parametrize("arguments", [(), ("simulate",)])
def test_without_arguments_it_shows_its_help_and_is_exit_two(arguments):
    ran = bench(*arguments)
    assert (ran.returncode, ran.stdout) == (2, "")
    assert ran.stderr.startswith("Usage: python -m bench_hw")


@pytest.mark.parametrize(("verb", "option"), [(("recover", "a"), "--out"), (("simulate", "netft"), "--seed")])
def test_an_option_of_one_value_is_given_once(run, verb, option):
    """The first was passed over."""
    ran = run(*verb, option, "1", option, "2")
    assert ran.exit_code == 2
    assert f"{option} is given 2 times; it takes one value" in ran.stderr


@pytest.mark.parametrize("debug", [False, True])
def test_an_error_nobody_foresaw_is_one_line_without_debug(monkeypatch, capsys, debug):
    def broken(**_: object) -> None:
        raise ZeroDivisionError("half a device")

    monkeypatch.setattr(_app, "app", broken)
    monkeypatch.setattr(sys, "argv", ["bench_hw", *(["--debug"] if debug else [])])
    assert _app.main() == 70
    error = capsys.readouterr().err
    assert "unexpected error: ZeroDivisionError: half a device" in error
    assert ("Traceback" in error) == debug


@pytest.mark.parametrize(
    "arguments",
    [
        ("import", "ring", "--out", "x"),
        ("track", "ring", "--camera", "c", "--out", "x"),
        ("simulate", "session", "--out", "ring"),
    ],
)
def test_a_ring_of_links_is_exit_two_and_named_on_stderr_alone(tmp_path, monkeypatch, capsys, arguments):
    """It was an unexpected error."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ring").symlink_to("ring")
    monkeypatch.setattr(sys, "argv", ["bench_hw", *arguments, "--json"])
    assert _app.main() == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err == f"error: {tmp_path / 'ring'}: Too many levels of symbolic links\n"


def test_what_is_no_number_is_null_in_json(capsys):
    print_json({"a": [float("nan"), 1.5, (float("inf"), None, True)], "b": {"c": "µ"}})
    printed = capsys.readouterr().out
    assert json.loads(printed) == {"a": [None, 1.5, [None, None, True]], "b": {"c": "µ"}}
    assert "µ" in printed


def test_ctrl_c_in_a_verb_is_said(monkeypatch, capsys):
    """The command-line library ends it with 130 and no word."""

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr("importlib.metadata.version", interrupted)
    monkeypatch.setattr(sys, "argv", ["bench_hw", "--version"])
    try:
        assert _app.main() == 130
    finally:
        signal.signal(signal.SIGINT, before)
    assert capsys.readouterr().err == "error: interrupted\n"
