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
    press = prepare(skin(), DiscTool(5e-3, contact), "bonded", WaveDiscretisation())
    body = StackBody(disc_modes(0.75 * press.field.domain.width, 16.0 / 5e-3), thickness_of(press.stack))
    tool = contact_of(press, body)
    answer = ModalEquilibrium(body, tool).answer(tool.load)
    assert tool.depth(answer, 1.0) == pytest.approx(press.compliance, rel=6e-3)  # a wall here, a clamped border there
    rest = body.state(np.zeros_like(answer))
    pushed = body.force_change(rest, answer) + tool.held(answer)
    np.testing.assert_allclose(pushed, tool.load, atol=2e-3 * np.abs(tool.load).max())
