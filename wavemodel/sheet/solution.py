"""What a run of the sheet over a hole gives back; the same face as `wavemodel.solution.WaveSolution`."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError


@dataclass(frozen=True)
class PlateSolution:
    """History of a press (n steps, L layers; deflections downwards, SI).

    Attributes
    ----------
    time, force
        (n,) in s and N.
    depth
        (n,) in m: the top face on the axis, or the tool if it is rigid.
    layer_names
        L names from the surface down.
    top_deflection
        (n, L) in m: each layer's top face on the tool axis.
    integrator
        "quasi_static" or "mid_point".
    warnings
        What a reader of the results must know.
    energy
        (n,) of sheet and tool in J, with inertia or a uniform tension; else None.
    """

    time: FloatArray
    force: FloatArray
    depth: FloatArray
    layer_names: tuple[str, ...]
    top_deflection: FloatArray
    integrator: str
    warnings: tuple[str, ...]
    energy: FloatArray | None
    _hole: float = field(repr=False)
    _faces: Callable[[int, FloatArray], FloatArray] = field(repr=False)

    def warned(self, warning: str) -> "PlateSolution":
        """The same with one more warning, the first."""
        return replace(self, warnings=(warning, *self.warnings))

    def profile(self, step: int, radii: FloatArray) -> FloatArray:
        """Deflection of each layer's top face after a step.

        Parameters
        ----------
        step
            0..n-1; negative counts from the end.
        radii
            (m,) distances from the tool axis of the points before the press, m.

        Returns
        -------
        ndarray (L, m)
            In m; NaN outside the hole.

        Raises
        ------
        WaveError
            If a radius is negative or not a number.
        """
        return self._at(step, radii)[1, :-1]

    def lower_face(self, step: int, radii: FloatArray) -> FloatArray:
        """(2, m): outward and downward displacement of the lower face, m, at radii (m,); NaN outside the hole.

        Raises
        ------
        WaveError
            If a radius is negative or not a number.
        """
        return self._at(step, radii)[:, -1]

    def in_plane(self, step: int, points: FloatArray, face: int) -> FloatArray:
        """(P, 2) displacement along x and y at points (P, 2) of a face, m; see `wavemodel.markers.marker_motion`."""
        distance = np.hypot(points[:, 0], points[:, 1])
        outward = self._at(step, distance)[0, face]
        return np.asarray(outward[:, None] * points / np.maximum(distance, 1e-300)[:, None])

    def _at(self, step: int, radii: FloatArray) -> FloatArray:
        radius = np.asarray(radii, dtype=np.float64)
        if not np.all(radius >= 0.0):
            raise WaveError("profile: a radius that is negative or not a number is not allowed")
        inside = radius <= self._hole
        faces = self._faces(step, np.where(inside, radius, self._hole))
        return np.where(inside, faces, np.nan)
