"""Rows of nodes and interfaces whose sides are parted."""

import numpy as np
import pytest

from fem.mesh.quads import ring_areas, split_interfaces
from fem.mesh.structured import build_mesh

WHOLE = build_mesh(np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0, 2.0, 4.0]), np.array([0.0, 1.0, 2.0]))


def test_sides_coincide_and_share_axis_and_border():
    parted = split_interfaces(WHOLE, (0, 1))
    for upper, lower in zip(parted.undersides, parted.interfaces[1:], strict=True):
        np.testing.assert_array_equal(parted.nodes[upper], parted.nodes[lower])
        np.testing.assert_array_equal(upper == lower, [True, False, False, False, True])


def test_each_side_belongs_to_its_layer():
    parted = split_interfaces(WHOLE, (0, 1))
    for layer in range(2):
        upper, lower = parted.undersides[layer][1:-1], parted.interfaces[layer + 1][1:-1]
        of_layer = [set(parted.elements[:, parted.layer == n].ravel().tolist()) for n in range(3)]
        assert set(upper.tolist()) <= of_layer[layer]
        assert set(lower.tolist()) <= of_layer[layer + 1]
        assert not of_layer[layer] & set(lower.tolist())
        assert not of_layer[layer + 1] & set(upper.tolist())


def test_nothing_else_changes():
    parted = split_interfaces(WHOLE, (1,))
    assert len(parted.nodes) == len(WHOLE.nodes) + 3
    np.testing.assert_array_equal(parted.nodes[parted.elements], WHOLE.nodes[WHOLE.elements])
    np.testing.assert_array_equal(parted.undersides[0], WHOLE.interfaces[1])
    assert split_interfaces(WHOLE, ()) is WHOLE


def test_ring_areas_fill_the_ring():
    r = np.array([1.0, 2.0, 3.0, 3.5, 4.0])
    area = ring_areas(r)
    assert area.sum() == pytest.approx(np.pi * (4.0**2 - 1.0**2))
    assert area @ r == pytest.approx(2.0 * np.pi * (4.0**3 - 1.0**3) / 3.0)
