"""Sobol indices against the closed form of the Ishigami function, points without a value, and keys without effect."""

import numpy as np
import pytest

from benchmark.sweeps.point import PointResult, failed
from benchmark.sweeps.sensitivity import base_samples, keys_without_effect, saltelli_design, sobol_indices

NAMES = ("x1", "x2", "x3")
A, B = 7.0, 0.1


def ishigami(shares: np.ndarray) -> np.ndarray:
    """sin x1 + a sin^2 x2 + b x3^4 sin x1 on [-pi, pi]^3 (Ishigami and Homma 1990)."""
    x1, x2, x3 = (2.0 * shares - 1.0).T * np.pi
    return np.sin(x1) + A * np.sin(x2) ** 2 + B * x3**4 * np.sin(x1)


def exact() -> dict[str, list[float]]:
    v1 = 0.5 * (1 + B * np.pi**4 / 5) ** 2
    v2 = A**2 / 8
    v13 = B**2 * np.pi**8 * (1 / 18 - 1 / 50)
    total = v1 + v2 + v13
    return {"first": [v1 / total, v2 / total, 0.0], "total": [(v1 + v13) / total, v2 / total, v13 / total]}


def indices(base: int, seed: int):
    return sobol_indices(NAMES, {"y": ishigami(saltelli_design(NAMES, base, seed))}, seed=seed)


@pytest.mark.parametrize("order", ["first", "total"])
def test_ishigami(order: str) -> None:
    found = [getattr(index, order) for index in indices(2048, 3).indices]
    np.testing.assert_allclose(found, exact()[order], atol=0.02)


def test_intervals_cover_the_truth_and_narrow_with_the_sample() -> None:
    wide, narrow = indices(64, 5).indices, indices(1024, 5).indices
    for small, large, value in zip(wide, narrow, exact()["first"], strict=True):
        assert large.first_ci95 < 0.6 * small.first_ci95
        assert abs(large.first - value) < 2.0 * large.first_ci95


@pytest.mark.parametrize("seed", [0, 1])
def test_the_seed_decides(seed: int) -> None:
    assert indices(64, seed) == indices(64, seed)
    assert indices(64, seed) != indices(64, seed + 1)


def test_a_point_without_a_value_takes_its_block_with_it() -> None:
    points = saltelli_design(NAMES, 256, 1)
    holes = ishigami(points)
    holes[7] = np.nan
    found = sobol_indices(NAMES, {"y": holes}, seed=1)
    without = sobol_indices(NAMES, {"y": np.delete(ishigami(points).reshape(-1, 5), 1, axis=0).ravel()}, seed=1)
    assert found.indices == without.indices
    assert found.base_samples == 256
    assert found.warnings == ("y: 1 of 256 blocks of the design are left out, points without a value in them",)


def test_what_has_no_indices_says_why() -> None:
    size = len(saltelli_design(NAMES, 8, 0))
    few = np.full(size, np.nan)
    few[:10] = np.arange(10.0)
    results = {"same": np.full(size, 5.0), "zero": np.zeros(size), "none": np.full(size, np.nan), "few": few}
    found = sobol_indices(NAMES, results, seed=0)
    assert found.indices == ()
    said = " | ".join(found.warnings)
    assert "same, zero: no indices: it is the same at every point" in said
    assert "none: no indices: no block" in said
    assert "few: no indices: only 2 of 8 blocks" in said


def test_another_number_of_points_is_refused() -> None:
    with pytest.raises(ValueError, match="reshape"):
        sobol_indices(NAMES, {"y": np.ones(11)}, seed=0)


@pytest.mark.parametrize(
    ("points", "parameters", "base"), [(128, 2, 32), (127, 2, 16), (200, 2, 32), (5, 3, 1), (4, 3, 0)]
)
def test_the_design_stays_within_the_points_asked_for(points: int, parameters: int, base: int) -> None:
    assert base_samples(points, parameters) == base
    if base:
        design = saltelli_design([f"p{k}" for k in range(parameters)], base, 0)
        assert design.shape == (base * (parameters + 2), parameters)
        assert len(design) <= points


def test_the_design_has_the_shape_the_indices_count_on() -> None:
    design = saltelli_design(NAMES, 4, 0).reshape(4, 5, 3)
    first, last = design[:, 0], design[:, -1]
    for place in range(3):
        mixed = first.copy()
        mixed[:, place] = last[:, place]
        np.testing.assert_array_equal(design[:, 1 + place], mixed)


def row(point: int, depth: float, **more: float) -> PointResult:
    return PointResult(point, "ok", values={"fem_depth_mm": depth, "fem_seconds_s": float(point), **more})


def without_effect(rows: list[PointResult]) -> tuple[str, ...]:
    points = [(modulus, radius) for modulus in ("1 MPa", "2 MPa") for radius in ("2 mm", "3 mm")]
    return keys_without_effect(["dermis.youngs_modulus", "tool.radius"], points, rows)


def test_a_key_that_changes_no_result_is_without_effect() -> None:
    """A layer with a law of its own does not follow `youngs_modulus` in finite strain: all points were the same."""
    idle = [row(1, 1.0), row(2, 0.5), row(3, 1.0), row(4, 0.5)]
    assert without_effect(idle) == ("dermis.youngs_modulus",)
    assert without_effect([*idle[:3], row(4, 0.5000001)]) == ()
    assert without_effect([*idle[:2], failed(3, "no"), failed(4, "no")]) == ()
    assert without_effect([row(1, 1.0), row(2, 0.5), row(3, 1.0, wave_depth_mm=1.0), row(4, 0.5)]) == ()
