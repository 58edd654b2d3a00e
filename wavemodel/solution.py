"""What a run of a wave model gives back, whichever model it was, and the motion of markers that is read off it."""

from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, TypeVar

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError


class FaceMotion(Protocol):
    """Displacement of the layers' faces at the steps of a run; NaN outside the model's window."""

    def deflection(self, step: int, radius: FloatArray) -> FloatArray:
        """(L, R) of each layer's top face at radii (R,) along +x, m."""
        ...

    def in_plane(self, step: int, points: FloatArray, face: int) -> FloatArray:
        """(P, 2) along x and y at points (P, 2) of a face, 0 for the surface to L for the lowest, m."""
        ...


Faces_co = TypeVar("Faces_co", bound=FaceMotion, covariant=True)


@dataclass(frozen=True, repr=False)
class WaveSolution(Generic[Faces_co]):
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
        How time was gone through: "quasi_static", or with inertia "exact" (layers) or "mid_point" (a sheet).
    warnings
        What a reader of the results must know.
    faces
        Displacement of the faces in space.
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
    faces: Faces_co = field(repr=False)
    energy: FloatArray | None = None

    def __repr__(self) -> str:
        force, depth = float(np.abs(self.force).max()), 1e3 * float(np.abs(self.depth).max())
        told = "".join(f"\n  warning: {warning}" for warning in self.warnings)
        return f"<WaveSolution {self.time.size} steps to {force:.4g} N, {depth:.4g} mm, {self.integrator}>{told}"

    def warned(self, warning: str) -> "WaveSolution[Faces_co]":
        """The same with one more warning, the first."""
        return replace(self, warnings=(warning, *self.warnings))

    def profile(self, step: int, radii: FloatArray) -> FloatArray:
        """Deflection of each layer's top face along +x after a step.

        Parameters
        ----------
        step
            0..n-1; negative counts from the end.
        radii
            (m,) distances from the tool axis of the points before the press, m.

        Returns
        -------
        ndarray (L, m)
            In m; NaN outside the window, or the hole.

        Raises
        ------
        WaveError
            If a radius is negative or not a number.
        """
        return self.faces.deflection(step, checked_radii(radii))


def checked_radii(radii: FloatArray) -> FloatArray:
    """(m,) distances from the tool axis.

    Raises
    ------
    WaveError
        If one is negative or not a number.
    """
    radius = np.asarray(radii, dtype=np.float64)
    if not np.all(radius >= 0.0):
        raise WaveError("profile: a radius that is negative or not a number is not allowed")
    return radius


def radially(outward: FloatArray, points: FloatArray) -> FloatArray:
    """(P, 2) along x and y of what moves points (P, 2) away from the tool's axis by (P,)."""
    distance = np.hypot(points[:, 0], points[:, 1])
    return np.asarray((outward / np.maximum(distance, 1e-300))[:, None] * points)


def marker_motion(solution: WaveSolution[FaceMotion], points: FloatArray, step: int = -1, face: int = -1) -> FloatArray:
    """In-plane displacement of points of a face after a step of a run.

    The camera of the bench looks at the lower face. On a bonded base nothing moves there; over a hole, or with a free
    lower face, markers move away from the tool's axis as the face turns and stretches.

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
    return solution.faces.in_plane(step % steps, places, face % count)
