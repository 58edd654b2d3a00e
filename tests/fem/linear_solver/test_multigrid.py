import numpy as np
import pytest
import scipy.sparse as sp

import fem
from fem.linear_solver import SingularMatrixError, make_solver
from fem.linear_solver.multigrid import ColumnInverses, ElementSum, MultigridCycle
from tests.fem.linear_solver.test_iterative import block


@pytest.fixture(scope="module")
def parts():
    """Element matrices, spaces and the assembled soft stiffness of a small block."""
    model = fem.prepare(block(), "iterative")
    system, solver = model.equilibrium.system, model.equilibrium.solver
    tangent = system.element_tangent(system.evaluate(*system.rest()))
    space, n = solver._space, model.unknowns
    entries = system.scatter.matrix(tangent.packed)
    upper = sp.csr_array((entries, system.scatter.indices, system.scatter.indptr), shape=(n, n))
    return tangent.matrices(), space, (upper + sp.triu(upper, 1).T).tocsr()


def test_products_are_those_of_the_assembled_matrix(parts):
    matrices, space, assembled = parts
    x = np.random.default_rng(5).normal(size=space.count)
    found = ElementSum(space.unknowns, space.count).product(matrices, x)
    np.testing.assert_allclose(found, assembled @ x, atol=1e-9 * np.abs(assembled @ x).max())


def test_columns_are_inverted_exactly(parts):
    matrices, space, assembled = parts
    inverses = ColumnInverses(matrices, space.unknowns, space.column)
    members = np.flatnonzero(space.column == 7)
    wanted = np.random.default_rng(6).normal(size=len(members))
    residual = np.zeros(space.count)
    residual[members] = assembled[members][:, members] @ wanted
    found = inverses(residual.astype(np.float32))
    np.testing.assert_allclose(found[members], wanted, rtol=2e-3, atol=2e-3)
    assert not found[space.column != 7].any()


def test_a_column_without_stiffness_is_said(parts):
    matrices, space, _ = parts
    with pytest.raises(SingularMatrixError, match="a column of nodes"):
        ColumnInverses(0.0 * matrices, space.unknowns, space.column)


def test_the_linear_elements_are_the_quadratic_ones_between_their_corners(parts):
    matrices, space, assembled = parts
    m = space.transfer.shape[1]
    upper = sp.csr_array((space.coarse_entries(matrices), space.indices, space.indptr), shape=(m, m))
    wanted = space.transfer.T @ assembled @ space.transfer
    np.testing.assert_allclose(upper.toarray(), np.triu(wanted.toarray()), atol=1e-9 * abs(wanted).max())


def test_the_cycle_is_symmetric_and_positive_and_near_the_inverse(parts):
    matrices, space, assembled = parts
    cycle = MultigridCycle(matrices, space, make_solver("auto", space.indptr, space.indices))
    rng = np.random.default_rng(8)
    a, b = rng.normal(size=(2, space.count))
    assert a @ cycle(b) == pytest.approx(b @ cycle(a), rel=1e-3, abs=1e-4 * np.sqrt((a @ cycle(a)) * (b @ cycle(b))))
    assert a @ cycle(a) > 0.0
    u = rng.normal(size=space.count)
    energy = u @ assembled @ u
    left = u - cycle(assembled @ u)
    assert left @ assembled @ left < 0.1 * energy
