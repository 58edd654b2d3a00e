"""Boards as text."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.calibration import Board, parse_corners


def test_corners_are_columns_by_rows_around_the_middle():
    board = parse_corners("9x6", 8e-3)
    assert board == Board(9, 6, 8e-3)
    assert board.points.shape == (54, 2)
    assert np.allclose(board.points.mean(axis=0), 0.0)
    assert np.allclose(board.points[1] - board.points[0], [8e-3, 0])
    assert np.allclose(board.points[9] - board.points[0], [0, 8e-3])


@pytest.mark.parametrize(
    ("text", "square"),
    [("", 8e-3), ("9", 8e-3), ("9x", 8e-3), ("2x6", 8e-3), ("9x600", 8e-3), ("9x6", 0.0), ("9x6", -1)],
)
def test_other_boards_are_refused(text, square):
    with pytest.raises(InputError, match="allowed"):
        parse_corners(text, square)
    with pytest.raises(InputError, match="allowed"):
        parse_corners("9x6", float("nan"))
