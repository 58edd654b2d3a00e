"""Small surfaces."""

import numpy as np
import pytest
import pyvista

from fem.mesh.surface.surface_file import Surface


@pytest.fixture
def ball():
    """A sphere of 20 mm."""
    sphere = pyvista.Icosphere(radius=0.02, nsub=2)
    return Surface(np.asarray(sphere.points, dtype=np.float64), sphere.regular_faces.astype(np.int64))
