"""Tensile stress in the plane before the press, not necessarily the same along x and y: of layers, and of a sheet."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError, require_between


@dataclass(frozen=True)
class InPlaneStress:
    """Stresses sigma_x and sigma_y add sigma_x d2/dx2 + sigma_y d2/dy2 of all displacements to the equations of motion.

    M. A. Biot, Mechanics of Incremental Deformations (small motion on an initial stress, the moduli unchanged): in a
    sheet of thickness h the stiffness D k^4 becomes D k^4 + h (sigma_x kx^2 + sigma_y ky^2).

    Attributes
    ----------
    x, y
        (L,) stress of each layer in Pa, from the surface down, 0 to 1e8.
    """

    x: tuple[float, ...]
    y: tuple[float, ...]

    def __post_init__(self) -> None:
        for axis, values in (("x", self.x), ("y", self.y)):
            for index, value in enumerate(values):
                require_between("pretension", f"{axis}[{index}]", value, "Pa", 0.0, 1e8)

    @property
    def directed(self) -> bool:
        """Whether x and y differ."""
        return self.x != self.y

    @property
    def mean(self) -> FloatArray:
        """(L,) over all directions, Pa."""
        return np.asarray(0.5 * (np.array(self.x) + np.array(self.y)))

    def along(self, share: FloatArray) -> FloatArray:
        """(n, L) stress that modes see whose share (n,) of k^2 runs along x, Pa."""
        return np.asarray(np.outer(share, self.x) + np.outer(1.0 - share, self.y))


def in_plane_stress(given: float | Sequence[float] | InPlaneStress | None, layers: int) -> InPlaneStress | None:
    """Read a pretension: a stress, one for x and one for y, or an `InPlaneStress`, in Pa.

    Raises
    ------
    WaveError
        If it is none of these, or not of as many layers as the stack has.
    """
    if given is None or isinstance(given, InPlaneStress):
        if given is not None and not len(given.x) == len(given.y) == layers:
            raise WaveError(f"pretension: {len(given.x)} and {len(given.y)} stresses for {layers} layers; one for each")
        return given
    both = np.asarray(given, dtype=np.float64)
    if both.shape not in ((), (2,)):
        raise WaveError(f"pretension = {given!r} is not allowed: one stress, or one for x and one for y, in Pa")
    x, y = np.broadcast_to(both, 2).tolist()
    stress = InPlaneStress((x,) * layers, (y,) * layers)
    return stress if any((*stress.x, *stress.y)) else None


@dataclass(frozen=True)
class AnisotropicTension:
    """T_x w_xx + T_y w_yy = -q is isotropic in x / (T_x / T)^(1/2), y / (T_y / T)^(1/2), T = (T_x T_y)^(1/2).

    With the ratio T_x / T_y = rho the dent of a tool is that of the isotropic sheet of tension T at the radius
    r' = (x^2 rho^(-1/2) + y^2 rho^(1/2))^(1/2): exact for the dent of a point in an endless membrane, a change of shape
    without a change of force elsewhere (to first order in the difference; R. Haberman, Applied Partial Differential
    Equations, section 9.5, for the transformation). In the layered wave the two stresses act mode by mode instead:
    `InPlaneStress`.

    Attributes
    ----------
    ratio
        rho, 0.01 to 100; one: off.
    """

    ratio: float

    def __post_init__(self) -> None:
        require_between("anisotropy", "ratio", self.ratio, "", 0.01, 100.0)

    def radius(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """(...) radius r' in m at which the isotropic dent is read for points (...), m from the tool axis."""
        return np.asarray(np.sqrt(x**2 / np.sqrt(self.ratio) + y**2 * np.sqrt(self.ratio)))

    def gradient(self, x: FloatArray, y: FloatArray, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(...) dw/dx and dw/dy from the isotropic slope dw/dr' (...) at `radius`; zero on the axis."""
        r = self.radius(x, y)
        steep = np.divide(slope, r, out=np.zeros_like(r), where=r > 0.0)
        return np.asarray(steep * x / np.sqrt(self.ratio)), np.asarray(steep * y * np.sqrt(self.ratio))
