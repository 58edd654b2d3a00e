import json
import math

import pytest

from benchmark.cli.console import Console
from benchmark.discovery.from_run import read_run, repair_run
from benchmark.physics import catalogue
from reports.manifest import MANIFEST, manifest_of

QUIET = Console(quiet=True)
ELASTIC = tuple(e for e in catalogue() if e.slug in ("strain_stiffening", "pretension", "bottoming_out", "anisotropy"))


def _repaired(folder, other=None):
    second = None if other is None else read_run(other)
    return repair_run(read_run(folder), second, ELASTIC, 0, QUIET)


def test_stiffening_is_found_and_closes_every_layer(make_run) -> None:
    record = _repaired(make_run(growth=4.0))
    found = record.found
    assert found.verdict == "conditional"
    (effect,) = found.effects
    assert effect.slug == "strain_stiffening"
    assert not effect.lookalikes
    values = {estimate.name: estimate for estimate in effect.parameters}
    assert values["b_2"].value == pytest.approx(4.0, rel=0.02)
    assert values["b_1"].value == pytest.approx(0.0, abs=0.02)
    assert found.gap[0].closed == pytest.approx(1.0, abs=0.01)
    for layer in record.layers:
        assert layer.peak_before > 20.0
        assert abs(layer.peak_after) < 1.0
        assert layer.closed == pytest.approx(1.0, abs=0.01)


def test_nothing_is_random_and_nothing_claims_to_be(make_run) -> None:
    found = _repaired(make_run()).found
    assert found.p is None
    assert all(math.isnan(candidate.z) for candidate in found.candidates)
    assert all(math.isnan(place.p) for place in found.where)
    assert "without replicates or noise" in found.warnings[0]


def test_the_place_is_the_deep_part(make_run) -> None:
    where = _repaired(make_run()).found.where
    assert where[0].phase in ("load", "unload_high")
    assert where[0].depth[1] == max(place.depth[1] for place in where)
    assert where[0].size > 0.0


def test_agreement_is_no_discrepancy(make_run) -> None:
    record = _repaired(make_run(growth=0.02))
    assert record.found.verdict == "no_discrepancy"
    assert record.found.effects == ()
    assert record.repaired().effects == ()


def test_what_no_effect_explains_is_outside(make_run) -> None:
    record = _repaired(make_run(growth=-2.0))
    assert record.found.verdict == "outside_catalogue"
    assert not record.named
    assert record.layers[0].peak_after == record.layers[0].peak_before


def test_a_second_run_is_held_out(make_run) -> None:
    record = _repaired(make_run(name="small", peak=3.0), make_run(name="large", peak=5.0))
    assert record.found.gap[0].held_out == "condition"
    assert record.found.gap[0].closed == pytest.approx(1.0, abs=0.01)
    assert [trace.held_out for trace in record.found.traces] == [False, True]
    assert record.found.conditions == ("small", "large")


def test_a_run_whose_files_were_changed_is_told_of(make_run) -> None:
    folder = make_run()
    (folder / MANIFEST).write_text(json.dumps(manifest_of(folder)))
    assert not any("not as they were written" in each for each in _repaired(folder).found.warnings)
    results = folder / "results.json"
    results.write_text(results.read_text() + " ")
    assert "not as they were written: results.json" in _repaired(folder).found.warnings[0]
