import numpy as np
import pytest
import scipy.sparse as sp

import fem
from fem.linear_solver import SingularMatrixError, make_solver, multigrid
from fem.linear_solver.multigrid import Columns, ElementSum, MultigridCycle
from tests.fem.linear_solver.test_iterative import block


@pytest.fixture(scope="module")
def parts():
    """Element matrices, spaces and the assembled soft stiffness of a small block."""
    model = fem.prepare(block(), "iterative")
    system, solver = model.equilibrium.system, model.equilibrium.solver
    tangent = system.element_tangent(system.evaluate(*system.rest()))
    space, n = solver._space, model.unknowns
    rows, columns = system.elements.geometry.packed
    entries = system.scatter.matrix(tangent.matrices[:, rows, columns].T)
    upper = sp.csr_array((entries, system.scatter.indices, system.scatter.indptr), shape=(n, n))
    return tangent.matrices, space, (upper + sp.triu(upper, 1).T).tocsr()


def test_products_are_those_of_the_assembled_matrix(parts):
    matrices, space, assembled = parts
    x = np.random.default_rng(5).normal(size=space.count)
    found = ElementSum(space.unknowns, space.count).product(matrices, x)
    np.testing.assert_allclose(found, assembled @ x, atol=1e-9 * np.abs(assembled @ x).max())


@pytest.mark.parametrize("threads", ["1", "2"])
def test_threads_change_no_digit_of_a_product(parts, monkeypatch, threads):
    matrices, space, _ = parts
    x = np.random.default_rng(5).normal(size=space.count)
    monkeypatch.setattr(multigrid, "AT_ONCE", 7)
    monkeypatch.setenv("OMP_NUM_THREADS", threads)
    elements = ElementSum(space.unknowns, space.count)
    np.testing.assert_array_equal(
        elements.on_elements(matrices, elements.gather(x)), np.einsum("eij,ej->ei", matrices, elements.gather(x))
    )


def test_columns_are_solved_exactly_and_leave_the_others(parts):
    matrices, space, assembled = parts
    columns, of_column = Columns(matrices, space.unknowns, space.places), space.places.column
    assert columns.blocks > 3
    for column in (0, 7, of_column.max()):
        members = np.flatnonzero(of_column == column)
        wanted = np.random.default_rng(6).normal(size=len(members))
        residual = np.zeros(space.count)
        residual[members] = assembled[members][:, members] @ wanted
        found = columns(residual.astype(np.float32))
        np.testing.assert_allclose(found[members], wanted, rtol=2e-3, atol=2e-3)
        assert not found[of_column != column].any()


def test_unknowns_of_one_element_and_column_lie_in_one_block_or_in_neighbours(parts):
    _, space, _ = parts
    places = space.places
    assert len(set(zip(places.column, places.slot, strict=True))) == space.count
    for unknowns in space.unknowns.T:
        free = unknowns[unknowns < space.count]
        same = places.column[free][:, None] == places.column[free]
        block = places.slot[free] // places.reach
        assert np.abs(block[:, None] - block)[same].max() <= 1


def test_a_column_without_stiffness_is_said(parts):
    matrices, space, _ = parts
    with pytest.raises(SingularMatrixError, match="a column of nodes"):
        Columns(0.0 * matrices, space.unknowns, space.places)


def test_the_linear_elements_are_the_quadratic_ones_between_their_corners(parts):
    matrices, space, assembled = parts
    m = space.transfer.shape[1]
    upper = sp.csr_array((space.coarse_entries(matrices), space.indices, space.indptr), shape=(m, m))
    wanted = space.transfer.T @ assembled @ space.transfer
    np.testing.assert_allclose(upper.toarray(), np.triu(wanted.toarray()), atol=1e-9 * abs(wanted).max())


def test_the_cycle_is_symmetric_and_positive_and_near_the_inverse(parts):
    matrices, space, assembled = parts
    elements = ElementSum(space.unknowns, space.count)
    cycle = MultigridCycle(matrices, space, elements, make_solver("auto", space.indptr, space.indices))
    rng = np.random.default_rng(8)
    a, b = rng.normal(size=(2, space.count))
    assert a @ cycle(b) == pytest.approx(b @ cycle(a), rel=1e-3, abs=1e-4 * np.sqrt((a @ cycle(a)) * (b @ cycle(b))))
    assert a @ cycle(a) > 0.0
    u = rng.normal(size=space.count)
    energy = u @ assembled @ u
    left = u - cycle(assembled @ u)
    assert left @ assembled @ left < 0.1 * energy
