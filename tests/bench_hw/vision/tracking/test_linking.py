"""Which spot is which marker."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.tracking.linking import GATE, doubles, link

SPACING = 50.0
GRID = np.stack(np.meshgrid(np.arange(6.0), np.arange(3.0)), axis=-1).reshape(-1, 2) * SPACING


@given(st.integers(0, 2**32 - 1), st.floats(0, 2 * np.pi), st.floats(0, 0.45))
def test_any_move_below_half_the_spacing_is_linked_right(seed, angle, share):
    random = np.random.default_rng(seed)
    moved = GRID + share * SPACING * np.array([np.cos(angle), np.sin(angle)])
    order = random.permutation(18)
    found = link(GRID, moved[order], GATE * SPACING)
    assert np.array_equal(order[found], np.arange(18))


@given(st.integers(0, 2**32 - 1), st.integers(0, 17))
def test_missing_and_foreign_spots_link_to_nobody(seed, gone):
    random = np.random.default_rng(seed)
    moved = GRID + random.uniform(-8, 8, GRID.shape)
    foreign = random.uniform(400, 500, (5, 2))
    spots = np.vstack([foreign, np.delete(moved, gone, axis=0)])
    found = link(GRID, spots, GATE * SPACING)
    assert found[gone] == -1
    assert np.allclose(spots[np.delete(found, gone)], np.delete(moved, gone, axis=0))


def test_nothing_to_link():
    assert link(GRID, np.zeros((0, 2)), 10.0).tolist() == [-1] * 18
    assert link(np.zeros((0, 2)), GRID, 10.0).tolist() == []


def test_the_neighbours_settle_a_conflict():
    """The sheet moved by 20 to the right; beside marker 8 a speck lies 12 to its left, nearer than the marker is."""
    moved = GRID + np.array([20.0, 0.0])
    spots = np.vstack([moved, GRID[8] - [12.0, 0.0]])
    assert np.array_equal(link(GRID, spots, GATE * SPACING), np.arange(18))


def test_two_markers_at_one_place_belong_to_the_one_that_was_nearer():
    places = GRID.copy()
    places[4] = places[5] + [0.5, 0.0]
    places[9] = np.nan
    wrong = doubles(places, GRID, 0.5 * SPACING)
    assert np.flatnonzero(wrong).tolist() == [4]
    assert not doubles(GRID, GRID, 0.5 * SPACING).any()
