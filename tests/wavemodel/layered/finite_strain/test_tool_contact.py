import numpy as np
import pytest

from wavemodel import DiscTool
from wavemodel.layered.body_options import contact_of
from wavemodel.layered.finite_strain.equilibrium import ModalEquilibrium
from wavemodel.layered.finite_strain.modal_body import StackBody, disc_modes, thickness_of
from wavemodel.layered.press import prepare
from wavemodel.layered.window import WaveDiscretisation


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_the_linear_answer_is_that_of_the_wave(skin, contact):
    disc = DiscTool(5e-3, contact)
    press = prepare(skin(), disc, "bonded", WaveDiscretisation())
    body = StackBody(disc_modes(0.75 * press.field.domain.width, 16.0 / 5e-3), thickness_of(press.stack))
    tool = contact_of(press, disc, body)
    answer = ModalEquilibrium(body, tool).linear
    assert tool.compliance == pytest.approx(press.compliance, rel=6e-3)  # a wall here, a clamped border there
    assert tool.state(answer, 1.0).depth == tool.compliance
    rest = body.state(np.zeros_like(answer))
    pushed = body.force_change(rest, answer) + tool.state(answer, 1.0).change(answer)
    np.testing.assert_allclose(pushed, tool.load, atol=2e-3 * np.abs(tool.load).max())


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_the_forces_are_the_slope_of_the_potential(skin, contact):
    disc = DiscTool(5e-3, contact)
    press = prepare(skin(), disc, "bonded", WaveDiscretisation())
    body = StackBody(disc_modes(0.75 * press.field.domain.width, 8.0 / 5e-3), thickness_of(press.stack))
    tool, rng = contact_of(press, disc, body), np.random.default_rng(1)
    amplitude, change = 1e-4 * rng.normal(size=(2, *tool.load.shape))
    forth, back = (tool.state(amplitude + sign * 1e-3 * change, 0.7) for sign in (1.0, -1.0))
    power = (tool.state(amplitude, 0.7).forces * change).sum()
    assert power == pytest.approx((forth.potential - back.potential) / 2e-3, rel=1e-6)
