import builtins
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from fem import FemError
from fem.linear_solver import SingularMatrixError, make_solver

CHOICES = ["superlu", pytest.param("pardiso", marks=pytest.mark.skipif(sys.platform == "darwin", reason="no MKL"))]


def tridiagonal(n, diagonal):
    """Upper triangle of a symmetric tridiagonal matrix with off-diagonal -1."""
    full = np.diag(diagonal) - np.eye(n, k=1) - np.eye(n, k=-1)
    indptr = np.append(2 * np.arange(n), 2 * n - 1)
    indices = np.concatenate([(i, i + 1) for i in range(n)])[:-1]
    data = np.ravel(np.stack((diagonal, np.full(n, -1.0)), axis=1))[:-1]
    return full, indptr, indices, data


@pytest.mark.parametrize("choice", CHOICES)
@pytest.mark.parametrize("low", [2.5, -2.5], ids=["definite", "indefinite"])
def test_solution_equals_the_dense_one(choice, low):
    rng = np.random.default_rng(12)
    diagonal = np.where(np.arange(50) % 3 == 0, low, 3.0)
    full, indptr, indices, data = tridiagonal(50, diagonal)
    solver = make_solver(choice, indptr, indices)
    assert solver.name == choice
    solver.factorise(data)
    right = rng.normal(size=(50, 2))
    np.testing.assert_allclose(solver.solve(right), np.linalg.solve(full, right), rtol=1e-9)


@pytest.mark.parametrize("choice", CHOICES)
def test_values_may_change_on_one_pattern(choice):
    full, indptr, indices, data = tridiagonal(20, np.full(20, 4.0))
    solver = make_solver(choice, indptr, indices)
    right = np.ones((20, 1))
    for factor in (1.0, 1e6):
        solver.factorise(factor * data)
        np.testing.assert_allclose(solver.solve(right), np.linalg.solve(factor * full, right), rtol=1e-10)


@pytest.mark.parametrize("choice", CHOICES)
def test_sizes_that_span_many_orders_are_solved(choice):
    scale = np.geomspace(1e-9, 1e9, 30)
    full, indptr, indices, data = tridiagonal(30, np.full(30, 4.0))
    row = np.repeat(np.arange(30), np.diff(indptr))
    solver = make_solver(choice, indptr, indices)
    solver.factorise(data * scale[row] * scale[indices])
    exact = np.random.default_rng(13).normal(size=(30, 1)) / scale[:, None]
    right = scale[:, None] * (full @ (scale[:, None] * exact))
    np.testing.assert_allclose(solver.solve(right), exact, rtol=1e-10)


@pytest.mark.parametrize("choice", CHOICES)
def test_entries_that_are_not_finite_are_refused(choice):
    _, indptr, indices, data = tridiagonal(5, np.full(5, 4.0))
    solver = make_solver(choice, indptr, indices)
    data[0] = np.nan
    with pytest.raises(SingularMatrixError, match="not finite"):
        solver.factorise(data)


def test_singular_matrix_is_reported_by_superlu():
    _, indptr, indices, data = tridiagonal(5, np.full(5, 4.0))
    solver = make_solver("superlu", indptr, indices)
    with pytest.raises(SingularMatrixError):
        solver.factorise(0.0 * data)


def test_superlu_needs_factors_first():
    _, indptr, indices, _ = tridiagonal(5, np.full(5, 4.0))
    with pytest.raises(SingularMatrixError, match="nothing is factorised"):
        make_solver("superlu", indptr, indices).solve(np.ones((5, 1)))


@pytest.fixture
def pardiso():
    return pytest.importorskip("fem.linear_solver.pardiso", exc_type=ImportError)


def test_where_the_mkl_lies_is_told_unless_somebody_said(pardiso, monkeypatch):
    """Its own search took half a second of a press of four."""
    monkeypatch.delenv(pardiso.MKL)
    pardiso._tell_where_mkl_is()
    assert Path(os.environ[pardiso.MKL]).is_file()
    monkeypatch.setenv(pardiso.MKL, "libmkl_of_ones_own.so")
    pardiso._tell_where_mkl_is()
    assert os.environ[pardiso.MKL] == "libmkl_of_ones_own.so"


@pytest.mark.parametrize("low", [2.5, -2.5], ids=["definite", "indefinite"])
def test_single_factors_solve_as_double_ones(pardiso, low):
    """By Cholesky where there are such factors, otherwise by LDL^T."""
    rng = np.random.default_rng(14)
    full, indptr, indices, data = tridiagonal(60, np.where(np.arange(60) % 3 == 0, low, 3.0))
    solver = pardiso.PardisoSolver(indptr, indices, single_from=0)
    right = rng.normal(size=(60, 2)) * [1.0, 1e-30]
    for factor in (1.0, 1e9):
        solver.factorise(factor * data)
        np.testing.assert_allclose(solver.solve(right), np.linalg.solve(factor * full, right), rtol=1e-7)
    assert solver.is_single
    assert solver.way.kind == (pardiso.POSITIVE_DEFINITE if low > 0.0 else pardiso.INDEFINITE)


def test_a_solution_is_as_close_as_wanted(pardiso):
    full, indptr, indices, data = tridiagonal(60, np.full(60, 2.001))
    solver = pardiso.PardisoSolver(indptr, indices, single_from=0)
    solver.factorise(data)
    right = np.random.default_rng(16).normal(size=(60, 1))
    loose, close = (np.linalg.norm(full @ solver.solve(right, tolerance) - right) for tolerance in (1e-5, 1e-12))
    assert close < 1e-11 * np.linalg.norm(right) < 0.1 * loose


def test_a_preconditioner_has_single_factors_as_they_are(pardiso, monkeypatch):
    def refuse(*_):
        raise AssertionError("refined")

    monkeypatch.setattr(pardiso, "flexible_gmres", refuse)
    full, indptr, indices, data = tridiagonal(60, np.full(60, 2.5))
    solver = pardiso.PardisoSolver(indptr, indices, single_from=0)
    solver.factorise(data)
    right = np.random.default_rng(17).normal(size=(60, 2))
    found = solver.solve(right, pardiso.ALONE)
    left = np.linalg.norm(full @ found - right, axis=0) / np.linalg.norm(right, axis=0)
    assert (left < pardiso.ALONE).all()
    assert (left > 1e-12).all()


def test_single_factors_without_an_answer_are_not_taken_as_they_are(pardiso, monkeypatch):
    _, indptr, indices, data = tridiagonal(60, np.full(60, 2.5))
    solver = pardiso.PardisoSolver(indptr, indices, single_from=0)
    solver.factorise(data)
    monkeypatch.setattr(type(solver._factors), "solve", lambda *_: np.full((60, 1), np.nan))
    with pytest.raises(SingularMatrixError):
        solver.solve(np.ones((60, 1)), pardiso.ALONE)
    assert not solver.is_single


def test_where_single_factors_do_not_suffice_double_ones_are_made(pardiso, monkeypatch):
    monkeypatch.setattr(pardiso, "MOST_ITERATIONS", 1)
    full, indptr, indices, data = tridiagonal(60, np.full(60, 2.001))
    solver = pardiso.PardisoSolver(indptr, indices, single_from=0)
    solver.factorise(data)
    right = np.random.default_rng(15).normal(size=(60, 1))
    np.testing.assert_allclose(solver.solve(right), np.linalg.solve(full, right), rtol=1e-9)
    assert not solver.is_single


def test_no_load_has_no_displacement(pardiso):
    _, indptr, indices, data = tridiagonal(9, np.full(9, 4.0))
    solver = pardiso.PardisoSolver(indptr, indices, single_from=0)
    solver.factorise(data)
    np.testing.assert_array_equal(solver.solve(np.zeros((9, 1))), 0.0)


def test_unknown_choice_is_refused():
    with pytest.raises(FemError, match="linear_solver = 'mumps': allowed are auto, pardiso, superlu"):
        make_solver("mumps", np.array([0, 1]), np.array([0]))


def test_superlu_takes_over_where_pardiso_cannot_be_loaded(monkeypatch):
    """Without the MKL, "auto" falls back and "pardiso" says why not."""
    load = builtins.__import__

    def without_pardiso(name, *rest, **more):
        if name in ("fem.linear_solver.pardiso", "pypardiso"):
            raise ImportError("no MKL here")
        return load(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without_pardiso)
    _, indptr, indices, _ = tridiagonal(5, np.full(5, 4.0))
    assert make_solver("auto", indptr, indices).name == "superlu"
    with pytest.raises(FemError, match="no MKL here"):
        make_solver("pardiso", indptr, indices)
