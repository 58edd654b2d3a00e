"""`benchmark tissues new`: a file that reads as it stands, and with every option in it switched on."""

import json
import re
from pathlib import Path

import pytest

from benchmark.files import load_tissue


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_the_file_reads_as_a_tissue(benchmark_cli, tmp_path: Path) -> None:
    called = benchmark_cli("tissues", "new", "my_skin")
    assert called.code == 0
    assert "my_skin.toml" in called.out
    assert list(tmp_path.iterdir()) == [tmp_path / "my_skin.toml"]
    tissue = load_tissue("my_skin.toml")
    assert (tissue.name, tissue.layer_names) == ("my_skin", ("dermis", "fat"))
    assert benchmark_cli("tissues", "my_skin.toml").code == 0


def test_every_option_in_it_is_valid(benchmark_cli, tmp_path: Path) -> None:
    benchmark_cli("tissues", "new", "my_skin")
    path = tmp_path / "my_skin.toml"
    options = re.compile(r"^# (?=(max_force|hyperelastic|relaxation|fibre) =)", re.MULTILINE)
    text, switched = options.subn("", path.read_text())
    assert switched == 4
    path.write_text(text)
    tissue = load_tissue(path)
    assert tissue.max_force == 5.0
    fat = tissue.layer("fat")
    assert fat.hyperelastic.law == "yeoh"
    assert 2 * (fat.hyperelastic.c10) == pytest.approx(fat.shear_modulus, rel=0.01), "the law fits the modulus above it"
    assert len(fat.relaxation) == 2
    assert fat.fibre is not None


def test_it_never_overwrites(benchmark_cli, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text("years of work")
    for name in ("mine", "mine.toml"):
        called = benchmark_cli("tissues", "new", name)
        assert called.code == 2
        assert "mine.toml" in called.err
    assert (tmp_path / "mine.toml").read_text() == "years of work"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["new"], "name"),
        (["new", "skin_forearm"], "ships"),
        (["new", 'a"b'], "no name"),
        (["new", "nowhere/mine.toml"], "nowhere"),
        (["skin_forearm", "extra"], "extra"),
    ],
)
def test_what_it_refuses(benchmark_cli, tmp_path: Path, words: list[str], said: str) -> None:
    called = benchmark_cli("tissues", *words)
    assert called.code == 2, called.err
    assert said in called.err
    assert list(tmp_path.iterdir()) == []


def test_json_names_the_file(benchmark_cli) -> None:
    called = benchmark_cli("tissues", "new", "my_skin", "--json")
    assert json.loads(called.out) == {"schema": 1, "file": "my_skin.toml"}


def test_what_to_do_next_can_be_typed_as_it_stands(benchmark_cli) -> None:
    called = benchmark_cli("reference", "new", "skin-5N", "--out", "my fea.csv")
    assert "--reference 'my fea.csv'" in called.out
    assert benchmark_cli("tissues", "new", "my_skin", "--quiet").out == "my_skin.toml\n"
