import numpy as np
import pytest

from wavemodel import DiscTool, WaveError, WaveLayer


def test_moduli_follow_from_youngs_modulus_and_poissons_ratio():
    layer = WaveLayer("gel", 1e-3, 1000.0, 3e4, 0.25)
    assert layer.shear_modulus == pytest.approx(1.2e4)
    assert layer.lame_modulus == pytest.approx(1.2e4)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((0.0, 1000.0, 1e4, 0.4), "'gel': thickness = 0 m"),
        ((-1e-3, 1000.0, 1e4, 0.4), "thickness"),
        ((1e-3, 0.0, 1e4, 0.4), "density = 0 kg/m3"),
        ((1e-3, 1000.0, float("nan"), 0.4), "youngs_modulus = nan Pa"),
        ((1e-3, 1000.0, 1e4, 0.5), "poisson_ratio = 0.5"),
        ((1e-3, 1000.0, 1e4, -1.0), "poisson_ratio = -1"),
    ],
)
def test_refuses_layers_that_cannot_be(values, message):
    with pytest.raises(WaveError, match=message):
        WaveLayer("gel", *values)


def test_refuses_tools_that_cannot_be():
    with pytest.raises(WaveError, match="tool radius = 0 m"):
        DiscTool(0.0)
    with pytest.raises(WaveError, match="tool radius = 1e-09 m is not allowed: at least 1e-06 m"):
        DiscTool(1e-9)
    assert DiscTool(1e-6).radius == 1e-6
    with pytest.raises(WaveError, match=r"'glued'.*rigid_bonded"):
        DiscTool(1e-3, "glued")


def test_rigid_contacts_are_told_from_pressure():
    assert not DiscTool(1e-3).rigid
    assert DiscTool(1e-3, "rigid_bonded").rigid


class Stiff:
    def tangent(self, gradient):
        return 2.0e4 * np.eye(5).reshape(5, 5, *(1,) * (gradient.ndim - 1))


def test_refuses_a_law_that_is_not_as_stiff_at_rest_as_its_moduli():
    assert WaveLayer("gel", 1e-3, 1000.0, 5.6e4, 0.4, Stiff()).law is not None
    with pytest.raises(WaveError, match=r"'gel': law = Stiff has a shear modulus of 20000 Pa at rest.*give 10000 Pa"):
        WaveLayer("gel", 1e-3, 1000.0, 2.8e4, 0.4, Stiff())
