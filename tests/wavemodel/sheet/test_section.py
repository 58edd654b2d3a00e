import pytest

from wavemodel import WaveError, WaveLayer
from wavemodel.sheet.section import section


def test_one_layer_is_the_plate_of_the_textbook():
    across = section([WaveLayer("sheet", 2e-3, 1000.0, 1e5, 0.3)])
    assert across.membrane == pytest.approx(1e5 * 2e-3 / (1 - 0.09))
    assert across.bending == pytest.approx(1e5 * 8e-9 / 12 / (1 - 0.09))
    assert across.shear == pytest.approx(5 / 6 * 1e5 / 2.6 * 2e-3)
    assert across.faces == pytest.approx([-1e-3, 1e-3])
    assert (across.mass, across.rotary_inertia) == pytest.approx((2.0, 1000 * 8e-9 / 12))
    assert across.thinning == pytest.approx(0.3 / 0.7)
    assert across.poisson_ratio == pytest.approx(0.3)


def test_cutting_a_layer_in_two_changes_nothing():
    whole = section([WaveLayer("sheet", 2e-3, 1000.0, 1e5, 0.3)])
    cut = section([WaveLayer("a", 0.5e-3, 1000.0, 1e5, 0.3), WaveLayer("b", 1.5e-3, 1000.0, 1e5, 0.3)])
    for name in ("membrane", "bending", "shear", "mass", "rotary_inertia"):
        assert getattr(cut, name) == pytest.approx(getattr(whole, name))


def test_neutral_plane_lies_in_the_stiff_layer():
    """Moduli 9 to 1: the plane is the mean of the middles with these weights."""
    across = section([WaveLayer("stiff", 1e-3, 1000.0, 9e5, 0.4), WaveLayer("soft", 1e-3, 1000.0, 1e5, 0.4)])
    assert across.faces[0] == pytest.approx(-(0.9 * 0.5e-3 + 0.1 * 1.5e-3))


def test_sandwich_shears_in_its_core():
    """G (d + t^2 / 3d)^2 / c with faces t apart by d: the bending stiffness over the faces' couple, squared."""
    face = WaveLayer("face", 1e-3, 1000.0, 1e7, 0.3)
    core = WaveLayer("core", 1e-3, 1000.0, 1e4, 0.3)
    couple = 2e-3 + 1e-6 / 6e-3
    assert section([face, core, face]).shear == pytest.approx(core.shear_modulus * couple**2 / 1e-3, rel=5e-3)


def test_needs_a_layer():
    with pytest.raises(WaveError, match="at least one"):
        section([])
