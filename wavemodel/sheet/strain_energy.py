"""Elastic energy of the deflected sheet at points along a radius, with its first and second derivatives.

Reissner's sheet of revolution at any size of deflection: a point z below the neutral plane moves to

    radius r + u + z t sin(phi),   depth w + z t cos(phi),

with the section's rotation phi and its thinning t. With the stretch along the section's normal, the shear and the
curvatures

    stretch = (1 + u') cos(phi) - w' sin(phi),   shear = (1 + u') sin(phi) + w' cos(phi),
    hoop = 1 + u / r,   bend = phi',   twist = sin(phi) / r,   t = (stretch hoop)^-m,

the fibres are stretched by l1 = stretch + z t bend and l2 = hoop + z t twist. A neo-Hookean sheet then has the energy
per area sum over z of W(l1, l2) + S shear^2 / 2. For small deflections it is Reissner's plate, for large ones of thin
sheets the membrane. With no stress across the sheet

    W = G/2 (l1^2 + l2^2 + l3^2 - 3 - 2 ln J) + lam/2 (ln J)^2,    G (l3^2 - 1) + lam ln J = 0,

the second from dW/dl3 = 0. In small strain it is Hooke's law with the same G and lam.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.sheet.section import SheetSection

STRAINS = 5
"""u', u / r, w', phi, phi'."""
NEWTON_STEPS = 8


@dataclass(frozen=True)
class EnergyDensity:
    """A quantity at p points; the derivatives by (u', u / r, w', phi, phi').

    Attributes
    ----------
    value
        (p,), of the energy per reference area in J/m2.
    gradient, hessian
        (5, p) and (5, 5, p).
    """

    value: FloatArray
    gradient: FloatArray
    hessian: FloatArray


def energy_density(
    section: SheetSection, radius: FloatArray, strain: FloatArray, pretension: float = 0.0
) -> EnergyDensity:
    """Energy of the sheet.

    Parameters
    ----------
    section
        Its cross-section.
    radius
        (p,) in m.
    strain
        (5, p).
    pretension
        In N/m, equal in all directions. At rest the clamp holds it; only its work on turned sections counts.
    """
    measure, slope, curve = _measures(radius, strain)
    value, by_measure, twice = _fibres(section, measure)
    value = value + pretension * (measure[0] - 1.0 - strain[0])
    by_measure[0] += pretension
    gradient = np.einsum("ap,aip->ip", by_measure, slope)
    gradient[0] -= pretension
    hessian = np.einsum("abp,aip,bjp->ijp", twice, slope, slope, optimize=True)
    hessian += np.einsum("ap,aijp->ijp", by_measure, curve, optimize=True)
    return EnergyDensity(value, gradient, hessian)


def vertical_span(power: float, radius: FloatArray, strain: FloatArray) -> EnergyDensity:
    """T cos(phi), how much of a section's height remains upright, with its derivatives by the strains."""
    measure, slope, curve = _measures(radius, strain)
    t, by, twice = _thinning(measure[0], measure[1], power)
    cos, sin = np.cos(strain[3]), np.sin(strain[3])
    rate = np.einsum("ap,aip->ip", by, slope[:2])
    bent = np.einsum("abp,aip,bjp->ijp", twice, slope[:2], slope[:2], optimize=True)
    bent += np.einsum("ap,aijp->ijp", by, curve[:2])
    gradient, hessian = rate * cos, bent * cos
    gradient[3] -= t * sin
    hessian[3] -= rate * sin
    hessian[:, 3] -= rate * sin
    hessian[3, 3] -= t * cos
    return EnergyDensity(t * cos, gradient, hessian)


def _measures(radius: FloatArray, strain: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stretch, hoop, bend, twist and shear (5, p), their derivatives by the strains (5, 5, p) and (5, 5, 5, p)."""
    along, ring, fall, turn, bend = strain
    cos, sin = np.cos(turn), np.sin(turn)
    stretch, shear = (1.0 + along) * cos - fall * sin, (1.0 + along) * sin + fall * cos
    measure = np.stack([stretch, 1.0 + ring, bend, sin / radius, shear])
    slope = np.zeros((5, STRAINS, turn.size))
    slope[0, 0], slope[0, 2], slope[0, 3] = cos, -sin, -shear
    slope[1, 1] = slope[2, 4] = 1.0
    slope[3, 3] = cos / radius
    slope[4, 0], slope[4, 2], slope[4, 3] = sin, cos, stretch
    curve = np.zeros((5, STRAINS, STRAINS, turn.size))
    curve[0, 0, 3] = curve[0, 3, 0] = -sin
    curve[0, 2, 3] = curve[0, 3, 2] = -cos
    curve[0, 3, 3] = -stretch
    curve[3, 3, 3] = -sin / radius
    curve[4, 0, 3] = curve[4, 3, 0] = cos
    curve[4, 2, 3] = curve[4, 3, 2] = -sin
    curve[4, 3, 3] = -shear
    return measure, slope, curve


def _fibres(section: SheetSection, measure: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Energy (p,) by stretch, hoop, bend, twist and shear, its gradient (5, p) and Hessian (5, 5, p)."""
    stretch, hoop, _, _, shear = measure
    z = section.z[:, None]
    thin = _thinning(stretch, hoop, section.thinning)
    first = _fibre(measure, 0, z, thin)
    second = _fibre(measure, 1, z, thin)
    law = plane_stress(first[0], second[0], section.shear_modulus[:, None], section.lame_modulus[:, None])
    weight = section.weight
    value = weight @ law.energy + 0.5 * section.shear * shear**2
    gradient, hessian = np.zeros((5, shear.size)), np.zeros((5, 5, shear.size))
    gradient[:4] = np.einsum("s,sp,isp->ip", weight, law.first, first[1])
    gradient[:4] += np.einsum("s,sp,isp->ip", weight, law.second, second[1])
    gradient[4] = section.shear * shear
    mixed = np.einsum("s,sp,isp,jsp->ijp", weight, law.first_second, first[1], second[1], optimize=True)
    hessian[:4, :4] = mixed + np.swapaxes(mixed, 0, 1)
    for modulus, stress, (_, slope, curve) in (
        (law.first_first, law.first, first),
        (law.second_second, law.second, second),
    ):
        hessian[:4, :4] += np.einsum("s,sp,isp,jsp->ijp", weight, modulus, slope, slope, optimize=True)
        hessian[:4, :4] += np.einsum("s,sp,ijsp->ijp", weight, stress, curve, optimize=True)
    hessian[4, 4] = section.shear
    return value, gradient, hessian


def _thinning(stretch: FloatArray, hoop: FloatArray, power: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """T (p,), its derivatives by stretch and hoop (2, p) and (2, 2, p)."""
    t = (stretch * hoop) ** -power
    slope = -power * t / np.stack([stretch, hoop])
    curve = np.empty((2, 2, t.size))
    curve[0, 0] = power * (power + 1.0) * t / stretch**2
    curve[1, 1] = power * (power + 1.0) * t / hoop**2
    curve[0, 1] = curve[1, 0] = power**2 * t / (stretch * hoop)
    return t, slope, curve


def _fibre(
    measure: FloatArray, which: int, z: FloatArray, thin: tuple[FloatArray, FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stretch (s, p) of the fibres along (0) or round (1), its derivatives (4, s, p) and (4, 4, s, p)."""
    t, t_slope, t_curve = thin
    turn = measure[2 + which]
    value = measure[which] + z * (t * turn)
    slope, curve = np.zeros((4, *value.shape)), np.zeros((4, 4, *value.shape))
    slope[:2] = z * (t_slope * turn)[:, None]
    slope[which] += 1.0
    slope[2 + which] = z * t
    curve[:2, :2] = z * (t_curve * turn)[:, :, None]
    curve[:2, 2 + which] = curve[2 + which, :2] = z * t_slope[:, None]
    return value, slope, curve


@dataclass(frozen=True)
class PlaneStress:
    """Answer to the two principal stretches, arrays of one shape.

    Attributes
    ----------
    energy
        Per reference volume, Pa.
    first, second
        Nominal stresses dW/dl1 and dW/dl2, Pa.
    first_first, first_second, second_second
        Their derivatives, Pa.
    """

    energy: FloatArray
    first: FloatArray
    second: FloatArray
    first_first: FloatArray
    first_second: FloatArray
    second_second: FloatArray


def thickness_stretch(area: FloatArray, shear: FloatArray, lame: FloatArray) -> FloatArray:
    """l3 by Newton's method in ln l3, from the small-strain value; `area` is l1 l2."""
    log_area = np.log(area)
    x = -lame / (lame + 2.0 * shear) * log_area
    for _ in range(NEWTON_STEPS):
        square = np.exp(2.0 * x)
        x = x - (shear * (square - 1.0) + lame * (log_area + x)) / (2.0 * shear * square + lame)
    return np.exp(x)


def plane_stress(l1: FloatArray, l2: FloatArray, shear: FloatArray, lame: FloatArray) -> PlaneStress:
    """Energy, nominal stresses and moduli at stretches l1, l2 above zero (any one shape; the moduli broadcast)."""
    l3 = thickness_stretch(l1 * l2, shear, lame)
    log_volume = np.log(l1 * l2 * l3)
    pull = lame * log_volume - shear
    energy = 0.5 * shear * (l1**2 + l2**2 + l3**2 - 3.0 - 2.0 * log_volume) + 0.5 * lame * log_volume**2
    # ln J changes with ln l1 by 1 + d ln l3 / d ln l1 = 2 G l3^2 / (2 G l3^2 + lam).
    rate = lame * 2.0 * shear * l3**2 / (2.0 * shear * l3**2 + lame)
    return PlaneStress(
        energy=energy,
        first=shear * l1 + pull / l1,
        second=shear * l2 + pull / l2,
        first_first=shear + (rate - pull) / l1**2,
        first_second=rate / (l1 * l2),
        second_second=shear + (rate - pull) / l2**2,
    )
