"""The article's Table 1 in the article's own way, units mixed as it mixes them.

O(x) and p(y) are parabolas fitted to displacement (mm) over frame number and averaged over the markers; then x and y
are taken for millimetres. d makes d O p the depth of the tool at the frame of the largest radius (section 3.3.3).
Markers on opposite sides of the tool move in opposite ways, so that the averages may cancel, as the article notes; d
is then beyond all bounds. a = b is the diameter of that circle. lambda divides m/s by mm. B is eq. (3) with eqs. (4)
to (6); the value the article prints follows only if sin(n pi y / b) is written as sin(pi x / a), which is given beside
it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.vision.displacement.maximum import largest_sample
from bench_hw.vision.displacement.parabola import fit_parabolas
from bench_hw.vision.displacement.tracks import FloatArray

Coefficients = tuple[float, float, float]
PAPER_C2 = 85.56
"""c^2 as printed, m^2/s^2."""


@dataclass(frozen=True, slots=True)
class PublishedVariables:
    """Table 1.

    Parameters
    ----------
    o, p : tuple of 3 floats
        Coefficients of frame number squared, frame number and 1, mm.
    d : float
        Without a proper unit.
    a, b : float
        mm.
    c2 : float
        m^2/s^2.
    wave_number : float
        lambda_11; the article's number, in none of the units it could have.
    amplitude : float
        B_11 by eqs. (3) to (6).
    amplitude_as_printed : float
        B_11 with the second sine of x instead of y.
    """

    o: Coefficients
    p: Coefficients
    d: float
    a: float
    b: float
    c2: float
    wave_number: float
    amplitude: float
    amplitude_as_printed: float


def published_variables(
    moved: FloatArray, radius: FloatArray, depth: FloatArray, c2: float = PAPER_C2
) -> PublishedVariables:
    """Compute Table 1 from the frames with deformation.

    Parameters
    ----------
    moved : ndarray, shape (n, m, 2)
        Displacements of the markers, m, after the causal moving average; NaN where not known.
    radius : ndarray, shape (n,)
        Of the circle through the nine inner markers, m.
    depth : ndarray, shape (n,)
        Of the tool, m.
    c2 : float
        T / rho as the article has it, m^2/s^2.

    Raises
    ------
    InputError
        No radius is known.
    """
    fits = fit_parabolas(np.arange(len(moved), dtype=np.float64), moved * 1e3)
    o, p = (
        (float(np.nanmean(fits.a[:, axis])), float(np.nanmean(fits.b[:, axis])), float(np.nanmean(fits.c[:, axis])))
        for axis in (0, 1)
    )
    frame = largest_sample(np.arange(len(radius), dtype=np.float64), radius).frame
    with np.errstate(divide="ignore", invalid="ignore"):
        d = float(np.float64(depth[frame]) * 1e3 / (_value(o, frame) * _value(p, frame)))
    return evaluate(o, p, d, 2e3 * float(radius[frame]), c2)


def evaluate(o: Coefficients, p: Coefficients, d: float, a: float, c2: float = PAPER_C2) -> PublishedVariables:
    """Compute lambda and B of Table 1 from its other rows, with b = a."""
    wave_number = float(np.sqrt(c2) * np.pi * np.sqrt(2.0 / a**2))
    with np.errstate(invalid="ignore"):
        amplitude = float(np.float64(4.0 * d / a**2) * _with_sine(o, a) * _with_sine(p, a))
        printed = float(np.float64(4.0 * d / a**2) * _with_square(o, a) * _alone(p, a))
    return PublishedVariables(o, p, d, a, a, c2, wave_number, amplitude, printed)


def _value(parabola: Coefficients, x: float) -> float:
    return float(np.polyval(parabola, x))


def _with_sine(parabola: Coefficients, a: float) -> float:
    """Integral of the parabola times sin(pi x / a) from 0 to a."""
    second, first, constant = parabola
    pi = np.pi
    return float(second * a**3 * (1.0 / pi - 4.0 / pi**3) + first * a**2 / pi + constant * 2.0 * a / pi)


def _with_square(parabola: Coefficients, a: float) -> float:
    """Integral of the parabola times sin(pi x / a)^2 from 0 to a."""
    second, first, constant = parabola
    return float(second * a**3 * (1.0 / 6.0 - 1.0 / (4.0 * np.pi**2)) + first * a**2 / 4.0 + constant * a / 2.0)


def _alone(parabola: Coefficients, a: float) -> float:
    second, first, constant = parabola
    return second * a**3 / 3.0 + first * a**2 / 2.0 + constant * a
