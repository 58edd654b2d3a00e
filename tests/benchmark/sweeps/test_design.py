"""Which points are computed: grids in order, samples that cover, one set of points for one seed."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.sweeps.design import Design, chosen_design
from benchmark.sweeps.parameter import parse_parameter

TWO = (parse_parameter("d.e=50 kPa:500 kPa:3:log"), parse_parameter("tool.radius=2 mm,5 mm"))


def numbers(points) -> np.ndarray:
    return np.array([[each.number_of(text) for each, text in zip(TWO, point, strict=True)] for point in points])


def test_a_grid_is_every_combination_the_last_key_fastest() -> None:
    points = Design("grid", None, 0).choose(TWO)
    assert points[:3] == (("50 kPa", "2 mm"), ("50 kPa", "5 mm"), ("158.113883 kPa", "2 mm"))
    assert len(points) == len(set(points)) == 6


def test_a_latin_hypercube_has_one_point_in_each_slice() -> None:
    found = numbers(Design("lhs", 20, 1).choose(TWO))
    slices = np.floor(20 * np.log(found[:, 0] / 50) / np.log(10)).astype(int)
    assert sorted(slices) == list(range(20))
    assert (found[:, 1] == 2).sum() == 10


@pytest.mark.parametrize("count", [1, 7, 16, 100])
def test_a_sobol_sequence_of_any_length_begins_like_a_longer_one(count: int) -> None:
    assert Design("sobol", count, 1).choose(TWO) == Design("sobol", 128, 1).choose(TWO)[:count]


@pytest.mark.parametrize("kind", ["lhs", "sobol", "saltelli"])
def test_the_seed_decides(kind: str) -> None:
    assert Design(kind, 32, 4).choose(TWO) == Design(kind, 32, 4).choose(TWO)
    assert Design(kind, 32, 4).choose(TWO) != Design(kind, 32, 5).choose(TWO)


def test_options_make_the_design() -> None:
    assert chosen_design(None, None, False, 2, 3) == Design("grid", None, 3)
    assert chosen_design("lhs", 8, False, 2, 3) == Design("lhs", 8, 3)
    assert chosen_design("sobol", 8, False, 2, 3) == Design("sobol", 8, 3)
    assert chosen_design(None, None, True, 2, 3) == Design("saltelli", 256, 3)
    assert chosen_design("sobol", 40, True, 2, 3) == Design("saltelli", 40, 3)
    assert len(Design("saltelli", 40, 3).choose(TWO)) == 32


@pytest.mark.parametrize(
    ("sample", "points", "sensitivity", "word"),
    [
        (None, 8, False, "--sample"),
        ("lhs", None, False, "--points"),
        ("lhs", 64, True, "Sobol design"),
        (None, 31, True, "at least 32"),
    ],
)
def test_options_that_do_not_go_together(sample, points, sensitivity: bool, word: str) -> None:
    with pytest.raises(InputError, match=word):
        chosen_design(sample, points, sensitivity, 2, 0)


def test_too_many_points_are_refused() -> None:
    many = [parse_parameter(f"p{k}=1:2:100") for k in range(3)]
    with pytest.raises(InputError, match="1000000 points"):
        Design("grid", None, 0).choose(many)
