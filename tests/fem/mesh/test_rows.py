import numpy as np
import pytest

from fem.mesh.rows import ring_areas


def test_ring_areas_fill_the_ring():
    r = np.array([1.0, 2.0, 3.0, 3.5, 4.0])
    area = ring_areas(r)
    assert area.sum() == pytest.approx(np.pi * (4.0**2 - 1.0**2))
    assert area @ r == pytest.approx(2.0 * np.pi * (4.0**3 - 1.0**3) / 3.0)
