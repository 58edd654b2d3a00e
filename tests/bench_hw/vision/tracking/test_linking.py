"""Which spot is which marker."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.markers.grid import Sighting
from bench_hw.vision.tracking.linking import (
    GATE,
    Absences,
    JumpError,
    Neighbours,
    doubles,
    link,
    refuse_jump,
    rigid_jump,
)

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


RIGHT = np.array([50.0, 0.0])
way = st.tuples(st.floats(0, 2 * np.pi), st.floats(0.0, 2.0))


def shift(angle: float, share: float) -> np.ndarray:
    return share * SPACING * np.array([np.cos(angle), np.sin(angle)])


@given(way, st.integers(0, 2**32 - 1))
def test_half_the_spacing_or_more_is_a_jump_and_less_is_none(move, seed):
    random = np.random.default_rng(seed)
    spots = random.permutation(GRID + shift(*move) + random.uniform(-1, 1, GRID.shape))
    found = rigid_jump(GRID, spots, SPACING)
    if move[1] >= 0.53:
        assert np.hypot(*(found - shift(*move))) < 1.5
    elif move[1] <= 0.45:
        assert found is None


@pytest.mark.parametrize("gone", [[0, 6, 12], [5, 11, 17], list(range(6)), [7, 8, 9]])
def test_covered_markers_are_no_jump(gone):
    assert rigid_jump(GRID, np.delete(GRID, gone, axis=0), SPACING) is None


def test_markers_that_left_at_the_border_are_no_jump():
    """Three columns piled up where they were last seen; the others went on by a spacing and a half."""
    last = GRID.copy()
    last[:, 0] = np.minimum(last[:, 0], 3 * SPACING)
    assert rigid_jump(last, last[last[:, 0] < 3 * SPACING], SPACING) is None


def test_too_few_spots_tell_nothing():
    assert rigid_jump(GRID, GRID[:9] + RIGHT, SPACING) is None
    assert rigid_jump(GRID, np.zeros((0, 2)), SPACING) is None


def test_the_refusal_says_how_far_and_what_is_allowed():
    with pytest.raises(JumpError, match=r"jumped by \(50.0, 0.0\) px.*1.00 of the marker spacing.*allowed: less than"):
        refuse_jump(GRID, GRID + RIGHT, SPACING)
    refuse_jump(GRID, GRID + 0.4 * RIGHT, SPACING)


PIXEL_GRID = np.stack(np.meshgrid(np.arange(6.0), np.arange(3.0)), axis=-1).reshape(-1, 2) * 50.0


def sighting_of(places: np.ndarray, hidden=()) -> Sighting:
    seen = np.ones(18, dtype=bool)
    seen[list(hidden)] = False
    return Sighting(places / 600, places, np.full(18, 10.0), np.ones(18)).kept(seen)


@pytest.mark.parametrize(("came_back_to", "accepted"), [((40.0, 3.0), True), ((0.0, 0.0), False), ((90.0, 0.0), False)])
def test_a_marker_must_have_moved_as_its_neighbours_did(came_back_to, accepted):
    """While marker 8 was away the sheet went 40 to the right."""
    absences = Absences(limit=24.5)
    absences.note(sighting_of(PIXEL_GRID, hidden=[8]), PIXEL_GRID)
    later = PIXEL_GRID + np.array([40.0, 0.0])
    later[8] = PIXEL_GRID[8] + came_back_to
    assert absences.checked(sighting_of(later)).seen[8] == accepted
    assert absences.checked(sighting_of(later)).seen.sum() == 17 + accepted


def test_without_witnesses_the_place_alone_counts():
    absences = Absences(limit=24.5)
    absences.note(sighting_of(PIXEL_GRID, hidden=range(18)), PIXEL_GRID)
    assert absences.checked(sighting_of(PIXEL_GRID + 5.0)).seen.all()


def test_who_is_back_is_away_no_more():
    absences = Absences(limit=24.5)
    absences.note(sighting_of(PIXEL_GRID, hidden=[8]), PIXEL_GRID)
    absences.note(sighting_of(PIXEL_GRID), PIXEL_GRID)
    later = PIXEL_GRID.copy()
    later[8] += 60.0
    assert absences.checked(sighting_of(later)).seen.all()


def pressed(share: float) -> np.ndarray:
    """The sheet drawn out by two fifths of a share along x, and narrowed."""
    middle = PIXEL_GRID.mean(axis=0)
    return middle + (PIXEL_GRID - middle) * [1.0 + 0.4 * share, 1.0 - 0.15 * share]


def drawn(share: float) -> np.ndarray:
    """What that does to discs: (a - b) / (a + b)."""
    a, b = 1.0 + 0.4 * share, 1.0 - 0.15 * share
    return np.full(18, (a - b) / (a + b), dtype=np.complex128)


def test_a_sheet_that_strains_is_like_itself_and_a_blob_grown_together_with_a_marker_is_not():
    neighbours = Neighbours(PIXEL_GRID, SPACING)
    for share in np.linspace(0.0, 1.0, 10):
        assert not np.any(neighbours.unlike(pressed(share), drawn(share)))
    merged = drawn(1.0)
    merged[8] += 0.12
    for _ in range(20):  # however long it stays
        way, stretch = neighbours.unlike(pressed(1.0), merged)
        assert stretch[8] > 0.04
        assert not way.any()
        assert not np.delete(stretch, 8).any()
    assert not np.any(neighbours.unlike(pressed(1.0), drawn(1.0)))


def test_a_marker_that_was_grown_together_with_something_at_first_is_taken_as_it_is_when_free():
    neighbours, merged = Neighbours(PIXEL_GRID, SPACING), drawn(0.0)
    merged[8] = 0.3j
    neighbours.unlike(PIXEL_GRID, merged)
    assert not np.any(neighbours.unlike(PIXEL_GRID, drawn(0.0)))


def test_a_marker_that_goes_where_no_neighbour_goes_is_another_spot():
    neighbours, now = Neighbours(PIXEL_GRID, SPACING), PIXEL_GRID + np.array([20.0, 0.0])
    assert not neighbours.strayed(now, PIXEL_GRID).any()
    now[8] = PIXEL_GRID[8]
    assert np.flatnonzero(neighbours.strayed(now, PIXEL_GRID)).tolist() == []  # it lags, but by less than allowed
    still = PIXEL_GRID.copy()
    still[8] += [0.38 * SPACING, 4.0]
    assert np.flatnonzero(neighbours.strayed(still, PIXEL_GRID)).tolist() == [8]


def test_a_marker_that_creeps_away_alone_is_doubted_by_its_way():
    neighbours, now = Neighbours(PIXEL_GRID, SPACING), PIXEL_GRID.copy()
    for _ in range(30):
        way, _ = neighbours.unlike(now, drawn(0.0))
        now[8, 0] += 1.5
    assert 30.0 < way[8] < 45.0


def test_of_a_single_row_no_strain_is_told():
    row = PIXEL_GRID[:6]
    neighbours = Neighbours(row, SPACING)
    assert not np.any(neighbours.unlike(row + np.array([[3.0, 5.0]]), np.zeros(6, dtype=np.complex128)))
    assert not neighbours.strayed(row + np.arange(6)[:, None] * 8.0, row).any()
