from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.model_file import AddedEffect, RepairedModel, Value, model_toml, read_model
from benchmark.physics import catalogue

CARDS = {effect.slug: (effect.richer or effect).description for effect in catalogue()}
MODEL = RepairedModel(
    "model.toml",
    "skin_forearm",
    "wave",
    (
        AddedEffect(
            "viscoelastic_relaxation",
            {"g_1": Value(0.31, "", (0.29, 0.33)), "tau_1": Value(2.99, "s", (2.7, 3.3))},
        ),
        AddedEffect("machine_compliance", {"compliance": Value(1.2e-4, "m/N", (1e-4, 1.4e-4))}),
    ),
    {"session": 'a "quoted" name', "verdict": "named", "gap": {"force_z": {"closed": 0.97, "rmse": float("nan")}}},
    "corrected",
)
HEAD = 'schema = 1\n[base]\ntissue = "skin_forearm"\nmodel = "wave"\n'


def _written(folder: Path, text: str) -> Path:
    path = folder / "model.toml"
    path.write_text(text)
    return path


def test_what_is_written_reads_back(tmp_path: Path) -> None:
    read = read_model(_written(tmp_path, model_toml(MODEL)), CARDS)
    assert read.effects == MODEL.effects
    assert (read.tissue, read.model, read.large_press) == ("skin_forearm", "wave", "corrected")
    assert read.evidence["session"] == 'a "quoted" name'
    assert read.evidence["gap"] == {"force_z": {"closed": 0.97}}
    assert read.slugs == ("viscoelastic_relaxation", "machine_compliance")


def test_units_are_read_and_a_value_may_stand_alone(tmp_path: Path) -> None:
    text = (
        HEAD + '[[effects]]\nname = "viscoelastic_relaxation"\n[effects.parameters]\ng_1 = "30 %"\ntau_1 = "250 ms"\n'
    )
    (effect,) = read_model(_written(tmp_path, text), CARDS).effects
    assert effect.values() == {"g_1": pytest.approx(0.3), "tau_1": pytest.approx(0.25)}
    assert effect.parameters["g_1"].ci95 is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAD.replace("schema = 1\n", ""), ["schema", "missing"]),
        (HEAD.replace("= 1", "= 9"), ["schema", "9"]),
        (HEAD.replace('"wave"', '"magic"'), ["base.model", "magic", "wave"]),
        (HEAD + "colour = 3\n", ["colour", "not known"]),
        (HEAD + '[[effects]]\nname = "strain_stiffning"\n', ["strain_stiffning", "strain_stiffening"]),
        (HEAD + '[[effects]]\nname = "machine_compliance"\n', ["machine_compliance", "compliance", "missing"]),
        (
            HEAD + '[[effects]]\nname = "machine_compliance"\n[effects.parameters]\ncompliance = "3 kPa"\n',
            ["line 8", "compliance", "pressure"],
        ),
        (
            HEAD + '[[effects]]\nname = "machine_compliance"\n[effects.parameters]\ncompliance = "-3 mm/N"\n',
            ["compliance", "0 to"],
        ),
        (
            HEAD + '[[effects]]\nname = "machine_compliance"\n[effects.parameters]\ncomplience = "3 um/N"\n',
            ["complience", "compliance"],
        ),
        (
            HEAD + 2 * '[[effects]]\nname = "machine_compliance"\n[effects.parameters]\ncompliance = "3 um/N"\n',
            ["machine_compliance", "twice"],
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_place(tmp_path: Path, text: str, words: list[str]) -> None:
    with pytest.raises(InputError) as failure:
        read_model(_written(tmp_path, text), CARDS)
    for word in (str(tmp_path / "model.toml"), *words):
        assert word in str(failure.value)
