"""What a table makes of the orders of its set-up's parameters."""

from __future__ import annotations

import numpy as np
import pytest

from benchmark.response.elastic_table import ElasticTable, SeparableField, SetupDerivative

DEPTH = np.linspace(0.0, 3e-3, 50)
FORCE = 200.0 * DEPTH**1.2


def table(**by: SetupDerivative) -> ElasticTable:
    return ElasticTable(DEPTH, FORCE, np.array([0.0, 1.0]), by={key.replace("_", ".", 1): by[key] for key in by})


def test_powers_of_parameters_are_foretold_exactly_and_together() -> None:
    found = table(
        tool_radius=SetupDerivative((2.5 * FORCE)[None]),
        fat_thickness=SetupDerivative(np.stack([-3.0 * FORCE, 6.0 * FORCE])),
    )
    force = found.force_with({"tool.radius": 0.4, "fat.thickness": -0.2})
    assert force == pytest.approx(FORCE * 1.4**2.5 * 0.8**-3.0, rel=1e-12)


def test_an_amount_acts_by_itself() -> None:
    found = table(fat_poisson_ratio=SetupDerivative(np.stack([10.0 * FORCE, 50.0 * FORCE])))
    assert found.force_with({"fat.poisson_ratio": 0.02}) == pytest.approx(FORCE * np.exp(0.2), rel=1e-12)


def test_a_field_of_second_order_follows_a_logarithm() -> None:
    radius = np.array([0.0, 1e-3, 2e-3])

    def field(size: float) -> SeparableField:
        return SeparableField(size * DEPTH[None], radius[None])

    by = {"dermis.youngs_modulus": SetupDerivative(np.stack([0.0 * FORCE]), (field(0.3), field(-0.15)))}
    found = ElasticTable(DEPTH, FORCE, radius, field(1.0), field(1.0), by)
    outward = found.outward_with({"dermis.youngs_modulus": 0.25})
    assert outward is not None
    assert outward.table == pytest.approx((1.0 + 0.3 * np.log(1.25)) * field(1.0).table, rel=1e-12)
    assert found.sink_with({"dermis.youngs_modulus": 0.25}) is found.sink


def test_what_the_set_up_as_told_has_none_of_adds_in_proportion_and_stays_on_one_basis() -> None:
    radius = np.array([0.0, 1e-3, 2e-3, 3e-3])
    out, sunk = (SeparableField(DEPTH[None], row[None]) for row in (radius, 3e-3 - radius))
    more = SeparableField(1e-3 * DEPTH[None] ** 2, radius[None] ** 2)  # small by its unit
    added = {"physics.pretension": SetupDerivative((2.0 * FORCE)[None], (more,), (out,))}
    found = ElasticTable(DEPTH, FORCE, radius, out, sunk, added=added).compact()
    amounts = {"physics.pretension": 300.0}
    assert found.force_added(amounts) == pytest.approx(600.0 * FORCE, rel=1e-12)
    assert found.force_added({}) == pytest.approx(0.0 * FORCE, abs=0.0)
    outward, sink = found.outward_with({}, amounts), found.sink_with({}, amounts)
    assert outward is not None
    assert sink is not None
    np.testing.assert_allclose(outward.table, out.table + 300.0 * more.table, atol=1e-9 * out.table.max())
    np.testing.assert_allclose(sink.table, sunk.table + 300.0 * out.table, atol=1e-9 * sunk.table.max())
