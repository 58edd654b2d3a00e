import numpy as np

import fem
from tests.fem.linear_solver.test_iterative import block


def test_linear_displacements_are_taken_over_exactly():
    """Between the corners of the linear elements every displacement linear in space is met, where nothing is held."""
    model = fem.prepare(block(contact="uniform_pressure"), "iterative")
    space, numbering, nodes = model.equilibrium.solver._space, model.equilibrium.system.numbering, model.mesh.nodes
    field = (nodes @ np.array([[1.0, 0.2, -0.3], [0.5, 2.0, 0.1], [0.4, -1.0, 3.0]])).T
    fine = np.zeros(numbering.count)
    for unknown, values in zip(numbering.unknown, field, strict=True):
        fine[unknown[unknown >= 0]] = values[unknown >= 0]
    row_sums = space.transfer.sum(axis=1)
    corners = np.flatnonzero((space.transfer.tocsr() != 0).sum(axis=1) == 1)
    coarse = np.zeros(space.transfer.shape[1])
    exact = corners[row_sums[corners] == 1.0]
    coarse[space.transfer[exact].indices] = fine[exact]
    free = np.abs(row_sums - 1.0) < 1e-12
    straight = np.ptp(nodes, axis=0).max()
    assert free.sum() > 0.7 * numbering.count
    np.testing.assert_allclose((space.transfer @ coarse)[free], fine[free], atol=1e-12 + 2e-2 * straight)


def test_a_column_holds_the_nodes_above_each_other():
    model = fem.prepare(block(contact="uniform_pressure"), "iterative")
    space, numbering, nodes = model.equilibrium.solver._space, model.equilibrium.system.numbering, model.mesh.nodes
    for unknown in numbering.unknown:
        free = np.flatnonzero(unknown >= 0)
        column, slot = space.places.column[unknown[free]], space.places.slot[unknown[free]]
        for n in np.unique(column)[::50]:
            assert np.ptp(nodes[free[column == n], :2], axis=0).max() < 1e-9
            upwards = np.argsort(nodes[free[column == n], 2])
            assert (np.diff(slot[column == n][upwards]) > 0).all()


def test_what_is_tied_is_one_unknown_below():
    model = fem.prepare(block(), "iterative")
    space, tool = model.equilibrium.solver._space, model.equilibrium.probe
    row = space.transfer[[tool]]
    assert row.nnz == 1
    assert row.data[0] == 1.0
