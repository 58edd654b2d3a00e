"""Table 1 of the article, its way and the sound way."""

import numpy as np
import pytest
from scipy.integrate import dblquad

from bench_hw.errors import InputError
from bench_hw.vision.displacement import (
    fit_circles,
    inner_nine,
    moving_average,
    published_variables,
    side_by_side,
    sound_variables,
)
from bench_hw.vision.displacement.table_1 import evaluate

PAPER_O, PAPER_P = (-8.393e-6, 0.002, 1.3322), (-8.1904e-6, 0.002, 0.9876)
D, A = 14.3321, 23.6053
GRID = np.stack(np.meshgrid(np.arange(6.0) - 2.5, np.arange(3.0) - 1.0), axis=-1).reshape(-1, 2) * 8e-3


def test_the_printed_lambda_agrees_and_the_printed_b_follows_only_from_the_wrong_sine():
    found = evaluate(PAPER_O, PAPER_P, D, A)
    assert found.wave_number == pytest.approx(1.7409, abs=1e-4)
    assert found.amplitude == pytest.approx(31.7788, abs=1e-4)
    assert found.amplitude_as_printed == pytest.approx(39.2012, abs=1e-4)


def test_b_is_the_integral_of_equation_3():
    def product(y, x):
        return D * np.polyval(PAPER_O, x) * np.polyval(PAPER_P, y) * np.sin(np.pi * x / A)

    right = dblquad(lambda y, x: product(y, x) * np.sin(np.pi * y / A), 0, A, 0, A)[0]
    wrong = dblquad(lambda y, x: product(y, x) * np.sin(np.pi * x / A), 0, A, 0, A)[0]
    found = evaluate(PAPER_O, PAPER_P, D, A)
    assert found.amplitude == pytest.approx(4 / A**2 * right)
    assert found.amplitude_as_printed == pytest.approx(4 / A**2 * wrong)


def sheet(depth: float, a: float, b: float, thickness: float, grid: np.ndarray = GRID) -> np.ndarray:
    """How far markers under a parabolic deflection over a window a x b move: -(h / 2) times its slope."""
    x, y = grid.T
    o, p = 1 - 4 * x**2 / a**2, 1 - 4 * y**2 / b**2
    return 4 * thickness * depth * np.stack([x * p / a**2, y * o / b**2], axis=1)


def test_the_sound_way_finds_window_depth_and_frequency():
    moved = sheet(2e-3, 50e-3, 46e-3, 4e-3)
    nine = inner_nine(GRID, 3, 6).nine
    found = sound_variables(GRID[nine], moved[nine], 10e-3, 2e-3, speed=9.25, thickness=4e-3)
    assert (found.a, found.b) == pytest.approx((50e-3, 46e-3), rel=1e-6)
    assert found.d == 2e-3
    assert found.wave_number == pytest.approx(9.25 * np.pi * np.hypot(1 / 50e-3, 1 / 46e-3))
    x = np.linspace(0, found.a, 101)
    assert np.polyval(found.o, x).max() == pytest.approx(1.0)
    assert np.polyval(found.o, [0, found.a]) == pytest.approx([0, 0], abs=1e-12)

    def product(y, x):
        shape = np.polyval(found.o, x) * np.polyval(found.p, y)
        return shape * np.sin(np.pi * x / found.a) * np.sin(np.pi * y / found.b)

    right = dblquad(product, 0, found.a, 0, found.b)[0]
    assert found.amplitude == pytest.approx(4 / (found.a * found.b) * found.d * right)


def test_without_the_thickness_the_window_is_the_largest_circle_as_in_the_paper():
    found = sound_variables(GRID, np.zeros((18, 2)), 11.8e-3, 2e-3, speed=9.25)
    assert found.a == found.b == pytest.approx(23.6e-3)


def test_both_ways_from_one_press_side_by_side():
    """A press of 2 mm over 120 frames beside the middle: the paper's B is no depth, the sound one is 1.065 of it."""
    grid = GRID + np.array([3e-3, 2e-3])
    frames = np.arange(120)
    depth = 2e-3 * (1 - ((frames - 60) / 60) ** 2)
    places = grid + np.array([sheet(d, 50e-3, 50e-3, 4e-3, grid) for d in depth])
    nine = inner_nine(grid, 3, 6).nine
    moved = moving_average(places - grid, 10, "causal")[:, nine]
    radius = fit_circles(places[:, nine]).radius
    frame = int(np.argmax(radius))
    paper = published_variables(moved, radius, depth)
    sound = sound_variables(grid[nine], places[frame, nine] - grid[nine], radius[frame], depth[frame], 9.25, 4e-3)
    assert paper.a == pytest.approx(2e3 * radius.max())
    assert paper.d * np.polyval(paper.o, frame) * np.polyval(paper.p, frame) == pytest.approx(2.0, rel=1e-3)
    assert sound.amplitude == pytest.approx(1.0651 * 2e-3, rel=1e-3)
    assert (sound.a, sound.b) == pytest.approx((50e-3, 50e-3), rel=1e-3)
    rows = side_by_side(paper, sound)
    names = [row["variable"] for row in rows]
    assert names == ["O(x)", "p(y)", "d", "a", "b", "c", "lambda_11", "B_11", "B_11 as printed"]
    assert all(row["paper_unit"] for row in rows)
    assert rows[2]["sound"] == sound.d


def test_motions_that_cancel_leave_the_papers_d_without_bounds():
    depth = np.full(8, 2e-3)
    paper = published_variables(np.zeros((8, 9, 2)), np.full(8, 0.01), depth)
    assert paper.d == np.inf
    assert np.isnan(paper.amplitude)


def test_what_is_no_press_is_refused():
    with pytest.raises(InputError, match="radius = -1 m; allowed: more than 0"):
        sound_variables(GRID, np.zeros((18, 2)), -1.0, 2e-3, 9.25)
    with pytest.raises(InputError, match="do not move outwards"):
        sound_variables(GRID, -sheet(2e-3, 50e-3, 50e-3, 4e-3), 0.01, 2e-3, 9.25, 4e-3)
    with pytest.raises(InputError, match="no frame has a circle"):
        published_variables(np.zeros((5, 9, 2)), np.full(5, np.nan), np.zeros(5))


def test_a_film_in_which_nothing_moves_is_refused() -> None:
    with pytest.raises(InputError, match="in no frame of the film did the markers move"):
        published_variables(np.zeros((0, 9, 2)), np.zeros(0), np.zeros(0))
