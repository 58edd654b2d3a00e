import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem.assembly import scatter as scatter_module
from fem.assembly.scatter import build_scatter, number_unknowns, packed_positions


def dense(scatter, data, n):
    full = np.zeros((n, n))
    row = np.repeat(np.arange(n), np.diff(scatter.indptr))
    full[row, scatter.indices] = data
    return full + full.T - np.diag(full.diagonal())


def test_fixed_and_tied_displacements_are_no_unknowns_of_their_own():
    fixed = np.zeros((2, 6), dtype=bool)
    fixed[:, 0] = True
    tied = np.array([False, False, False, True, True, True])
    numbering = number_unknowns(fixed, tied)
    assert numbering.count == 12 - 2 - 2
    assert (numbering.unknown[:, 0] == -1).all()
    assert len(set(numbering.unknown[1, tied].tolist())) == 1
    y = np.arange(1.0, numbering.count + 1)
    assert numbering.expand(y)[0, 0] == 0.0


def test_reduction_adds_what_is_tied():
    numbering = number_unknowns(np.zeros((2, 4), dtype=bool), np.array([True, True, False, False]))
    nodal = np.zeros((2, 4))
    nodal[1, :2] = 1.0, 2.0
    assert numbering.reduce(nodal)[numbering.unknown[1, 0]] == 3.0


@given(st.integers(0, 2**31 - 1))
@settings(max_examples=20, deadline=None)
def test_matrix_sum_equals_dense_assembly(seed):
    rng = np.random.default_rng(seed)
    nodes, count = 15, 3
    elements = np.array([rng.permutation(nodes)[:9] for _ in range(count)]).T
    fixed = rng.random((2, nodes)) < 0.2
    tied = np.zeros(nodes, dtype=bool)
    tied[rng.permutation(nodes)[:4]] = True
    fixed[1, tied] = False
    numbering = number_unknowns(fixed, tied)
    scatter = build_scatter(elements, numbering)
    stiffness = rng.normal(size=(18, 18, count))
    stiffness += stiffness.transpose(1, 0, 2)
    expected = np.zeros((numbering.count, numbering.count))
    for e in range(count):
        unknown = numbering.unknown[:, elements[:, e]].ravel()
        for i, row in enumerate(unknown):
            for j, column in enumerate(unknown):
                if row >= 0 and column >= 0:
                    expected[row, column] += stiffness[i, j, e]
    row, column = packed_positions(9, 2)
    used = np.unique(numbering.unknown[:, elements][numbering.unknown[:, elements] >= 0])
    data = scatter.matrix(stiffness[row, column])
    np.testing.assert_allclose(
        dense(scatter, data, numbering.count)[np.ix_(used, used)], expected[np.ix_(used, used)], atol=1e-12
    )


def test_unknowns_of_a_node_follow_each_other():
    fixed = np.zeros((3, 4), dtype=bool)
    fixed[1, 2] = True
    numbering = number_unknowns(fixed, np.zeros(4, dtype=bool))
    np.testing.assert_array_equal(numbering.unknown.T, [[0, 1, 2], [3, 4, 5], [6, -1, 7], [8, 9, 10]])


def test_an_element_may_have_a_node_twice():
    """The two entries of one node with itself, each other's mirrors, both land on the diagonal."""
    numbering = number_unknowns(np.zeros((2, 3), dtype=bool), np.zeros(3, dtype=bool))
    elements = np.array([[2], [0], [2], [1]])
    scatter = build_scatter(elements, numbering)
    stiffness = np.random.default_rng(8).normal(size=(8, 8))
    stiffness += stiffness.T
    expected = np.zeros((6, 6))
    unknown = numbering.unknown[:, elements[:, 0]].ravel()
    np.add.at(expected, (unknown[:, None], unknown), stiffness)
    data = scatter.matrix(stiffness[packed_positions(4, 2)][:, None])
    np.testing.assert_allclose(dense(scatter, data, 6), expected, atol=1e-12)


def test_parts_of_the_elements_add_up_to_all_of_them(block):
    mesh = block()
    scatter = build_scatter(mesh.elements, number_unknowns(np.stack((mesh.axis, mesh.base)), mesh.top))
    packed = np.random.default_rng(9).normal(size=(171, mesh.elements.shape[1]))
    parts = [(slice(0, 3), packed[:, :3]), (slice(3, None), packed[:, 3:])]
    np.testing.assert_allclose(scatter.matrix_of_parts(parts), scatter.matrix(packed), rtol=1e-12, atol=1e-12)


def test_pattern_has_the_diagonal_first(block):
    mesh = block()
    numbering = number_unknowns(np.stack((mesh.base | mesh.axis, mesh.base)), mesh.top)
    scatter = build_scatter(mesh.elements, numbering)
    np.testing.assert_array_equal(scatter.indices[scatter.indptr[:-1]], np.arange(numbering.count))


@pytest.mark.parametrize("rows", [scatter_module.ROWS_AT_ONCE, 7, 1])
def test_round_off_is_eps_times_the_sizes(block, system_of, rows, monkeypatch):
    monkeypatch.setattr(scatter_module, "ROWS_AT_ONCE", rows)
    system = system_of(block())
    y = np.random.default_rng(7).normal(size=system.numbering.count)
    tangent = system.tangent(system.evaluate(*system.rest()))
    bound = np.abs(dense(system.scatter, tangent, len(y))) @ np.abs(y)
    assert system.scatter.round_off(tangent, y) == pytest.approx(np.finfo(float).eps * np.linalg.norm(bound))


def test_round_off_makes_no_second_tangent(monkeypatch):
    """At its full size it is new memory, which costs more than the products."""
    monkeypatch.setattr(scatter_module, "ROWS_AT_ONCE", 16)
    elements = (np.arange(500) + 7 * np.arange(8)[:, None]) % 500
    numbering = number_unknowns(np.zeros((2, 500), dtype=bool), np.zeros(500, dtype=bool))
    scatter = build_scatter(elements, numbering)
    tangent, y = np.ones(len(scatter.indices)), np.ones(numbering.count)
    tracemalloc.start()
    scatter.round_off(tangent, y)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(tangent) > 10 * len(y)
    assert peak < 0.8 * tangent.nbytes
