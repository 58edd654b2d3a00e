import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.layered.stack.laminate import laminate


def test_sublayers_keep_the_layer_and_its_thickness(skin):
    stack = laminate(skin(), [(1.0,), (0.5, 0.5), (0.25, 0.25, 0.5)], "bonded")
    assert stack.top_of_layer.tolist() == [0, 1, 3]
    assert stack.thickness.tolist() == pytest.approx([0.1e-3, 0.75e-3, 0.75e-3, 2.5e-3, 2.5e-3, 5e-3])
    assert stack.height == pytest.approx(11.6e-3)
    np.testing.assert_array_equal(stack.density, [1150, 1116, 1116, 971, 971, 971])


@pytest.mark.parametrize(("base", "unknowns"), [("bonded", 12), ("free", 14)])
def test_three_layers_have_twelve_unknowns_a_mode_and_two_more_with_a_free_lower_face(skin, base, unknowns):
    assert laminate(skin(), [(1.0,)] * 3, base).unknowns_per_mode == unknowns


def test_refuses_no_layers_and_an_unknown_base(skin):
    with pytest.raises(WaveError, match="at least one"):
        laminate([], [], "bonded")
    with pytest.raises(WaveError, match="'floating'"):
        laminate(skin(), [(1.0,)] * 3, "floating")
