from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.model_file import AddedEffect, RepairedModel, Value, model_toml, read_model
from benchmark.physics import catalogue

KNOWN = {effect.slug: effect.forms[-1].description for effect in catalogue()}
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
    read = read_model(_written(tmp_path, model_toml(MODEL)), KNOWN)
    assert read.effects == MODEL.effects
    assert (read.tissue, read.model, read.large_press) == ("skin_forearm", "wave", "corrected")
    assert read.evidence["session"] == 'a "quoted" name'
    assert read.evidence["gap"] == {"force_z": {"closed": 0.97}}
    assert read.slugs == ("viscoelastic_relaxation", "machine_compliance")


def test_units_are_read_and_a_value_may_stand_alone(tmp_path: Path) -> None:
    text = (
        HEAD + '[[effects]]\nname = "viscoelastic_relaxation"\n[effects.parameters]\ng_1 = "30 %"\ntau_1 = "250 ms"\n'
    )
    (effect,) = read_model(_written(tmp_path, text), KNOWN).effects
    assert effect.values() == {"g_1": pytest.approx(0.3), "tau_1": pytest.approx(0.25)}
    assert effect.parameters["g_1"].ci95 is None


@pytest.mark.parametrize(("terms", "missing"), [(1, ""), (2, ""), (3, ""), (2, "tau_2"), (3, "tau_3"), (3, "g_2")])
def test_a_file_may_end_before_a_further_term_and_not_within_one(tmp_path: Path, terms: int, missing: str) -> None:
    keys = [f"{name}_{term}" for term in range(1, terms + 1) for name in ("g", "tau") if f"{name}_{term}" != missing]
    lines = [f'{key} = "{"10 %" if key[0] == "g" else "2 s"}"' for key in keys]
    text = HEAD + "\n".join(['[[effects]]\nname = "viscoelastic_relaxation"\n[effects.parameters]', *lines])
    if not missing:
        assert list(read_model(_written(tmp_path, text), KNOWN).effects[0].parameters) == keys
        return
    with pytest.raises(InputError, match=f"viscoelastic_relaxation needs the parameter {missing}; it is missing"):
        read_model(_written(tmp_path, text), KNOWN)


def test_a_file_may_state_more_than_a_fit_searches(tmp_path: Path) -> None:
    floor = HEAD + '[[effects]]\nname = "bottoming_out"\n[effects.parameters]\nfloor_depth = "3 mm"\n'
    floor += 'floor_stiffness = "1 N/mm"\npower = "{}"\n'
    (effect,) = read_model(_written(tmp_path, floor.format(2)), KNOWN).effects
    assert effect.values()["power"] == 2.0
    assert KNOWN["bottoming_out"].parameters[-1].high == 1.5
    with pytest.raises(InputError, match="allowed: 1 to 3"):
        read_model(_written(tmp_path, floor.format(3.5)), KNOWN)


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
        read_model(_written(tmp_path, text), KNOWN)
    for word in (str(tmp_path / "model.toml"), *words):
        assert word in str(failure.value)


@pytest.mark.parametrize("given", ["3", "{ value = 3 }"])
def test_a_value_without_quotes_is_said_in_words_of_the_file(tmp_path: Path, given: str) -> None:
    text = HEAD + f'[[effects]]\nname = "machine_compliance"\n[effects.parameters]\ncompliance = {given}\n'
    with pytest.raises(InputError) as failure:
        read_model(_written(tmp_path, text), KNOWN)
    key = "effects[machine_compliance].parameters.compliance.value"
    assert str(failure.value) == f"{tmp_path / 'model.toml'}, line 8, {key}: 3 is not text; write it in quotes."


def test_older_names_of_the_same_quantity_are_read(tmp_path: Path) -> None:
    older = 'force = "12 mN"\nlength = "80 um"\ncoefficient = "0.1"\n'
    text = HEAD + f'[[effects]]\nname = "dry_friction"\n[effects.parameters]\n{older}'
    (effect,) = read_model(_written(tmp_path, text), KNOWN).effects
    assert effect.values() == {"friction_force": 0.012, "friction_length": 8e-5, "friction_share": 0.1}


@pytest.mark.parametrize("effect", catalogue(), ids=lambda effect: effect.slug)
def test_every_older_name_stands_for_one_parameter(effect) -> None:
    description = effect.description
    older = [p.formerly for p in description.parameters if p.formerly] + [name for name, _ in description.retired]
    names = [p.name for p in description.parameters]
    assert len({*older, *names}) == len(older) + len(names)


def test_a_pretension_of_unknown_stress_is_refused_with_the_way_out(tmp_path: Path) -> None:
    older = '[[effects]]\nname = "pretension"\n[effects.parameters]\nstiffness = "1.5 N/mm"\nfield = "0.5"\n'
    with pytest.raises(InputError, match=r"line 8.*stress in Pa.*run discover.*pretension = \"20 kPa\""):
        read_model(_written(tmp_path, HEAD + older), KNOWN)


def test_a_bond_of_an_older_file_rises_as_it_did(tmp_path: Path) -> None:
    older = 'tear = "1 N"\nreach = "1 mm"\nadhesion_force = "0 N"\n'
    text = HEAD + f'[[effects]]\nname = "adhesion"\n[effects.parameters]\n{older}'
    assert set(read_model(_written(tmp_path, text), KNOWN).effects[0].parameters) == {"tear", "reach", "adhesion_force"}


def test_a_quantity_is_given_once(tmp_path: Path) -> None:
    both = 'tear = "0 N"\nreach = "1 mm"\npull_off = "1 N"\nadhesion_force = "1 N"\n'
    with pytest.raises(InputError, match="adhesion has adhesion_force already"):
        read_model(_written(tmp_path, HEAD + f'[[effects]]\nname = "adhesion"\n[effects.parameters]\n{both}'), KNOWN)
