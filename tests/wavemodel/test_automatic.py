import numpy as np
import pytest

from wavemodel.automatic import BORDER_COST, automatic_window, border_cost, enough_modes, far_field
from wavemodel.layers.laminate import laminate


def stack(layers):
    return laminate(layers, [(1.0,)] * len(layers), "bonded")


def test_far_field_is_the_endless_response(skin, oracle, uniform_load):
    distance = np.array([15e-3, 25e-3, 40e-3])
    reference = oracle(skin()).deflection(np.concatenate([[0.0], distance]), uniform_load(5e-3), 20e3, 45e-3)
    found = far_field(stack(skin()), 5e-3, distance)
    np.testing.assert_allclose(found, reference[:, 1:] / reference[:, :1], atol=1e-3)


@pytest.mark.parametrize("fat", [3e-3, 20e-3])
def test_the_window_grows_until_its_border_costs_little(skin, fat):
    whole = stack(skin(fat))
    side = automatic_window(whole, 5e-3)
    assert border_cost(whole, 5e-3, side) <= BORDER_COST * 1.001
    assert side >= 8 * 5e-3


def test_the_window_follows_the_stack_and_a_narrow_one_costs_more(skin):
    sides = [automatic_window(stack(skin(fat)), 2e-3) for fat in (5e-3, 10e-3, 20e-3)]
    assert sides[0] < sides[1] < sides[2]
    assert border_cost(stack(skin()), 5e-3, 24e-3) > 0.05


def test_modes_follow_window_and_tool_within_bounds():
    assert enough_modes(60e-3, 5e-3) == 46
    assert enough_modes(60e-3, 2.5e-3) == 92
    assert enough_modes(1.0, 1e-3) == 512
    assert enough_modes(10e-3, 5e-3) == 24
