"""Set-up parameters as nuisances of the base: which, how uncertain, and what they change."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.base.base_shape import Shape, ShapedTable
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.base.setup_priors import setup_entries, setup_priors, shares, table_keys, unused
from benchmark.discovery.base.trials_problem import OWN
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import load_session
from benchmark.response.elastic_table import ElasticTable, SetupDerivative

TWO_LAYERS = """\
schema = 1
name = "two"

[[layers]]
name = "dermis"
thickness = "2 mm +/- 1 %"
density = "1100 kg/m^3"
youngs_modulus = "30 kPa +/- 10 %"
poisson_ratio = 0.47

[[layers]]
name = "fat"
thickness = "10 mm"
density = "1000 kg/m^3"
youngs_modulus = "10 kPa"
poisson_ratio = 0.47
"""


def session_in(folder, quick_session, *, layers=None, hole=False, radius="5 mm"):
    quick_session.write_session(folder, trials=3)
    file = folder / "session.toml"
    text = file.read_text().replace('radius = "5 mm"', f'radius = "{radius}"')
    if hole:
        text = text.replace('kind = "bonded"', 'kind = "hole"\nhole_radius = "30 mm"')
    file.write_text(text)
    if layers is not None:
        (folder / "layer.toml").write_text(layers)
    return load_session(folder)


def test_where_nothing_is_stated_a_set_up_is_known_as_people_know_it(tmp_path, quick_session):
    priors = setup_priors(session_in(tmp_path, quick_session, hole=True))
    usual = criteria.SETUP_PRIOR
    assert priors == {
        "tool.radius": usual["tool.radius"],
        "support.hole_radius": usual["support.hole_radius"],
        "layer.thickness": usual["thickness"],
    }


def test_what_is_stated_takes_the_place_of_what_people_know(tmp_path, quick_session):
    session = session_in(tmp_path, quick_session, layers=TWO_LAYERS, radius="5 mm +/- 2 %")
    priors = setup_priors(session)
    assert priors["tool.radius"] == pytest.approx(0.02)
    assert priors["dermis.thickness"] == pytest.approx(0.01)
    assert priors["dermis.youngs_modulus"] == pytest.approx(0.1)
    assert priors["fat.youngs_modulus"] == criteria.SETUP_PRIOR["youngs_modulus"]


@pytest.mark.slow
def test_a_sheet_over_a_hole_could_be_held_and_touched_otherwise(tmp_path, quick_session):
    assert table_keys(session_in(tmp_path / "bonded", quick_session)) == ("tool.radius", "layer.thickness")
    assert table_keys(session_in(tmp_path / "hole", quick_session, hole=True))[-2:] == (
        "support.clamp",
        "tool.contact",
    )


def test_a_set_up_has_an_entry_for_each_key_that_all_tables_know():
    depth = np.linspace(0.0, 1.0, 5)
    zero = SetupDerivative(np.zeros((1, 5)))
    tables = [ElasticTable(depth, depth, depth, by=dict.fromkeys(keys, zero)) for keys in ("ab", "b")]
    assert [entry.slug for entry in setup_entries(tables)] == ["setup.b"]
    clamp = setup_entries([ElasticTable(depth, depth, depth, by={"support.clamp": zero})])[0]
    share = clamp.description.parameters[0]
    assert (clamp.slug, share.low, share.high) == ("setup.support.clamp", 0.0, 1.0)


def test_an_entry_changes_the_base_beyond_what_its_prior_allows(tmp_path, quick_session):
    problem = calibrate(*prepared(tmp_path, quick_session)).problem
    entry = next(one for one in setup_entries(problem.tables) if one.slug == "setup.layer.thickness")
    model = EffectModel(problem, (entry,))
    vector = model.vector(np.zeros(model.shape_count), {entry.slug: {"change": 0.1}})
    assert model.shape(vector).setup["layer.thickness"] == pytest.approx(0.1)
    plain = EffectModel(problem, ()).signals(np.zeros(model.shape_count), np.zeros((6, len(OWN))))
    moved = model.signals(vector, np.zeros((6, len(OWN))))
    assert moved[0][:, 0].max() < 0.97 * plain[0][:, 0].max()  # a thicker layer on a base is softer


def prepared(folder, quick_session):
    session = session_in(folder, quick_session)
    return session, prepare(session, 60)


def test_what_all_layers_share_of_their_moduli_scales_the_force_and_moves_nothing(tmp_path, quick_session):
    session = session_in(tmp_path, quick_session, layers=TWO_LAYERS)
    problem = calibrate(session, prepare(session, 60)).problem
    assert problem.moduli == ("dermis.youngs_modulus", "fat.youngs_modulus")
    model = EffectModel(problem, ())
    stiffer, scaled = (dict.fromkeys(problem.shapes, 0.0) for _ in range(2))
    stiffer |= dict.fromkeys(problem.moduli, 0.5)
    scaled["modulus"] = 0.5
    for beside in (0.0, -0.1):
        both = [{**each, "dermis.youngs_modulus": each["dermis.youngs_modulus"] + beside} for each in (stiffer, scaled)]
        shapes = [model.shape(np.array([each[name] for name in problem.shapes])) for each in both]
        assert shapes[0].modulus == pytest.approx(shapes[1].modulus)
        assert shapes[0].setup == pytest.approx(shapes[1].setup)


def test_moduli_beside_a_stress_of_another_origin_do_not_scale_the_force(tmp_path, quick_session):
    session = session_in(tmp_path, quick_session, layers=TWO_LAYERS)
    problem = calibrate(session, prepare(session, 60)).problem
    by = {key: replace(each, force=0.9 * each.force) for key, each in problem.tables[0].by.items()}
    assert replace(problem, tables=(replace(problem.tables[0], by=by),)).moduli == ()
    assert replace(problem, tables=(replace(problem.tables[0], by={}),)).moduli == ()


def test_the_modulus_of_one_layer_is_the_common_factor_and_a_density_changes_nothing(tmp_path, quick_session):
    layer = quick_session.TISSUE.replace('"30 kPa"', '"30 kPa +/- 30 %"').replace("12 mm", "12 mm +/- 3 %")
    session = session_in(tmp_path, quick_session, layers=layer.replace("kg/m^3", "kg/m^3 +/- 2 %"))
    assert set(setup_priors(session)) == {"tool.radius", "layer.thickness"}
    depth = np.linspace(0.0, 1.0, 5)
    zero = SetupDerivative(np.zeros((1, 5)))
    table = ElasticTable(depth, depth, depth, by={"tool.radius": zero, "layer.thickness": zero})
    assert unused(session, [table]) == ("stated uncertainties that the base does not take up: layer.density",)
    assert "layer.thickness" in unused(session, [table, ElasticTable(depth, depth, depth)])[0]


def test_a_law_with_constants_of_its_own_has_no_modulus_to_change(tmp_path, quick_session):
    own = TWO_LAYERS.replace("10 kPa", "10 kPa +/- 20 %") + 'hyperelastic = { law = "neo_hookean", c10 = "2 kPa" }\n'
    keys = setup_priors(session_in(tmp_path, quick_session, layers=own))
    assert "dermis.youngs_modulus" in keys
    assert "fat.youngs_modulus" not in keys
    assert keys["fat.stiffness"] == pytest.approx(0.2)  # as its modulus is stated


def test_moduli_are_logarithms_and_forms_are_no_set_up():
    assert shares({"modulus": 1.0, "fat.youngs_modulus": np.log(1.5), "fat.thickness": 0.1, "bend": 0.2}) == {
        "fat.youngs_modulus": pytest.approx(0.5),
        "fat.thickness": 0.1,
    }


def test_a_table_is_changed_by_its_set_up():
    depth = np.linspace(0.0, 4e-3, 100)
    by = {"fat.thickness": SetupDerivative(np.stack([-200.0 * depth, 1000.0 * depth]))}
    table = ElasticTable(depth, 1000.0 * depth, np.array([0.0, 1.0]), by=by)
    shaped = ShapedTable(table, Shape(setup={"fat.thickness": 0.1}), 4e-3)
    assert shaped.force(np.array([2e-3])) == pytest.approx((1000.0 - 20.0 + 10.0) * 2e-3, rel=2e-3)


def test_a_base_has_them_as_nuisances_within_reach(tmp_path, quick_session):
    layer = quick_session.TISSUE.replace("12 mm", "12 mm +/- 4 %")
    session = session_in(tmp_path, quick_session, layers=layer, radius="5 mm +/- 2 %")
    model = calibrate(session, prepare(session, 60)).base.model
    at = {name: k for k, name in enumerate(model.problem.shapes)}
    low, high = model.bounds
    precision = model.prior(np.zeros(model.size))[1]
    assert (low[at["tool.radius"]], high[at["layer.thickness"]]) == (-criteria.FAR_SETUP, criteria.FAR_SETUP)
    assert precision[at["tool.radius"]] == pytest.approx(0.02**-2)
    assert precision[at["layer.thickness"]] == pytest.approx(0.04**-2)
