"""Where the MKL is looked for, and that it keeps to its own threads."""

import os

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from fem.linear_solver import make_solver
from fem.linear_solver.direct import VARIABLE, name_library


@pytest.fixture
def environment(tmp_path):
    """A folder like an environment with the library."""
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "libmkl_rt.so.3").touch()
    return tmp_path


def test_the_library_of_the_environment_is_named(environment, monkeypatch):
    monkeypatch.setenv(VARIABLE, "to be restored")
    monkeypatch.delenv(VARIABLE)
    name_library(str(environment))
    assert os.environ[VARIABLE] == str(environment / "lib" / "libmkl_rt.so.3")


def test_the_user_s_choice_stays(environment, monkeypatch):
    monkeypatch.setenv(VARIABLE, "mine")
    name_library(str(environment))
    assert os.environ[VARIABLE] == "mine"


@pytest.mark.parametrize("count", [200, 20_000])
def test_other_limits_of_threads_do_not_reach_between_the_phases(count):
    """Analysed with two threads, factorised with one: Pardiso itself would crash."""
    indptr = np.append(np.arange(0, 2 * count - 1, 2), 2 * count - 1)
    indices = np.stack((np.arange(count), np.arange(1, count + 1)), axis=1).ravel()[:-1]
    data = np.where(np.arange(2 * count - 1) % 2 == 0, 4.0, 1.0)
    with threadpool_limits(2):
        solver = make_solver("auto", indptr, indices)
    with threadpool_limits(1):
        solver.factorise(data)
        x = solver.solve(np.ones((count, 1)))[:, 0]
    np.testing.assert_allclose(4 * x[1:-1] + x[:-2] + x[2:], 1.0, rtol=1e-12)


@pytest.mark.parametrize("choice", ["pardiso", "superlu"])
@pytest.mark.parametrize("seed", range(8))
def test_negative_eigenvalues_are_counted_or_not_told(choice, seed):
    """Against LAPACK's eigenvalues, of dense symmetric matrices with any signs."""
    if choice == "pardiso":
        pytest.importorskip("fem.linear_solver.pardiso", exc_type=ImportError)
    draw = np.random.default_rng(seed)
    count = 24
    half = draw.normal(size=(count, count)) + np.diag(draw.choice((-12.0, 12.0), count))
    matrix = half + half.T
    row, column = np.triu_indices(count)
    indptr = np.append(0, np.cumsum(np.bincount(row)))
    solver = make_solver(choice, indptr, column)
    solver.factorise(matrix[row, column])
    expected = int((np.linalg.eigvalsh(matrix) < 0.0).sum())
    assert solver.negative in ((expected,) if choice == "pardiso" else (expected, None))


@pytest.mark.parametrize(("sign", "expected"), [(1.0, 0), (-1.0, None)])
def test_single_factors_tell_of_a_positive_definite_matrix_only(sign, expected):
    pardiso = pytest.importorskip("fem.linear_solver.pardiso", exc_type=ImportError)
    solver = pardiso.PardisoSolver(np.array([0, 2, 3]), np.array([0, 1, 1]), single_from=1)
    solver.factorise(sign * np.array([2.0, 1.0, 2.0]))
    assert solver.is_single
    assert solver.negative == expected


def test_where_rows_were_exchanged_superlu_does_not_tell():
    """Of (0 1; 1 0), whose eigenvalues are 1 and -1, its pivots are both positive."""
    solver = make_solver("superlu", np.array([0, 2, 3]), np.array([0, 1, 1]))
    solver.factorise(np.array([1e-9, 1.0, 1e-9]))
    assert solver.negative is None


def test_a_matrix_without_negative_eigenvalues_is_known_by_every_solver():
    for choice in ("auto", "superlu"):
        solver = make_solver(choice, np.array([0, 2, 3]), np.array([0, 1, 1]))
        solver.factorise(np.array([2.0, 1.0, 2.0]))
        assert solver.negative == 0
