"""Shared pieces: the skin-like stack, and layered elasticity worked out apart from the package as the oracle."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.special import j0, j1

from wavemodel import WaveLayer


def _skin(fat: float = 10e-3, poisson_ratio: float = 0.48) -> list[WaveLayer]:
    return [
        WaveLayer("epidermis", 0.1e-3, 1150.0, 1.0e6, poisson_ratio),
        WaveLayer("dermis", 1.5e-3, 1116.0, 1.0e5, poisson_ratio),
        WaveLayer("fat", fat, 971.0, 2.0e4, poisson_ratio),
    ]


@pytest.fixture(scope="session")
def skin() -> Callable[..., list[WaveLayer]]:
    """Factory of 0.1 mm, 1.5 mm and `fat` of 1, 0.1 and 0.02 MPa."""
    return _skin


def _silicone(thickness: float = 4e-3, poisson_ratio: float = 0.49) -> list[WaveLayer]:
    return [WaveLayer("silicone", thickness, 1100.0, 4e5, poisson_ratio)]


@pytest.fixture(scope="session")
def silicone() -> Callable[..., list[WaveLayer]]:
    """Factory of the phantom's sheet: 4 mm, 400 kPa, nu 0.49."""
    return _silicone


@dataclass(frozen=True)
class EndlessOracle:
    """Exact statics of layers bonded to a rigid base, laterally endless, by waves that decay from each face.

    In a layer of thickness h, with zeta = k z from its top and eta = k (h - z) from its bottom, a solution of
    Navier's equations that decays downwards is U = (A + B zeta) e^-zeta, W = -(A + kappa B + B zeta) e^-zeta; its
    mirror image decays upwards. Four amplitudes a layer follow from tractions and displacements at the faces.
    """

    layers: Sequence[WaveLayer]

    @staticmethod
    def _state(layer: WaveLayer, k: float, depth: float) -> np.ndarray:
        """(4, 4): U, W, shear and normal traction on a horizontal plane, by amplitude."""
        shear, kappa, lame = layer.shear_modulus, 3.0 - 4.0 * layer.poisson_ratio, layer.lame_modulus
        columns = []
        for sign, zeta in ((1.0, k * depth), (-1.0, k * (layer.thickness - depth))):
            decay = np.exp(-zeta)
            for a, b in ((1.0, 0.0), (0.0, 1.0)):
                u, w = (a + b * zeta) * decay, -(a + kappa * b + b * zeta) * decay
                du, dw = (b - a - b * zeta) * decay, (a + kappa * b + b * zeta - b) * decay
                shearing = shear * k * (du + w)
                pulling = k * (lame * (dw - u) + 2.0 * shear * dw)
                columns.append([u, sign * w, sign * shearing, pulling])
        return np.array(columns).T

    def compliance(self, k: float) -> np.ndarray:
        """(L, 2, 2) U, W of each top face per unit surface load along U, W."""
        count = len(self.layers)
        matrix, right = np.zeros((4 * count, 4 * count)), np.zeros((4 * count, 2))
        tops = [self._state(layer, k, 0.0) for layer in self.layers]
        bottoms = [self._state(layer, k, layer.thickness) for layer in self.layers]
        matrix[0:2, 0:4], right[0:2] = -tops[0][2:], np.eye(2)
        for i in range(count - 1):
            matrix[4 * i + 2 : 4 * i + 6, 4 * i : 4 * i + 4] = bottoms[i]
            matrix[4 * i + 2 : 4 * i + 6, 4 * i + 4 : 4 * i + 8] = -tops[i + 1]
        matrix[-2:, -4:] = bottoms[-1][:2]
        rows = np.abs(matrix).max(axis=1)
        columns = np.abs(matrix / rows[:, None]).max(axis=0)
        waves = np.linalg.solve(matrix / rows[:, None] / columns, right / rows[:, None]) / columns[:, None]
        return np.stack([tops[i][:2] @ waves[4 * i : 4 * i + 4] for i in range(count)])

    def deflection(self, radii: np.ndarray, transform: Callable, limit: float, far: float) -> np.ndarray:
        """(L, R) deflection under a unit force whose load along U and W at k is `transform(k)`.

        The integral stops at `limit` (rad/m) with a soft end, so that what is beyond averages out; `far` is the
        largest distance that must be resolved (m).
        """
        panels = int(np.ceil(limit * far / 4.0)) + 20
        point, weight = np.polynomial.legendre.leggauss(6)
        width = limit / panels
        k = ((np.arange(panels) + 0.5)[:, None] * width + 0.5 * width * point).ravel()
        dk = np.tile(0.5 * width * weight, panels)
        table = np.geomspace(k[0] * 0.999, limit, 500)
        values = np.stack([self.compliance(x)[:, 1] for x in table]) * table[:, None, None]
        faces = CubicSpline(np.log(table), values)(np.log(k))
        soft = np.where(k < 0.5 * limit, 1.0, np.cos(np.pi * (k / limit - 0.5)) ** 2)
        amplitude = np.einsum("nlj,nj->ln", faces, transform(k)) * (soft * dk / (2.0 * np.pi))
        return amplitude @ j0(np.outer(k, radii))


@pytest.fixture(scope="session")
def oracle() -> type[EndlessOracle]:
    return EndlessOracle


@pytest.fixture(scope="session")
def uniform_load() -> Callable[[float], Callable]:
    """Transform of a uniform pressure of unit force on a disc."""

    def of_radius(radius: float) -> Callable:
        return lambda k: np.stack([np.zeros_like(k), 2.0 * j1(k * radius) / (k * radius)], axis=-1)

    return of_radius
