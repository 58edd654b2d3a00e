"""Motion of markers: in-plane displacement of any points of a face, at any step of a run.

The camera of the bench looks at the lower face. On a bonded base nothing moves there; over a hole, or with a free lower
face, markers move away from the tool's axis as the face turns and stretches.
"""

from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError


class Moving(Protocol):
    """A solution that knows how its faces move in their plane."""

    @property
    def layer_names(self) -> tuple[str, ...]:
        """L names from the surface down."""
        ...

    @property
    def time(self) -> FloatArray:
        """(n,) s."""
        ...

    def in_plane(self, step: int, points: FloatArray, face: int) -> FloatArray:
        """(P, 2) displacement at checked points of a checked face, m."""
        ...


def marker_motion(solution: Moving, points: FloatArray, step: int = -1, face: int = -1) -> FloatArray:
    """In-plane displacement of points of a face after a step of a run.

    Parameters
    ----------
    solution
        Of a `LayeredWave` or a `PlateWave`.
    points
        (P, 2) positions x, y of the points before the press, m from the tool axis.
    step
        0..n-1; negative counts from the end.
    face
        0 for the surface, 1.. for the interfaces, L for the lower face; negative counts from that.

    Returns
    -------
    ndarray (P, 2)
        In m; NaN outside the model's window.

    Raises
    ------
    NotCoveredError
        In a layered wave with layers that relax each in its own way, or at the surface under a rigid tool.
    WaveError
        If points, step or face are not usable.
    """
    places = np.asarray(points, dtype=np.float64)
    if places.ndim != 2 or places.shape[1] != 2 or not np.isfinite(places).all():
        raise WaveError(f"points: an array (P, 2) of finite positions is needed, not one of shape {places.shape}")
    count, steps = len(solution.layer_names) + 1, solution.time.size
    for name, value, size in (("step", step, steps), ("face", face, count)):
        if not -size <= value < size:
            raise WaveError(f"{name} = {value} is not allowed: {-size} to {size - 1}")
    return solution.in_plane(step % steps, places, face % count)
