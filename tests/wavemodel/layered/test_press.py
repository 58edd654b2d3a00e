import numpy as np
import pytest

from wavemodel import DiscTool
from wavemodel.domains.rectangle import Rectangle
from wavemodel.layered.press import parts, prepare
from wavemodel.layered.remainder import remainder
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.tractions import punch_tractions
from wavemodel.layered.window import Taper, WaveDiscretisation


@pytest.fixture
def made(skin):
    whole = laminate(skin(), [(1.0,)] * 3, "bonded")
    domain, taper = Rectangle(70e-3, 70e-3, 50), Taper(2.2e3)
    basis = punch_tractions(5e-3, "rigid_bonded", 12)
    return parts(whole, domain, basis, taper, remainder(whole, basis, taper, domain))


def test_flexibility_is_symmetric_and_positive(made):
    scale = np.sqrt(np.diag(made.flexibility))
    matrix = made.flexibility / np.outer(scale, scale)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12)
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_under_a_rigid_contact_every_function_works_as_on_a_rigid_motion(made):
    worked = made.flexibility @ made.contact(rigid=True).coefficients
    np.testing.assert_allclose(worked / worked[0], made.basis.net_force, atol=1e-9)


def test_without_a_remainder_the_modes_alone(skin):
    whole = laminate(skin(), [(1.0,)] * 3, "bonded")
    basis = punch_tractions(5e-3, "rigid_frictionless", 2)
    alone = parts(whole, Rectangle(70e-3, 70e-3, 50), basis, Taper(2.2e3, active=False), None)
    np.testing.assert_array_equal(alone.remainder_flexibility, 0.0)
    np.testing.assert_array_equal(alone.share, 1.0)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_frictionless"])
def test_the_static_answer_hangs_together(skin, contact):
    press = prepare(skin(), DiscTool(5e-3, contact), "bonded", WaveDiscretisation())
    weight = press.field.domain.axis_weight
    np.testing.assert_allclose(press.unit @ weight + press.remainder_axis, press.unit_axis)
    assert press.unit_axis[0] == pytest.approx(press.compliance, rel=1e-3)
    assert press.sublayer_error <= 5e-4
    assert press.border_cost == 0.0


def test_a_chosen_window_is_priced(skin):
    press = prepare(skin(), DiscTool(5e-3), "bonded", WaveDiscretisation(window=36e-3))
    assert 0.02 < press.border_cost < 0.06


def test_the_modes_load_is_one_at_long_waves(skin):
    press = prepare(skin(), DiscTool(5e-3, "rigid_bonded"), "bonded", WaveDiscretisation(window=0.4, modes=8))
    np.testing.assert_allclose(press.load[0, 1], 1.0, atol=2e-3)
    assert abs(press.load[0, 0]) < 1e-2
