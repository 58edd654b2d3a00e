import numpy as np
import pytest

from wavemodel.domains.rectangle import Rectangle
from wavemodel.layers.laminate import laminate
from wavemodel.loads.rigid import punch_tractions
from wavemodel.parts import parts
from wavemodel.remainder import remainder
from wavemodel.taper import Taper


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
