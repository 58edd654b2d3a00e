import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, WaveError

DEPTH = np.linspace(0.0, 4.0e-3, 60)


@pytest.fixture(scope="module")
def law(skin):
    return LayeredWave(skin(), DiscTool(5e-3), large_press="corrected").press.field.large


def test_force_and_depth_are_inverse(law):
    np.testing.assert_allclose(law.depth_at(law.force_at(DEPTH)), DEPTH, atol=1e-16)
    assert law.force_at(np.array(-1e-3)) == pytest.approx(-1e-3 / law.compliance)


def test_small_presses_are_linear(law):
    assert law.force_at(np.array(1e-6)) * law.compliance == pytest.approx(1e-6, rel=1e-3)
    np.testing.assert_array_equal(law.weights(np.array([0.0, -1.0])), 0.0)


def test_one_weight_is_one_of_many(law):
    forces = np.linspace(-0.1, law.force[-1], 23)
    np.testing.assert_allclose([law.weights_at(f) for f in forces.tolist()], law.weights(forces), atol=1e-15)


def test_the_axis_is_the_field_at_no_radius(law):
    np.testing.assert_allclose(law.axis, law.at_radius(np.array([0.0, 1e-3]))[..., 0])
    np.testing.assert_allclose(law.axis[:, 0], law.depths, rtol=1e-9)


def test_nothing_in_it_is_calibrated(law):
    assert law.calibrated_on == ()


def test_refuses_what_is_beyond_the_range(law):
    with pytest.raises(WaveError, match="beyond the range"):
        law.force_at(np.array([1e-3, 1.001 * law.deepest]))
    for call in (law.weights, law.weights_at):
        with pytest.raises(WaveError, match="beyond the range"):
            call(1.001 * law.force[-1])
