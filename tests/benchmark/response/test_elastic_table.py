"""What a table makes of the orders of its set-up's parameters."""

from __future__ import annotations

import numpy as np
import pytest

from benchmark.response.elastic_table import Addition, ElasticTable, SeparableField, SetupDerivative

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
    added = {"physics.pretension": Addition(np.array([200.0]), (2.0 * FORCE)[None], (more,), (out,))}
    found = ElasticTable(DEPTH, FORCE, radius, out, sunk, added=added).compact()
    amounts = {"physics.pretension": 300.0}
    assert found.force_added(amounts) == pytest.approx(600.0 * FORCE, rel=1e-12)
    assert found.force_added({}) == pytest.approx(0.0 * FORCE, abs=0.0)
    outward, sink = found.outward_with({}, amounts), found.sink_with({}, amounts)
    assert outward is not None
    assert sink is not None
    np.testing.assert_allclose(outward.table, out.table + 300.0 * more.table, atol=1e-9 * out.table.max())
    np.testing.assert_allclose(sink.table, sunk.table + 300.0 * out.table, atol=1e-9 * sunk.table.max())


def test_what_is_added_follows_its_amount_and_the_set_up_and_a_face_shows_part_of_it() -> None:
    amounts = np.geomspace(10.0, 1e5, 5)

    def per_unit(amount: float | np.ndarray) -> np.ndarray:
        return np.asarray(1.0 + 0.5 / (1.0 + amount / 1e3))

    radius = np.array([0.0, 1e-3, 2e-3])
    fields = tuple(SeparableField(float(each) * DEPTH[None], radius[None]) for each in per_unit(amounts))
    powers = {"tool.radius": 0.5 + 0.0 * DEPTH, "fat.thickness": 1.0 + 0.0 * DEPTH}
    more = Addition(amounts, per_unit(amounts)[:, None] * FORCE, fields, fields, powers)
    still = SeparableField(DEPTH[None], radius[None])
    found = ElasticTable(DEPTH, FORCE, radius, still, still, added={"physics.pretension": more}).compact()
    for amount in (1.0, 10.0, 300.0, 2e3, 3e4):
        told = {"physics.pretension": amount}
        wanted = amount * (per_unit(amount) if amount > 10.0 else per_unit(10.0))
        assert found.force_added(told) == pytest.approx(wanted * FORCE, rel=0.03)
        outward = found.outward_with({}, told, {"physics.pretension": 0.4})
        assert outward is not None
        assert outward.table[-1] - still.table[-1] == pytest.approx(0.4 * wanted * still.table[-1], rel=0.03)
    beyond = found.force_added({"physics.pretension": 1e7})
    assert beyond == pytest.approx(1e7 * per_unit(1e5) * FORCE, rel=1e-9)
    changed = found.force_added({"physics.pretension": 1e3}, {"tool.radius": 0.21, "fat.thickness": -0.2})
    assert changed == pytest.approx(found.force_added({"physics.pretension": 1e3}) * 1.1 * 0.8, rel=1e-9)


def test_what_is_added_stays_finite_for_a_set_up_far_away() -> None:
    more = Addition(np.array([200.0]), FORCE[None], powers={"tool.radius": np.full(FORCE.size, 1e4)})
    assert np.isfinite(more.force_of(1.0, {"tool.radius": 1.0})).all()
