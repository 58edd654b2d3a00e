import numpy as np
import pytest

from wavemodel import DiscTool
from wavemodel.press import prepare
from wavemodel.settings import Settings


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_frictionless"])
def test_the_static_answer_hangs_together(skin, contact):
    press = prepare(skin(), DiscTool(5e-3, contact), "bonded", Settings())
    weight = press.field.domain.axis_weight
    np.testing.assert_allclose(press.unit @ weight + press.remainder_axis, press.unit_axis)
    assert press.unit_axis[0] == pytest.approx(press.compliance, rel=1e-3)
    assert press.sublayer_error <= 5e-4
    assert press.border_cost == 0.0


def test_a_chosen_window_is_priced(skin):
    press = prepare(skin(), DiscTool(5e-3), "bonded", Settings(window=36e-3))
    assert 0.02 < press.border_cost < 0.06


def test_the_modes_load_is_one_at_long_waves(skin):
    press = prepare(skin(), DiscTool(5e-3, "rigid_bonded"), "bonded", Settings(window=0.4, modes=8))
    np.testing.assert_allclose(press.load[0, 1], 1.0, atol=2e-3)
    assert abs(press.load[0, 0]) < 1e-2
