"""Input that cannot be used: exit code 2, one paragraph that names file, key, value and what is allowed, no output."""

from pathlib import Path

import pytest

SCENARIO = """schema = 1
name = "mine"
[tissue]
schema = 1
name = "one layer"
[[tissue.layers]]
name = "dermis"
thickness = "5 mm"
density = "1100 kg/m^3"
youngs_modulus = "50 kPa"
poisson_ratio = 0.48
[tool]
radius = "5 mm"
[load]
peak = "1 N"
"""

BAD_SCENARIOS = {
    "unknown key": (SCENARIO + "spead = 3\n", ["spead"]),
    "unknown section": (SCENARIO + "[tol]\nradius = '1 mm'\n", ["tol"]),
    "wrong dimension": (SCENARIO.replace('"5 mm"\ndensity', '"5 kPa"\ndensity'), ["thickness", "5 kPa", "mm"]),
    "bare number": (SCENARIO.replace('"50 kPa"', "50"), ["youngs_modulus", "50", "kPa"]),
    "negative thickness": (SCENARIO.replace('"5 mm"\ndensity', '"-5 mm"\ndensity'), ["thickness", "-5 mm"]),
    "incompressible": (SCENARIO.replace("0.48", "0.5"), ["poisson_ratio", "0.5"]),
    "no press": (SCENARIO.replace('"1 N"', '"0 N"'), ["load.peak", "0 N"]),
    "another schema": (SCENARIO.replace('schema = 1\nname = "mine"', 'schema = 7\nname = "mine"'), ["schema", "7"]),
    "broken TOML": (SCENARIO + "[[[\n", ["line"]),
    "nan": (SCENARIO.replace('"1 N"', '"nan N"'), ["load.peak", "nan"]),
}

HEADER = "time_s,depth_mm,force_N\n"
ROWS = [f"{0.1 * k:.1f},{0.01 * k:.2f},{0.02 * k:.2f}" for k in range(40)]


def table(*changes: tuple[int, str], header: str = HEADER, rows: int = 40) -> str:
    lines = list(ROWS[:rows])
    for row, line in changes:
        lines[row] = line
    return header + "".join(f"{line}\n" for line in lines)


BAD_TRIALS = {
    "missing column": (table(header="time_s,depth_mm,height_mm\n"), ["force"]),
    "text in a number": (table((7, "0.7,deep,0.1")), ["depth_mm", "deep", "9"]),
    "NaN": (table((7, "0.7,0.1,nan")), ["force_N", "nan", "9"]),
    "time runs backwards": (table((7, "0.1,0.1,0.1")), ["time_s", "9"]),
    "empty": ("", ["empty"]),
    "three rows": (table(rows=3), ["3", "20"]),
}


def refused(called, *words: str) -> None:
    assert called.code == 2, called.err
    assert called.out == ""
    paragraph = called.err.strip()
    assert paragraph.startswith("error: ")
    assert "\n\n" not in paragraph
    assert "Traceback" not in paragraph
    for word in words:
        assert word in " ".join(paragraph.split()), paragraph


@pytest.mark.parametrize("case", BAD_SCENARIOS)
def test_scenario(benchmark_cli, tmp_path: Path, case: str) -> None:
    text, words = BAD_SCENARIOS[case]
    path = tmp_path / "mine.toml"
    path.write_text(text)
    refused(benchmark_cli("run", path, "--out", tmp_path / "out", "--quiet"), "mine.toml", *words)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("case", BAD_TRIALS)
@pytest.mark.parametrize("verb", ["run", "fit"])
def test_trials(benchmark_cli, tmp_path: Path, verb: str, case: str) -> None:
    text, words = BAD_TRIALS[case]
    folder = tmp_path / "session"
    folder.mkdir()
    (folder / "good.csv").write_text(table())
    (folder / "worse.csv").write_text(text)
    session = ("--trials", folder) if verb == "run" else (folder,)
    refused(benchmark_cli(verb, *session, "--out", tmp_path / "out", "--quiet"), "worse.csv", *words)
    assert list(tmp_path.iterdir()) == [folder]


def test_files_that_are_not_there(benchmark_cli, tmp_path: Path) -> None:
    refused(benchmark_cli("run", tmp_path / "nowhere.toml"), "nowhere.toml")
    refused(benchmark_cli("run", "--trials", tmp_path / "nowhere"), "nowhere")
    refused(benchmark_cli("fit", tmp_path / "nowhere"), "nowhere")
    refused(benchmark_cli("run", "skin5N"), "skin5N", "skin-5N")


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("load.peek=2 N", ["load.peek", "peak"]),
        ("dermis.youngs_modulus=2 mm", ["dermis.youngs_modulus", "2 mm", "kPa"]),
        ("dermiss.youngs_modulus=2 kPa", ["dermiss"]),
        ("load.peak", ["KEY=VALUE"]),
    ],
)
def test_settings(benchmark_cli, tmp_path: Path, setting: str, words: list[str]) -> None:
    refused(benchmark_cli("run", "skin-5N", "--set", setting, "--out", tmp_path / "out", "--quiet"), *words)
    assert list(tmp_path.iterdir()) == []


def test_usage(benchmark_cli) -> None:
    assert benchmark_cli("rum").code == 2
    assert benchmark_cli("run", "skin-5N", "--repeats", "1").code == 2
    assert "--specimen" in benchmark_cli("run", "skin-5N", "--specimen", "skin_forearm").err


def test_a_folder_with_other_things_is_not_replaced(benchmark_cli, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    refused(benchmark_cli("run", "skin-5N", "--out", tmp_path), "--out")
    assert (tmp_path / "thesis.tex").read_text() == "years of work"
