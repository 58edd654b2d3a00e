"""A sheet over a hole that relaxes, or has options of a body, against closed forms."""

import numpy as np
import pytest

from wavemodel import DiscTool, NotCoveredError, PlateSettings, PlateWave, Prony, WaveError
from wavemodel.physics import Adhesion, Floor, PermanentSet, Physics

SERIES = Prony((0.3, 0.15), (0.5, 8.0))
TIME = np.array([0.5, 1.0, 2.0, 5.0, 20.0, 200.0])


def sheet_of(silicone, contact="rigid_bonded", integrator="quasi_static", **options):
    settings = PlateSettings(reach=4e-3, integrator=integrator, tension=None if integrator == "mid_point" else "local")
    return PlateWave(silicone(), DiscTool(5e-3, contact), "hole", 30e-3, settings, **options)


def faded(time, ramp):
    """Force over its elastic one of a ramp that lasts `ramp` s and a hold: int G(t - t') dt' / ramp over the ramp."""
    total = np.ones_like(time)
    for g, tau in zip(SERIES.strength, SERIES.time, strict=True):
        total -= g * (1.0 - tau / ramp * (np.exp(-(time - ramp) / tau) - np.exp(-time / tau)))
    return total


def test_held_at_a_depth_the_force_of_a_ramp_fades_by_the_closed_form(silicone):
    plate = sheet_of(silicone, relaxation=SERIES)
    elastic = float(plate.force_of_depth(np.array([3e-3]))[0])
    ramp = np.linspace(1e-3, 0.5, 400)
    law = plate.depth_of_force(elastic * ramp / 0.5)
    solution = plate.run("depth", np.concatenate([ramp, TIME[1:]]), np.concatenate([law, np.full(5, 3e-3)]))
    np.testing.assert_allclose(solution.force[ramp.size :], elastic * faded(TIME[1:], 0.5), rtol=1e-6)
    np.testing.assert_array_equal(solution.depth[ramp.size :], 3e-3)


def test_force_control_is_the_inverse_of_depth_control(silicone):
    plate = sheet_of(silicone, relaxation=SERIES)
    time = np.linspace(0.05, 6.0, 120)
    force = np.interp(time, [0.0, 1.0, 4.0, 6.0], [0.0, 1.5, 1.5, 0.2])
    by_force = plate.run("force", time, force)
    by_depth = plate.run("depth", time, by_force.depth)
    # One takes the force as linear in each step of 50 ms, the other the elastic force.
    np.testing.assert_allclose(by_depth.force, force, rtol=2e-4)
    np.testing.assert_allclose(by_depth.top_deflection, by_force.top_deflection, rtol=1e-9)
    assert by_force.depth[79] > 1.1 * by_force.depth[19]


def test_in_the_end_the_sheet_is_as_soft_as_its_series_leaves_it(silicone):
    plate = sheet_of(silicone, "uniform_pressure", relaxation=SERIES)
    solution = plate.run("force", np.array([1.0, 1e5]), np.array([0.5, 0.5]))
    assert solution.depth[-1] == pytest.approx(plate.depth_of_force(np.array([0.5 / 0.55]))[0], rel=1e-9)
    assert solution.profile(-1, np.zeros(1))[0, 0] == pytest.approx(solution.top_deflection[-1, 0], rel=1e-3)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_a_sheet_that_does_not_stick_is_lost_by_depth_and_met_where_it_has_crept_to(silicone, contact):
    """Under its force it stands at the tool or, where there is none, below it and not above nought. Stuck, it pulls."""
    plate = sheet_of(silicone, contact, relaxation=SERIES)
    time = np.linspace(0.05, 3.0, 60)
    depth = np.interp(time, [0.0, 0.5, 1.5, 1.6, 2.2, 2.4, 3.0], [-1e-3, 3e-3, 3e-3, -1e-3, -1e-3, 3e-3, 3e-3])
    pressed = plate.run("depth", time, depth)
    np.testing.assert_array_equal(pressed.depth, depth)
    if contact == "rigid_bonded":
        assert pressed.force.min() < -0.1
        return
    assert pressed.force.min() == 0.0
    back, free = plate.run("force", time, pressed.force), pressed.force == 0.0
    assert (free & (time > 1.0)).sum() > 10
    assert (pressed.top_deflection[free, 0] >= np.maximum(depth[free], 0.0)).all()
    np.testing.assert_allclose(back.depth[~free], depth[~free], atol=2e-6)
    np.testing.assert_allclose(pressed.top_deflection, back.top_deflection, atol=2e-6)


def test_options_of_the_body_act_on_the_sheet(silicone):
    time, depth = np.linspace(0.1, 2.0, 20), 3e-3 * np.minimum(np.linspace(0.1, 2.0, 20), 2.0 - np.linspace(0.1, 2, 20))
    plain, floor = sheet_of(silicone), sheet_of(silicone, physics=Physics(floor=Floor(2e-3, 1e5)))
    excess = 1e5 * np.maximum(depth - 2e-3, 0.0)
    np.testing.assert_allclose(floor.run("depth", time, depth).force, plain.force_of_depth(depth) + excess, rtol=1e-12)
    left = sheet_of(silicone, physics=Physics(permanent_set=PermanentSet(0.2)))
    solution = left.run("depth", time, depth)
    assert solution.force[-1] == 0.0
    assert solution.top_deflection[-1, 0] == pytest.approx(0.2 * depth.max(), rel=0.02)


def test_a_force_on_options_is_what_comes_back(silicone):
    plate = sheet_of(silicone, relaxation=SERIES, physics=Physics(floor=Floor(2e-3, 1e5), adhesion=Adhesion(0.1)))
    time, force = np.array([0.5, 1.0, 3.0]), np.array([0.4, 0.8, 0.8])
    solution = plate.run("force", time, force)
    np.testing.assert_allclose(solution.force, force, rtol=1e-9)
    np.testing.assert_allclose(plate.run("depth", time, solution.depth).force, force, rtol=1e-6)


def test_refuses_inertia_and_a_series_given_twice(silicone):
    with pytest.raises(NotCoveredError, match="inertia"):
        sheet_of(silicone, integrator="mid_point", relaxation=SERIES)
    with pytest.raises(WaveError, match="twice"):
        sheet_of(silicone, relaxation=SERIES, physics=Physics(relaxation=SERIES))
