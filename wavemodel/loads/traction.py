"""A traction of unit force under the tool: coefficients of radial functions whose Hankel transforms are known."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.loads.half_space import HalfSpace


class TractionBasis(Protocol):
    """J radial traction functions under a disc."""

    @property
    def radius(self) -> float:
        """Of the disc, m."""
        ...

    @property
    def net_force(self) -> FloatArray:
        """(J,) normal force of each function."""
        ...

    def transform(self, wavenumber: FloatArray) -> FloatArray:
        """(n, J, 2) load along U and W at the wavenumbers (n,), rad/m.

        Along W it is 2 pi int p J_0(k r) r dr. An outward shear traction works against U, for grad S / k averages
        to -J_1(k r) round the axis: along U it is -2 pi int tau J_1(k r) r dr.
        """
        ...

    def half_space_deflection(self, body: HalfSpace, radius: FloatArray) -> FloatArray:
        """(R, J) normal displacement of a half-space at radii (R,) in m, m/N."""
        ...

    def half_space_flexibility(self, body: HalfSpace) -> FloatArray:
        """(J, J) work of each traction on the half-space's displacement under each other, m/N."""
        ...


@dataclass(frozen=True)
class Traction:
    """Coefficients of a basis, together of unit force.

    Attributes
    ----------
    basis
        The J radial functions.
    coefficients
        (J,); with the net forces they make one.
    """

    basis: TractionBasis
    coefficients: FloatArray

    def transform(self, wavenumber: FloatArray) -> FloatArray:
        """(n, 2) load along U and W at the wavenumbers (n,)."""
        load: FloatArray = np.einsum("njc,j->nc", self.basis.transform(wavenumber), self.coefficients)
        return load
