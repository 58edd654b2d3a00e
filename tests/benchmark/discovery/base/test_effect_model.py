"""What the catalogue says of its strengths: without them an effect adds nothing, whatever its other parameters are."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from benchmark.discovery.base.base_shape import ShapedTable
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import load_session
from benchmark.physics import catalogue
from benchmark.response.elastic_table import Addition, SeparableField
from benchmark.response.wave_table import wave_table
from benchmark.sessions import SHIPPED


@pytest.fixture(scope="module")
def base():
    """The base of four filmed presses of the phantom."""
    session = load_session(SHIPPED / "phantom")
    filmed = tuple(trial for trial in session.trials if trial.markers is not None)[:4]
    some = replace(session, trials=filmed)
    return calibrate(some, prepare(some, 40), partial(wave_table, keys=("tool.radius",))).base


@pytest.mark.parametrize("effect", catalogue(), ids=lambda each: each.slug)
def test_an_effect_grows_from_nothing_by_its_strengths_alone(base, effect):
    strengths = {effect.amplitude, *effect.amplitudes}
    if any(p.logarithmic for p in effect.description.parameters if p.name in strengths):
        pytest.skip("a logarithmic strength has no none")
    model, (first, *_) = EffectModel(base.model.problem, (effect,)), _starts(base, effect)
    none = {name: 0.0 if name in strengths else value for name, value in first.items()}
    plain, with_none, with_start = (
        each.signals(vector, base.nuisance)
        for each, vector in (
            (base.model, base.vector),
            (model, model.vector(base.vector, {effect.slug: none})),
            (model, model.vector(base.vector, {effect.slug: first})),
        )
    )
    scale = base.model.problem.noise.scale
    added = [np.abs(a - b).max(axis=0) / s for a, b, s in zip(with_none, plain, scale, strict=True)]
    shown = [np.abs(a - b).max(axis=0) / s for a, b, s in zip(with_start, plain, scale, strict=True)]
    assert np.max(added) < 1e-9
    assert np.max(shown) > 1e-3


def test_a_tension_that_the_table_carries_is_the_tables_not_the_catalogues(base):
    problem, effect = base.model.problem, catalogue_entry("pretension")
    tables = []
    for table in problem.tables:
        parts = 1e-6 * table.force[None], (scaled(table.outward),), (scaled(table.sink),)
        more = Addition(np.array([1e4]), *parts)
        tables.append(replace(table, added={"physics.pretension": more}))
    model = EffectModel(replace(problem, tables=tuple(tables)), (effect,))
    stress, part = 5e4, 0.4
    vector = model.vector(base.vector, {"pretension": {"pretension": stress, "field": part}})
    shape = replace(base.model.shape(base.vector), added={"physics.pretension": (stress, part)})
    assert model.shape(vector) == shape
    stiffer, plain = (ShapedTable(tables[0], each, 4e-3) for each in (shape, replace(shape, added={})))
    assert stiffer.forces - plain.forces == pytest.approx(0.05 * tables[0].force)  # whatever the specimen's modulus
    moved = 0.02 * np.exp(-shape.modulus) * tables[0].outward.table
    assert stiffer.outward.table - plain.outward.table == pytest.approx(moved, abs=1e-6 * moved.max())
    signals = model.signals(vector, base.nuisance)
    assert np.max(np.abs(signals[0] - base.model.signals(base.vector, base.nuisance)[0])) > 0.0
    assert model.pipelines[0].effects[0].body is None


def catalogue_entry(slug):
    return next(effect for effect in catalogue() if effect.slug == slug)


def scaled(field):
    return SeparableField(1e-6 * field.amplitudes, field.shapes)


def _starts(base, effect):
    """Starts of a fit, those in which most parameters do something first."""
    starts = effect.first_values(base.model.problem.study.conditions[0].around)
    return sorted(starts, key=lambda each: -sum(value != 0.0 for value in each.values()))
