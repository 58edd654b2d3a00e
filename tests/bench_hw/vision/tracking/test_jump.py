"""The jump that cannot be linked."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.tracking.jump import JumpError, refuse_jump, rigid_jump

SPACING = 50.0
GRID = np.stack(np.meshgrid(np.arange(6.0), np.arange(3.0)), axis=-1).reshape(-1, 2) * SPACING
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
