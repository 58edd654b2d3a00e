"""`verify`: table, JSON, files, exit codes."""

import json

import pytest

from benchmark.verification import cases as selection
from fem.verification import Case, Quantity

KEYS = {
    "case", "source", "reference", "ours", "unit", "error_percent", "allowed_percent", "unknowns", "seconds", "passed"
}  # fmt: skip


@pytest.fixture
def one_off(monkeypatch: pytest.MonkeyPatch) -> None:
    def compute() -> tuple[Quantity, ...]:
        return (Quantity("", 1.0, 1.01, "mm", 0.5, 3),)

    monkeypatch.setattr(selection, "all_cases", lambda: (Case("off", "made up for a test", compute),))


def test_prints_a_table(benchmark_cli) -> None:
    called = benchmark_cli("verify", "hayes/ratio_1", "patch_axisymmetric")
    assert called.code == 0
    lines = called.out.splitlines()
    assert " ".join(lines[0].split()) == "case reference ours unit error % allowed % unknowns seconds source"
    assert [line.split()[0] for line in lines if line.startswith("hayes")] == ["hayes/ratio_1"]
    assert "3.09140" in called.out
    assert "Hayes et al." in called.out
    assert "report:" not in called.out


def test_json_is_one_object_and_nothing_else(benchmark_cli) -> None:
    called = benchmark_cli("verify", "lame_cylinder/nu_0.3", "--json")
    found = json.loads(called.out)
    assert called.code == 0
    assert found["schema"] == 1
    assert [entry["case"].rpartition("/")[2] for entry in found["cases"]] == ["hoop_inner", "u_inner", "u_outer"]
    assert all(entry.keys() == KEYS for entry in found["cases"])
    references = [entry["reference"] for entry in found["cases"]]
    assert references == pytest.approx([16.6667, 4.5396825e-3, 2.8888889e-3], rel=1e-5)


def test_out_gets_table_and_report(benchmark_cli, tmp_path) -> None:
    called = benchmark_cli("verify", "hayes/ratio_1", "--out", tmp_path / "v", "--quiet")
    assert called.code == 0
    assert str(tmp_path / "v" / "report.html") in called.out
    files = {"manifest.json", "verification.json", "verification.csv", "report.html"}
    assert {path.name for path in (tmp_path / "v").iterdir()} == files
    again = benchmark_cli("verify", "hayes/ratio_2", "--out", tmp_path / "v", "--quiet")
    assert again.code == 0
    assert "hayes/ratio_2" in (tmp_path / "v" / "verification.csv").read_text()


def test_a_failed_case_is_exit_code_one_with_its_results(benchmark_cli, one_off, tmp_path) -> None:
    called = benchmark_cli("verify", "--json", "--out", tmp_path / "v")
    assert called.code == 1
    assert [entry["passed"] for entry in json.loads(called.out)["cases"]] == [False]
    assert "verification failed: off" in called.err
    assert (tmp_path / "v" / "report.html").is_file()


def test_an_unknown_case_is_exit_code_two(benchmark_cli) -> None:
    called = benchmark_cli("verify", "haies")
    assert called.code == 2
    assert called.out == ""
    assert "hayes" in called.err


def test_a_folder_of_something_else_is_refused_before_anything_runs(benchmark_cli, tmp_path) -> None:
    (tmp_path / "thesis.tex").write_text("mine")
    called = benchmark_cli("verify", "--out", tmp_path)
    assert called.code == 2
    assert "cases:" not in called.err
    assert (tmp_path / "thesis.tex").read_text() == "mine"
