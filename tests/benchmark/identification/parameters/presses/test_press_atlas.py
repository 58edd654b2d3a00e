"""Presses put together: met with value and slope where they are, and closer in between than any one of them."""

import numpy as np
import pytest

from benchmark.identification.parameters.presses.press_atlas import NEAR, PressAtlas
from benchmark.identification.parameters.presses.press_surrogate import PressSurrogate

DEPTH = np.linspace(0.0, 2e-3, 30)
WEIGHTS = np.stack([0.2 + 0.3 * DEPTH / 2e-3, 0.5 - 0.2 * DEPTH / 2e-3, 0.3 - 0.1 * DEPTH / 2e-3])


def press(at: np.ndarray) -> PressSurrogate:
    """Layers in series: 1 / F is a sum over layers; the last coordinate is one on which the logarithm is straight."""
    soft = WEIGHTS * np.exp(-at[:3, None])
    force = 1e3 * DEPTH / soft.sum(axis=0) * np.exp(at[3])
    return PressSurrogate(DEPTH, force, np.vstack([soft / soft.sum(axis=0), np.ones(DEPTH.size)]), {}, at)


def atlas(points) -> PressAtlas:
    out = PressAtlas((press(points[0]),), np.arange(3))
    for point in points[1:]:
        out = out.with_press(press(point))
    return out


POINTS = [np.array(each) for each in ([0, 0, 0, 0.0], [1.0, -0.5, 0, 0], [-0.8, 0.6, 0.2, 0], [0.3, 0.2, -0.9, 0.1])]
BETWEEN = np.array([0.5, -0.2, -0.3, 0.05])


def apart(table, point) -> float:
    return float(np.abs(np.log(table.force_at(point)[1:] / press(point).force[1:])).max())


def test_it_meets_every_press_with_value_and_slope() -> None:
    table = atlas(POINTS)
    for point in POINTS:
        assert apart(table, point) < 1e-6
        np.testing.assert_allclose(table.by_at(point)[:, 1:], press(point).by[:, 1:], atol=1e-5)


def test_slopes_are_those_of_its_forces() -> None:
    table, step = atlas(POINTS), 1e-5
    slopes = table.by_at(BETWEEN)
    for k in range(4):
        move = step * np.eye(4)[k]
        more, less = (np.log(table.force_at(BETWEEN + sign * move)[1:]) for sign in (1.0, -1.0))
        np.testing.assert_allclose((more - less) / (2.0 * step), slopes[k, 1:], atol=1e-7)


def test_more_presses_come_closer_in_between() -> None:
    first, few, many = (atlas(POINTS[:count]) for count in (1, 2, 4))
    assert apart(first, BETWEEN) > 3.0 * apart(few, BETWEEN)
    assert apart(few, BETWEEN) > 2.0 * apart(many, BETWEEN)


def test_far_away_first_order_round_the_newest_press_is_left() -> None:
    table, far = atlas(POINTS), np.array([40.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(table.force_at(far), table.newest.force_at(far), rtol=1e-9)


def test_a_press_takes_the_place_of_one_where_it_stands() -> None:
    table = atlas(POINTS).with_press(press(POINTS[1] + 0.5 * NEAR))
    assert len(table.presses) == len(POINTS)
    assert table.away(POINTS[1]) == pytest.approx(0.5 * NEAR * np.sqrt(3.0))
