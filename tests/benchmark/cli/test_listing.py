import json
import tomllib

from benchmark.files import shipped_scenarios, shipped_tissues


def test_tissues_are_listed_with_their_sources(benchmark_cli) -> None:
    listed = json.loads(benchmark_cli("tissues", "--json").out)["tissues"]
    assert [each["name"] for each in listed] == list(shipped_tissues())
    assert all(each["citation"] for each in listed)
    text = benchmark_cli("tissues").out
    assert all(name in text for name in shipped_tissues())


def test_a_tissue_prints_as_a_file_to_start_from(benchmark_cli) -> None:
    table = tomllib.loads(benchmark_cli("tissues", "skin_forearm").out)
    assert [layer["name"] for layer in table["layers"]] == ["epidermis", "dermis", "subcutaneous_fat"]
    assert benchmark_cli("tissues", "skin_foream").code == 2


def test_scenarios_are_listed_and_resolved(benchmark_cli) -> None:
    listed = json.loads(benchmark_cli("scenarios", "--json").out)["scenarios"]
    assert [each["name"] for each in listed] == list(shipped_scenarios())
    resolved = tomllib.loads(benchmark_cli("scenarios", "skin-5N", "--set", "load.peak=2 N").out)
    assert resolved["load"]["peak"] == "2 N"
    assert resolved["fem"]["kinematics"] == "finite"
