"""Boards as text."""

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.calibration import Board, parse_corners
from bench_hw.vision.calibration.board import look_for_board, read_picture


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


@pytest.fixture(scope="module")
def pose(boards):
    return boards.Pose((0.3, -0.25, 0.1), (5.0, -4.0, 120.0))


@pytest.fixture(scope="module")
def picture(boards, lens, pose):
    def paint(seed: int = 0, **options):
        return boards.board(lens, pose, np.random.default_rng(seed), **options)

    return paint


def test_corners_are_found_to_a_twentieth_of_a_pixel(picture, board, pose, seen_corners):
    view = look_for_board(picture(), board, "view.png")
    (truth,) = seen_corners([pose], noise=0.0)
    error = min(np.sqrt(((view.corners - t) ** 2).sum(axis=1).mean()) for t in (truth, truth[::-1]))
    assert view.reason == ""
    assert error < 0.06


@pytest.mark.parametrize("blur", [4.0, 12.0])
def test_a_blurred_picture_is_called_blurred(picture, board, blur):
    view = look_for_board(picture(blur=blur), board, "view.png")
    assert view.corners is None
    assert view.reason.startswith("blurred (edges ")


def test_another_board_is_named(picture):
    assert look_for_board(picture(), Board(8, 5, 8e-3), "view.png").reason == "a board with 9x6 inner corners"
    assert look_for_board(picture(), Board(10, 7, 8e-3), "view.png").reason == "a board with 9x6 inner corners"


def test_poor_contrast_and_nothing_at_all_are_named(picture, board):
    grey = picture()
    faint = (200 + (grey.astype(float) - 200) * 0.08).astype(np.uint8)
    assert look_for_board(faint, board, "view.png").corners is None
    nothing = np.random.default_rng(0).normal(200, 3, grey.shape).astype(np.uint8)
    assert look_for_board(nothing, board, "view.png").reason == "no board"


def test_what_is_no_picture_is_refused(tmp_path):
    text, empty = tmp_path / "text.png", tmp_path / "empty.png"
    text.write_text("no picture")
    empty.write_bytes(b"")
    for path in (text, empty):
        with pytest.raises(InputError, match="no picture"):
            read_picture(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_picture(tmp_path / "none.png")
    cv2.imwrite(str(text), np.dstack([np.full((20, 30), 7, np.uint8)] * 3))
    assert read_picture(text).shape == (20, 30)
