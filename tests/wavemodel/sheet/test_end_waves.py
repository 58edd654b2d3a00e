import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.sheet.end_waves import strip

UNIT = [WaveLayer("strip", 1.0, 1.0, 1.0, 0.3)]
FACES = np.array([-0.5, 0.5])


@pytest.mark.parametrize("corner", ["top", "bottom"])
def test_slowest_end_effect_of_a_free_strip_is_papkovich_s(corner):
    """Root of sin(x) + x = 0: s h = 4.2124 + 2.2507 i (Timoshenko and Goodier, Theory of elasticity, section 26)."""
    through = strip(UNIT, FACES, corner)
    roots, _ = through.end_waves(np.arange(2 * through.z.size), 3)
    slowest = roots[np.argmin(roots.real)]
    assert slowest.real == pytest.approx(4.2124, rel=4e-3)
    assert abs(slowest.imag) == pytest.approx(2.2507, rel=2e-2)


def test_waves_fulfil_their_equation():
    through = strip(UNIT, FACES, "top")
    free = np.arange(2, 2 * through.z.size)
    roots, shapes = through.end_waves(free, 0)
    skew = through.mixed.T - through.mixed
    left = through.along @ shapes * roots**2 + skew @ shapes * roots - through.across @ shapes
    slow = roots.real < 20.0
    size = np.abs(through.along @ shapes * roots**2).max(axis=0)
    assert np.abs(left[free]).max(axis=0)[slow].max() < 1e-6 * size[slow].max()
    assert (roots.real > 0.0).all()


def test_plate_s_own_solutions_carry_unit_resultants():
    through = strip(UNIT, FACES, "top")
    p0, p1, _, _, i0, _ = through.chain
    works = through.resultant_weights @ np.stack([i0, -p1, p0], axis=-1)
    np.testing.assert_allclose(works, np.eye(3), atol=1e-9)


def test_sublayers_meet_the_faces_and_are_fine_at_the_corner():
    layers = [WaveLayer("a", 0.1, 1.0, 1.0, 0.3), WaveLayer("b", 0.9, 1.0, 0.1, 0.4)]
    faces = np.array([-0.2, -0.1, 0.8])
    for corner, fine in (("top", 0), ("bottom", -1)):
        through = strip(layers, faces, corner)
        np.testing.assert_allclose(through.z[through.nodes(faces)], faces, atol=1e-12)
        sizes = np.diff(through.z[::2])
        assert sizes[fine] == sizes.min()
        assert sizes[fine] < 0.03
