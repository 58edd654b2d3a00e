from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wavemodel import Prony, WaveError
from wavemodel.integrators.load_history import checked_load
from wavemodel.physics.contact import Adhesion, DryFriction, PermanentSet
from wavemodel.physics.elastic import Floor, InterfaceSlip, Pretension, StrainStiffening, StressSoftening
from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress, drive_by_force
from wavemodel.physics.time_dependent import PoroelasticDrainage, ViscousDamping

EVERYTHING = Physics(
    stiffening=StrainStiffening(0.1, 0.5, 1e-2),
    pretension=Pretension(30.0),
    floor=Floor(2.5e-3, 1e3),
    slip=InterfaceSlip(1.0, 0.3),
    softening=StressSoftening(0.2),
    permanent_set=PermanentSet(0.05),
    relaxation=Prony((0.2, 0.1), (0.3, 3.0)),
    drainage=PoroelasticDrainage(0.1, 1e-8, 5e-3),
    damping=ViscousDamping(0.01),
    friction=DryFriction(0.05, 1e-4),
    adhesion=Adhesion(0.1),
)


def law(depth):
    if np.any(depth > 8e-3):
        raise WaveError("deeper than 8 mm")
    return 500.0 * depth


def history(rows=300):
    time = np.linspace(0.05, 30.0, rows)
    return time, -5e-4 + 3.5e-3 * np.abs(np.sin(2 * np.pi * time / 20.0))


@pytest.mark.parametrize("physics", [Physics(), EVERYTHING])
def test_the_untouched_tool_feels_nothing(physics):
    np.testing.assert_array_equal(QuasiStaticPress(law, physics).force([1.0, 2.0], [-1e-3, -1e-5]), 0.0)


def test_without_options_it_is_the_law():
    time, depth = history()
    np.testing.assert_array_equal(QuasiStaticPress(law).force(time, depth), np.maximum(500.0 * depth, 0.0))


@settings(max_examples=20, deadline=None)
@given(st.lists(st.integers(1, 299), max_size=6, unique=True))
def test_a_history_may_be_cut_anywhere(cuts):
    """With every option at once: the memories hold all there is to know."""
    load, press = checked_load("depth", *history()), QuasiStaticPress(law, EVERYTHING)
    whole = press.force(load.time, load.value)
    edges, state, pieces = [0, *sorted(cuts), 300], press.rest(), []
    for first, last in pairwise(edges):
        trace, state = press.follow(load.durations[first:last], load.value[first:last], state)
        pieces.append(trace.force)
    np.testing.assert_allclose(np.concatenate(pieces), whole, rtol=1e-10, atol=1e-12)


def test_what_is_refused_leaves_the_state_as_it_was():
    press = QuasiStaticPress(law, EVERYTHING)
    _, state = press.follow(np.full(3, 0.1), np.array([1e-3, 2e-3, 1e-3]), press.rest())
    expected = press.follow(np.full(1, 0.1), np.array([2e-3]), state)[0].force
    with pytest.raises(WaveError, match="8 mm"):
        press.follow(np.full(1, 0.1), np.array([9e-3]), state)
    np.testing.assert_array_equal(press.follow(np.full(1, 0.1), np.array([2e-3]), state)[0].force, expected)


def test_a_ten_hertz_trial_with_noise_stays_bounded():
    """Measured depth is rough; only damping may feel its rate."""
    time = np.arange(1, 601) * 0.1
    depth = 2e-3 * np.sin(np.pi * time / 60.0) + 2e-6 * np.random.default_rng(4).normal(size=600)
    smooth = QuasiStaticPress(law, EVERYTHING).force(time, 2e-3 * np.sin(np.pi * time / 60.0))
    rough = QuasiStaticPress(law, EVERYTHING).force(time, depth)
    assert np.abs(rough - smooth).max() < 0.06


@pytest.mark.parametrize("physics", [Physics(), EVERYTHING])
def test_driven_by_force_it_comes_to_the_force(physics):
    time = np.arange(1, 21) * 0.2
    force = np.minimum(time, 4.0 - time) * 0.6 + 1e-3
    press = QuasiStaticPress(law, physics)
    trace = drive_by_force(press, time, force, 1e-3)
    np.testing.assert_allclose(trace.force, force, atol=1e-10)
    np.testing.assert_allclose(press.force(time, trace.depth), force, atol=1e-10)


def test_driven_by_force_a_relaxing_body_creeps():
    g, tau = 0.4, 0.7
    time = np.concatenate([[1e-9], np.linspace(0.1, 4.0, 14)])
    press = QuasiStaticPress(law, Physics(relaxation=Prony((g,), (tau,))))
    depth = drive_by_force(press, time, np.ones(15), 1e-3).depth
    expected = (1 / (1 - g) - g / (1 - g) * np.exp(-time * (1 - g) / tau)) / 500.0
    np.testing.assert_allclose(depth[1:], expected[1:], rtol=5e-3)


def test_cannot_be_pulled_more_than_it_holds():
    with pytest.raises(WaveError, match=r"value\[1\] = -0.2 N .* 0.1 N"):
        drive_by_force(QuasiStaticPress(law, EVERYTHING), np.array([1.0, 2.0]), np.array([0.5, -0.2]), 1e-3)


def test_a_force_beyond_the_law_is_refused():
    with pytest.raises(WaveError, match="8 mm"):
        drive_by_force(QuasiStaticPress(law), np.array([1.0]), np.array([50.0]), 1e-3)
