"""Points to rows and columns."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.markers.lattice import arrange, neighbour_distance


def grid(rows: int, columns: int, spacing: float = 50.0) -> np.ndarray:
    y, x = np.mgrid[:rows, :columns]
    return np.stack([x.ravel(), y.ravel()], axis=1) * spacing


@given(
    st.integers(2, 5),
    st.integers(2, 7),
    st.floats(-0.6, 0.6),
    st.integers(0, 2**32 - 1),
)
def test_a_turned_shaken_shuffled_grid_is_put_in_order(rows, columns, turn, seed):
    random = np.random.default_rng(seed)
    turned = grid(rows, columns) @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    order = random.permutation(rows * columns)
    index = arrange((turned + random.uniform(-4, 4, turned.shape))[order])
    assert np.array_equal(index[np.argsort(order)], np.stack(np.divmod(np.arange(rows * columns), columns), axis=1))


def test_a_bent_grid_is_followed_from_neighbour_to_neighbour():
    points = grid(5, 9)
    middle = points.mean(axis=0)
    bent = middle + (points - middle) * (1 + 4e-6 * ((points - middle) ** 2).sum(axis=1, keepdims=True))
    bent[:, 1] += 1e-3 * (bent[:, 0] - middle[0]) ** 2
    assert np.array_equal(arrange(bent), np.stack(np.divmod(np.arange(45), 9), axis=1))


def test_strays_stay_outside_and_holes_stay_holes():
    points = grid(3, 6)
    index = arrange(np.vstack([points, [[-120.0, 75.0], [125.0, 25.0]]]))
    assert (index[-2:] == -1).all()
    assert len({tuple(place) for place in index[:-2].tolist()}) == 18
    kept = np.delete(np.arange(18), 8)
    assert np.array_equal(arrange(points[kept]), np.stack(np.divmod(kept, 6), axis=1))


def test_too_few_points_are_no_grid():
    assert arrange(np.zeros((0, 2))).shape == (0, 2)
    assert arrange(np.zeros((1, 2))).tolist() == [[-1, -1]]
    assert neighbour_distance(np.zeros((1, 2))) == np.inf
    assert neighbour_distance(grid(3, 6)) == pytest.approx(50.0)
