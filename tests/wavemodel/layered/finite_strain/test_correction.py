import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, WaveError, WaveLayer

DEPTH = np.linspace(0.0, 4.0e-3, 60)


def law_of(skin, word):
    return LayeredWave(skin(), DiscTool(5e-3), large_press=word).law.large


@pytest.fixture(scope="module")
def law(skin):
    return law_of(skin, "corrected")


@pytest.fixture(scope="module")
def deep(skin):
    return law_of(skin, "deep")


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


def test_followed_deep_it_is_the_same_law_where_both_are(law, deep):
    np.testing.assert_allclose(deep.force_at(DEPTH), law.force_at(DEPTH), rtol=1e-4, atol=1e-12)


def test_beyond_its_path_the_law_is_a_smooth_straight_line(deep):
    end, deepest = deep.followed, deep.deepest
    depth = np.linspace(end, deepest, 5)
    force = deep.force_at(depth)
    np.testing.assert_allclose(np.diff(force), np.diff(force)[0], rtol=1e-9)
    np.testing.assert_allclose(deep.depth_at(force), depth, rtol=1e-12)
    np.testing.assert_allclose([deep.weights_at(f) for f in force.tolist()], deep.weights(force), atol=1e-15)
    before = (deep.force[-1] - deep.force_at(np.array(end - 1e-6))) / 1e-6
    assert (force[1] - force[0]) / (depth[1] - depth[0]) == pytest.approx(before, rel=1e-3)
    assert force[-1] == pytest.approx(deep.strongest)


def test_past_a_largest_force_the_law_still_rises():
    """A pressure on a thin stiff sheet: its path ends at 0.14 of the thickness, where the spline turns back."""
    sheet = WaveLayer("silicone", 4e-3, 1100.0, 4e5, 0.49)
    law = LayeredWave([sheet], DiscTool(5e-3), large_press="deep").law.large
    assert law.followed < 0.2 * 4e-3 < law.deepest
    force = law.force_at(np.linspace(0.0, law.deepest, 50))
    assert np.all(np.diff(force) > 0.0)
    assert law.strongest == pytest.approx(force[-1])
    assert law.strongest > law.force[-1]


@pytest.mark.parametrize("followed", ["law", "deep"])
def test_refuses_what_is_beyond_the_range(request, followed):
    law = request.getfixturevalue(followed)
    with pytest.raises(WaveError, match="beyond the range"):
        law.force_at(np.array([1e-3, 1.001 * law.deepest]))
    for call in (law.weights, law.weights_at):
        with pytest.raises(WaveError, match="beyond the range"):
            call(1.001 * law.strongest)
