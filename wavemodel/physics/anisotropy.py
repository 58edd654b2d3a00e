"""Anisotropy of a sheet: tension that differs along x and y draws the dent out along the larger one."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import require


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
        require("anisotropy", "ratio", self.ratio, "", 0.01, 100.0)

    def radius(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """(...) radius r' in m at which the isotropic dent is read for points (...), m from the tool axis."""
        return np.asarray(np.sqrt(x**2 / np.sqrt(self.ratio) + y**2 * np.sqrt(self.ratio)))

    def gradient(self, x: FloatArray, y: FloatArray, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(...) dw/dx and dw/dy from the isotropic slope dw/dr' (...) at `radius`; zero on the axis."""
        r = self.radius(x, y)
        steep = np.divide(slope, r, out=np.zeros_like(r), where=r > 0.0)
        return np.asarray(steep * x / np.sqrt(self.ratio)), np.asarray(steep * y * np.sqrt(self.ratio))
