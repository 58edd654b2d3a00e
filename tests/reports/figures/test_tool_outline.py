import numpy as np
import pytest

from reports.figures import ToolShape


def test_a_flat_tool_is_a_rectangle_on_the_surface():
    corners = ToolShape(5.0).outline(4.0)
    assert sorted(map(tuple, corners)) == [(-5.0, -4.0), (-5.0, 0.0), (5.0, -4.0), (5.0, 0.0)]


def test_a_sphere_follows_its_circle():
    corners = ToolShape(5.0, 5.0).outline(5.0)
    assert np.hypot(corners[:, 0], corners[:, 1] + 5.0) == pytest.approx(5.0 * np.ones(len(corners)))
    assert corners[:, 1].max() == pytest.approx(0.0)


def test_a_rounded_edge_leaves_the_rest_flat():
    corners = ToolShape(5.0, 1.0).outline(4.0)
    touching = corners[np.isclose(corners[:, 1], 0.0), 0]
    assert (touching.min(), touching.max()) == pytest.approx((-4.0, 4.0))


def test_a_tilted_tool_touches_with_its_lowest_edge_and_keeps_its_size():
    upright, tilted = ToolShape(5.0).outline(4.0), ToolShape(5.0, tilt=0.2).outline(4.0)
    assert tilted[:, 1].max() == pytest.approx(0.0)
    assert np.sum(np.isclose(tilted[:, 1], 0.0)) == 1
    for a, b in ((0, 1), (1, 2), (2, 3)):
        assert np.linalg.norm(tilted[a] - tilted[b]) == pytest.approx(np.linalg.norm(upright[a] - upright[b]))


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        (ToolShape(5.0), "flat"),
        (ToolShape(5.0, 1.5), "flat, its edge rounded to 1.5 mm"),
        (ToolShape(5.0, 5.0), "spherical"),
        (ToolShape(5.0, 0.0, np.radians(12.0)), "flat, tilted by 12°"),
    ],
)
def test_the_shape_in_words(shape, words):
    assert shape.words == words
