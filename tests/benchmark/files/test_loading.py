import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario, load_tissue

DESIGN = """\
schema = 1
name = "skin-5N"
tissue = "skin_forearm"
[tool]
radius = "5 mm"
contact = "uniform_pressure"
edge_radius = "0.5 mm"
position = ["0 mm", "0 mm"]
tilt = "0 deg"
[support]
kind = "bonded"
[load]
control = "force"
peak = "5 N"
shape = "triangle"
duration = "10 s"
observations = 100
hold = "10 s"
[physics]
pretension = "20 kPa"
[comparison]
equivalence_margin = "2 %"
[fem]
kinematics = "finite"
geometry = "axisymmetric"
mesh = "default"
radius = "auto"
[wave]
model = "layered"
modes = "auto"
window = "auto"
"""


def refusal(read, *arguments, **keywords):
    with pytest.raises(InputError) as error:
        read(*arguments, **keywords)
    said = str(error.value)
    assert error.value.exit_code == 2
    assert "\n" not in said
    return said


def test_the_scenario_of_the_file_reference_loads(tmp_path):
    path = tmp_path / "all.toml"
    path.write_text(DESIGN)
    scenario = load_scenario(path)
    assert scenario.tissue.layer_names == ("epidermis", "dermis", "subcutaneous_fat")
    assert (scenario.tool.edge_radius, scenario.load.hold, scenario.physics.pretension) == (5e-4, 10.0, 20e3)
    assert (scenario.fem.radius, scenario.wave.modes, scenario.wave.window) == (None, None, None)


def test_a_tissue_is_found_beside_the_scenario(scenario_file):
    scenario = load_scenario(scenario_file)
    assert scenario.tissue.name == "slab"
    assert scenario.tissue.layer("skin").thickness == 1.5e-3
    assert load_scenario(str(scenario_file)) == scenario


def test_a_tissue_may_stand_in_the_scenario(scenario_file, tissue_file, change):
    table = tissue_file.read_text().replace("schema = 1", "[tissue]").replace("[[layers]]", "[[tissue.layers]]")
    change(scenario_file, 'tissue = "slab.toml"\n', "")
    outside = load_scenario(scenario_file, {"tissue": str(tissue_file)})
    scenario_file.write_text(scenario_file.read_text() + table)
    assert load_scenario(scenario_file) == outside


def test_an_error_in_an_inline_tissue_names_its_line(scenario_file, tissue_file, change):
    table = tissue_file.read_text().replace("schema = 1", "[tissue]").replace("[[layers]]", "[[tissue.layers]]")
    change(scenario_file, 'tissue = "slab.toml"\n', "")
    scenario_file.write_text(scenario_file.read_text() + table.replace('"10 mm"', '"-10 mm"'))
    said = refusal(load_scenario, scenario_file)
    assert said.startswith(f"{scenario_file}, line 22, tissue.layers[fat].thickness: '-10 mm' is outside")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('thickness = "10 mm"', 'thicknes = "1 m"', "line 14, layers[fat].thicknes: this key is not known; did you"),
        ('thickness = "10 mm"', 'thickness = "5 kPa"', "line 14, layers[fat].thickness: '5 kPa' is a pressure, not"),
        ('thickness = "10 mm"', 'thickness = "-10 mm"', "line 14, layers[fat].thickness: '-10 mm' is outside what"),
        ('thickness = "10 mm"', "thickness = 10", "line 14, layers[fat].thickness: the bare number 10 has no unit"),
        ('thickness = "10 mm"', 'thickness = "nan mm"', "line 14, layers[fat].thickness: 'nan mm' is not a finite"),
        ('density = "971 kg/m^3"', "", "line 12, layers[fat].density: this key is missing"),
        ("0.48", "0.5", "line 10, layers[skin].poisson_ratio: 0.5 is outside what is allowed, 0 to 0.49999"),
        ("schema = 1", "schema = 2", "line 1, schema: 2 is not a schema that this version reads; allowed: 1"),
        ("schema = 1", "", "the key schema is missing; a tissue file begins with schema = 1"),
        ('"skin"', '"fat"', "layers: 2 layers are named 'fat'"),
        ('"skin"', '" Fat "', "layers: 2 layers are named ' Fat ' and 'fat'; each layer needs its own name"),
        ('youngs_modulus = "', 'shear_modulus = "', "which is 2 (1 + poisson_ratio) times the shear modulus."),
        ('youngs_modulus = "', 'bulk_modulus = "', "which is 3 (1 - 2 poisson_ratio) times the bulk modulus."),
        ('youngs_modulus = "', 'E = "', "this key is not known; Young's modulus is youngs_modulus."),
        ('youngs_modulus = "', 'C10 = "', 'as in hyperelastic = { law = "yeoh", c10 = '),
        ('name = "slab"', "name = 5", "line 2, name: 5 is not text"),
        ('thickness = "1.5 mm"', "", "line 5, layers[skin].thickness: the layer 'skin' has no thickness"),
    ],
)
def test_a_bad_tissue_is_refused_with_file_line_and_key(tissue_file, change, old, new, says):
    said = refusal(load_tissue, change(tissue_file, old, new))
    assert said.startswith(str(tissue_file))
    assert says in said


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('peak = "5 N"', 'peak = "0 N"', "line 9, load.peak: '0 N' is no press"),
        ('peak = "5 N"', "", "load.peak: this key is missing"),
        ('peak = "5 N"', 'peak = "5 N"\nshape = "square"', "line 10, load.shape: 'square' is not allowed"),
        (
            'peak = "5 N"',
            'peak = "5 N"\n[fem]\nmsh = "fine"',
            "line 11, fem.msh: this key is not known; did you mean mesh",
        ),
        ('peak = "5 N"', 'peak = "5 N"\n[wawe]', "line 10, wawe: this key is not known; did you mean wave?"),
        ('radius = "5 mm"', 'radius = "5 kPa"', "line 6, tool.radius: '5 kPa' is a pressure, not a length"),
        ("[tool]", "[[tool]]", "tool: [{'radius': '5 mm'}] is no table of keys and values"),
        ('tissue = "slab.toml"', 'tissue = "none.toml"', "none.toml: there is no such tissue file"),
        ('tissue = "slab.toml"', 'tissue = "skin_forarm"', "line 3, tissue: no tissue 'skin_forarm' ships"),
        ('tissue = "slab.toml"', "tissue = 5", "line 3, tissue: 5 is no table of keys and values"),
        ('tissue = "slab.toml"', "", "tissue: this key is missing"),
        ("schema = 1", "schema = 0", "line 1, schema: 0 is not a schema"),
    ],
)
def test_a_bad_scenario_is_refused_with_file_line_and_key(scenario_file, change, old, new, says):
    assert says in refusal(load_scenario, change(scenario_file, old, new))


def test_a_tissue_file_in_a_scenarios_place_is_said_to_be_one(tissue_file):
    with pytest.raises(InputError) as failure:
        load_scenario(tissue_file)
    way = f"python -m benchmark run skin-5N --tissue {tissue_file}"
    assert str(failure.value) == f"{tissue_file}: this is a tissue file; a scenario presses it: {way}"
    with pytest.raises(InputError, match=r"'skin_forearm' is a tissue; .* run skin-5N --tissue skin_forearm$"):
        load_scenario("skin_forearm")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('[[trials]]\nfile = "a.csv"\ncondition = "a"\n', "a session file; .* run --trials"),
        ('[base]\ntissue = "skin_forearm"\nmodel = "wave"\n', "a model file; .* run skin-5N --model"),
    ],
)
def test_other_files_in_a_scenarios_place_are_said_to_be_so(tmp_path, text, says):
    file = tmp_path / "my file.toml"
    file.write_text(f"schema = 1\n{text}")
    with pytest.raises(InputError, match=rf"this is {says} '{file}'$"):
        load_scenario(file)


def test_a_missing_file_is_refused_by_name(tmp_path):
    assert refusal(load_tissue, tmp_path / "none.toml").startswith(str(tmp_path / "none.toml"))
    assert "no scenario 'skin-6N' ships" in refusal(load_scenario, "skin-6N")
    assert "did you mean skin-5N" in refusal(load_scenario, "skin-6N")


def test_set_reaches_sections_layers_and_the_tissue():
    scenario = load_scenario(
        "skin-5N",
        {
            "load.peak": "0.01 N",
            "fem.kinematics": "linear",
            "wave.modes": "48",
            "physics.pretension": "20 kPa",
            "dermis.youngs_modulus": "120 kPa",
            "tissue.epidermis.thickness": "0.08 mm",
            "dermis.hyperelastic": '{ law = "yeoh", c10 = "20 kPa" }',
            "subcutaneous_fat.relaxation": '[{ g = 0.3, tau = "0.5 s" }]',
            "max_force": "6 N",
            "name": "light",
            "tissue.name": "mine",
        },
    )
    assert (scenario.load.peak, scenario.fem.kinematics, scenario.wave.modes) == (0.01, "linear", 48)
    assert scenario.physics.pretension == 20e3
    assert scenario.tissue.layer("dermis").youngs_modulus == 120e3
    assert scenario.tissue.layer("dermis").hyperelastic.shear_modulus == 40e3
    assert scenario.tissue.layer("epidermis").thickness == 8e-5
    assert scenario.tissue.layer("subcutaneous_fat").relaxation[0].tau == 0.5
    assert (scenario.name, scenario.tissue.name, scenario.tissue.max_force) == ("light", "mine", 6.0)


def test_set_changes_nothing_else():
    plain, changed = load_scenario("skin-5N"), load_scenario("skin-5N", {"dermis.youngs_modulus": "120 kPa"})
    tissue = plain.tissue.with_layer("dermis", youngs_modulus=120e3)
    assert changed == plain.model_copy(update={"tissue": tissue})


def test_set_takes_another_tissue_and_changes_that():
    scenario = load_scenario("skin-5N", {"silicone.thickness": "12 mm", "tissue": "ecoflex_00_30"})
    assert scenario.tissue.layer_names == ("silicone",)
    assert scenario.tissue.thickness == 12e-3


def test_files_that_set_names_are_relative_to_here(tmp_path, monkeypatch):
    (tmp_path / "load.csv").write_text("time_s,force_N\n1,2\n")
    monkeypatch.chdir(tmp_path)
    scenario = load_scenario("skin-5N", {"load.shape": "table", "load.file": "load.csv", "load.control": "force"})
    assert scenario.load.table == ((1.0, 2.0),)


def test_files_that_a_scenario_names_are_relative_to_it(scenario_file, change):
    (scenario_file.parent / "load.csv").write_text("time_s,force_N\n1,2\n")
    change(scenario_file, 'peak = "5 N"', 'shape = "table"\nfile = "load.csv"')
    assert load_scenario(scenario_file).load.peak == 2.0


def test_a_layer_called_like_a_section_is_reached_through_the_tissue(scenario_file, tissue_file, change):
    change(tissue_file, '"fat"', '"load"')
    scenario = load_scenario(scenario_file, {"tissue.load.thickness": "3 mm", "load.peak": "1 N"})
    assert (scenario.tissue.layer("load").thickness, scenario.load.peak) == (3e-3, 1.0)
    with pytest.raises(InputError, match=r"--set load\.thickness: load is a section .* tissue\.load\.thickness"):
        load_scenario(scenario_file, {"load.thickness": "3 mm"})


def test_a_layer_name_may_hold_dots(scenario_file, tissue_file, change):
    change(tissue_file, '"fat"', '"fat.deep"')
    assert load_scenario(scenario_file, {"fat.deep.thickness": "3 mm"}).tissue.layer("fat.deep").thickness == 3e-3


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("load.peak", "5 kPa", "--set load.peak: '5 kPa' is a pressure, not a force"),
        ("load.peak", "0 N", "--set load.peak: '0 N' is no press"),
        ("load.peek", "5 N", "--set load.peek: this key is not known; did you mean peak?"),
        ("laod.peak", "5 N", "--set laod.peak: this key is not known; did you mean load.peak"),
        ("dermmis.thickness", "1 mm", "--set dermmis.thickness: this key is not known; did you mean dermis.thickness"),
        ("dermis.thicknes", "1 mm", "--set dermis.thicknes: this key is not known; did you mean thickness?"),
        ("dermis.shear_modulus", "320 kPa", "--set dermis.shear_modulus: this key is not known; a layer takes youngs_"),
        ("tissue.dermmis.thickness", "1 mm", "did you mean dermis.thickness"),
        ("dermis", "1 mm", "--set dermis: this key is not known"),
        ("dermis.poisson_ratio", "0.5", "--set dermis.poisson_ratio: 0.5 is outside"),
        ("dermis.thickness", "-1 mm", "--set dermis.thickness: '-1 mm' is outside"),
        ("tool.radius", "5", "--set tool.radius: the bare number 5 has no unit"),
        ("tool.position", '["1 mm"]', "--set tool.position (1): entry 2 is missing"),
        ("support.kind", "hole", "support.hole_radius: a support of kind"),
        ("load.peak.x", "5 N", "--set load.peak.x: 'peak' is a single value"),
        ("tissue", "skin_forarm", "no tissue 'skin_forarm' ships"),
        ("schema", "2", "--set schema: 2 is not a schema"),
        ("", "2", "--set : this key is not known"),
    ],
)
def test_a_bad_set_names_its_key(key, value, says):
    assert says in refusal(load_scenario, "skin-5N", {key: value})


def test_a_rule_between_two_keys_names_the_one_that_set_changed():
    said = refusal(load_scenario, "phantom", {"support.hole_radius": "4 mm"})
    assert said.startswith("--set support.hole_radius: 4 mm is not larger than the tool's radius of 5 mm")


def test_a_tissue_takes_overrides_too():
    assert load_tissue("skin_forearm", overrides={"dermis.thickness": "2 mm"}).layer("dermis").thickness == 2e-3
    said = refusal(load_tissue, "skin_forearm", overrides={"dermi.thickness": "2 mm"})
    assert "did you mean dermis.thickness" in said


@pytest.mark.parametrize("layers", ["layers = 5", "layers = [5]", "layers = [{ name = 5 }]", "layers = []", ""])
def test_layers_that_are_none_are_refused_with_and_without_overrides(tmp_path, layers):
    path = tmp_path / "odd.toml"
    path.write_text(f'schema = 1\nname = "odd"\n{layers}\n')
    assert "layers" in refusal(load_tissue, path)
    assert "odd" in refusal(load_scenario, "skin-5N", {"tissue": str(path), "load.peak": "1 N"})
