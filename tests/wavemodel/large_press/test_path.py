import numpy as np

from wavemodel.large_press.contact import PressureContact
from wavemodel.large_press.equilibrium import Equilibrium
from wavemodel.large_press.path import SPACING, follow
from wavemodel.loads.uniform import UniformPressure


def test_goes_from_no_load_to_the_reach_in_even_steps(small_body):
    path = follow(Equilibrium(small_body, PressureContact(small_body, UniformPressure(4e-3))), 6e-3, 1.5e-3)
    assert path.force[0] == path.depth[0] == 0.0
    assert path.depth[-2] < 1.5e-3 <= path.depth[-1]
    assert np.all(np.diff(path.force) > 0.0)
    np.testing.assert_allclose(np.diff(path.depth), SPACING * 6e-3, rtol=0.5)
    np.testing.assert_allclose(path.deflection[:, 0].sum(axis=1), path.depth, rtol=1e-12)


def test_ends_before_a_soft_block_sinks_in(small_body):
    """A small tool with uniform pressure on the softer layer has a largest force."""
    path = follow(Equilibrium(small_body, PressureContact(small_body, UniformPressure(1.2e-3))), 6e-3, 6e-3)
    assert path.depth[-1] < 6e-3
