"""Contact tractions of unit force under a disc-shaped tool: radial functions whose Hankel transforms are known.

A uniform pressure has 2 J_1(k a) / (k a). Under a rigid flat tool the tractions are solved for so that the face under
it moves as one. With s = sqrt(1 - (r/a)^2) the normal tractions P_2n(s) / s (n = 0 the flat punch on a half-space) have
the transforms j_2n(k a), and shear tractions of the same singularity j_2n+1(k a), the spherical Bessel functions. On a
half-space, which every stack looks like at large wavenumbers, the normal ones displace the face by P_2n(s), so that
their flexibility is diagonal there; layers fill in the rest. Polynomials in s crowd at the tool's edge, where a thin
stiff layer concentrates the traction.

Galerkin's condition, that every function does the same work on the displacement as on a rigid motion, gives a
symmetric system. The work of its solution is stationary, so the tool's depth per force converges twice as fast as the
tractions do.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import eval_legendre, gammaln, hyp2f1, j1, spherical_jn

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError

FEWEST_FUNCTIONS, MOST_FUNCTIONS = 8, 32


@dataclass(frozen=True)
class HalfSpace:
    """Surface compliance of a half-space.

    A traction (T_U, T_W) at wavenumber k moves the surface by [[shear, cross], [cross, normal]] (T_U, T_W) / k
    (Johnson, Contact mechanics, chapter 3).

    Attributes
    ----------
    normal, cross
        (1 - nu) / G and (1 - 2 nu) / (2 G), 1/Pa.
    along
        What stands for `normal` along U where a stress in the plane makes it another, 1/Pa; None: the same.
    """

    normal: float
    cross: float
    along: float | None = None

    @classmethod
    def of(cls, shear_modulus: float, lame_modulus: float) -> "HalfSpace":
        """From the elastic constants, Pa."""
        poisson = 0.5 * lame_modulus / (lame_modulus + shear_modulus)
        return cls((1.0 - poisson) / shear_modulus, (0.5 - poisson) / shear_modulus)

    def times(self, factor: float) -> "HalfSpace":
        """A body so many times as compliant."""
        return HalfSpace(factor * self.normal, factor * self.cross, factor * self.shear)

    @property
    def shear(self) -> float:
        """Along U, 1/Pa."""
        return self.normal if self.along is None else self.along

    @property
    def matrix(self) -> FloatArray:
        """(2, 2) k times the compliance, 1/Pa."""
        return np.array([[self.shear, self.cross], [self.cross, self.normal]])


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


@dataclass(frozen=True)
class UniformPressure:
    """The one function of a uniform pressure (a `TractionBasis` with J = 1).

    Attributes
    ----------
    radius
        Of the disc, m.
    """

    radius: float

    @property
    def net_force(self) -> FloatArray:
        """(1,) of one."""
        return np.ones(1)

    def transform(self, wavenumber: FloatArray) -> FloatArray:
        """(n, 1, 2): nothing along U."""
        x = wavenumber * self.radius
        out = np.zeros((x.size, 1, 2))
        out[:, 0, 1] = 2.0 * j1(x) / x
        return out

    def half_space_deflection(self, body: HalfSpace, radius: FloatArray) -> FloatArray:
        """(R, 1) normal displacement at radii (R,), m/N: the integral of Weber and Schafheitlin."""
        rho = radius / self.radius
        out = np.empty_like(rho)
        inside = rho <= 1.0
        out[inside] = 2.0 * hyp2f1(0.5, -0.5, 1.0, rho[inside] ** 2)
        out[~inside] = hyp2f1(0.5, 0.5, 2.0, rho[~inside] ** -2.0) / rho[~inside]
        return (body.normal * out / (2.0 * np.pi * self.radius))[:, None]

    def half_space_flexibility(self, body: HalfSpace) -> FloatArray:
        """(1, 1) mean displacement under the pressure, m/N."""
        return np.array([[body.normal * 16.0 / (3.0 * np.pi) / (2.0 * np.pi * self.radius)]])


def uniform_pressure(radius: float) -> Traction:
    """Uniform pressure of unit force on a disc of the given radius, m."""
    return Traction(UniformPressure(radius), np.ones(1))


@dataclass(frozen=True)
class PunchTractions:
    """Normal functions n = 0.. and, without slip, shear functions n = 0.. (a `TractionBasis`).

    Attributes
    ----------
    radius
        Of the tool, m.
    normal, shear
        How many of each.
    """

    radius: float
    normal: int
    shear: int = 0

    @property
    def net_force(self) -> FloatArray:
        """(J,): only the first carries force."""
        out = np.zeros(self.normal + self.shear)
        out[0] = 1.0
        return out

    def transform(self, wavenumber: FloatArray) -> FloatArray:
        """(n, J, 2) load along U and W at the wavenumbers (n,)."""
        x = wavenumber * self.radius
        out = np.zeros((x.size, self.normal + self.shear, 2))
        for n in range(self.normal):
            out[:, n, 1] = spherical_jn(2 * n, x)
        for n in range(self.shear):
            out[:, self.normal + n, 0] = -spherical_jn(2 * n + 1, x)
        return out

    def half_space_deflection(self, body: HalfSpace, radius: FloatArray) -> FloatArray:
        """(R, J) normal displacement at radii (R,), m/N: the integrals of Weber and Schafheitlin."""
        rho = radius / self.radius
        columns = [body.normal * _normal_potential(rho, n) for n in range(self.normal)]
        columns += [-body.cross * _shear_potential(rho, n) for n in range(self.shear)]
        return np.stack(columns, axis=-1) / (2.0 * np.pi * self.radius)

    def half_space_flexibility(self, body: HalfSpace) -> FloatArray:
        """(J, J) work of each traction on the displacement under each other, m/N."""
        n, m = np.arange(self.normal), np.arange(self.shear)
        out = np.zeros((self.normal + self.shear,) * 2)
        out[n, n] = body.normal * np.pi / (2.0 * (4.0 * n + 1.0))
        out[self.normal + m, self.normal + m] = body.shear * np.pi / (2.0 * (4.0 * m + 3.0))
        apart = n[:, None] - m
        crossed = body.cross * (-1.0) ** apart / ((2.0 * apart - 1.0) * 2.0 * (n[:, None] + m + 1.0))
        out[: self.normal, self.normal :] = crossed
        out[self.normal :, : self.normal] = crossed.T
        return out / (2.0 * np.pi * self.radius)


def _normal_potential(rho: FloatArray, n: int) -> FloatArray:
    """int_0^inf j_2n(x) J_0(x rho) dx."""
    inside = rho <= 1.0
    out = np.empty_like(rho)
    height = np.sqrt(1.0 - rho[inside] ** 2)
    out[inside] = np.exp(gammaln(n + 0.5) - gammaln(n + 1.0)) * eval_legendre(2 * n, height)
    far = rho[~inside]
    size = np.exp(2.0 * gammaln(n + 0.5) - gammaln(2 * n + 1.5)) * (-1.0) ** n / np.pi
    out[~inside] = size * far ** -(2.0 * n + 1.0) * hyp2f1(n + 0.5, n + 0.5, 2 * n + 1.5, far**-2.0)
    return np.asarray(0.5 * np.sqrt(np.pi) * out)


def _shear_potential(rho: FloatArray, n: int) -> FloatArray:
    """int_0^inf j_2n+1(x) J_0(x rho) dx; zero outside the disc."""
    height = np.sqrt(np.maximum(1.0 - rho**2, 0.0))
    size = 0.5 * np.sqrt(np.pi) * np.exp(gammaln(n + 1.0) - gammaln(n + 1.5))
    return np.asarray(size * eval_legendre(2 * n + 1, height))


def punch_tractions(radius: float, contact: str, functions: int) -> PunchTractions:
    """Functions for "rigid_frictionless" (no shear) or "rigid_bonded" (no slip).

    Raises
    ------
    NotCoveredError
        For any other contact.
    """
    if contact == "rigid_frictionless":
        return PunchTractions(radius, functions)
    if contact == "rigid_bonded":
        return PunchTractions(radius, functions, functions)
    raise NotCoveredError(
        f"the layered wave does not cover tool contact {contact!r}: slip under friction is not linear; "
        "uniform_pressure, rigid_frictionless and rigid_bonded are covered"
    )


def enough_functions(thinness: float) -> int:
    """How many functions resolve the traction that a first layer concentrates at the edge.

    Parameters
    ----------
    thinness
        Thickness of the first layer over the tool's radius: the ring is as wide, 1 - r/a = s^2 / 2.
    """
    return int(np.clip(np.ceil(2.3 / np.sqrt(thinness)), FEWEST_FUNCTIONS, MOST_FUNCTIONS))


def solve_contact(basis: TractionBasis, flexibility: FloatArray) -> Traction:
    """Find the traction of unit force under which the face moves by the same depth everywhere.

    Parameters
    ----------
    basis
        J functions.
    flexibility
        (J, J) in m/N: work of each function's traction on the displacement under each other.
    """
    scale = 1.0 / np.sqrt(np.diag(flexibility))
    right = scale * basis.net_force
    coefficients = scale * np.linalg.solve(flexibility * np.outer(scale, scale), right)
    return Traction(basis, coefficients / (coefficients @ basis.net_force))
