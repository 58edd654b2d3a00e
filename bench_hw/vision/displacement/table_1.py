"""The article's Table 1, in the article's own way (`published_variables`) and with dimensions (`sound_variables`).

The article's way mixes units as it does: O(x) and p(y) are parabolas fitted to displacement (mm) over frame number and
averaged over the markers; then x and y are taken for millimetres. d makes d O p the depth of the tool at the frame of
the largest radius (section 3.3.3). Markers on opposite sides of the tool move in opposite ways, so that the averages
may cancel, as the article notes; d is then beyond all bounds. a = b is the diameter of that circle. lambda divides m/s
by mm. B is eq. (3) with eqs. (4) to (6); the value the article prints follows only if sin(n pi y / b) is written as
sin(pi x / a), which is given beside it.

With dimensions (lengths in metres, shapes without a unit, lambda in 1/s) the initial deflection is f(x, y) =
d O(x) p(y) with O and p parabolas of place, 1 in the middle and 0 at the border of a window a x b; d is the depth
itself. What a camera from below can tell of the shape is the slope: markers on the lower face of a sheet of thickness h
move by u = -(h / 2) grad f, so for a parabola by u_x = 4 h d x p(y) / a^2. That gives a and b, each from its own axis.
Without the thickness they are the diameter of the largest circle, as in the article. B = (4 / a b) int int f sin sin =
4 (16 / pi^3)^2 d, and lambda = c pi sqrt(1 / a^2 + 1 / b^2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.displacement.fits import fit_parabolas, largest_sample
from bench_hw.vision.displacement.tracks import FloatArray

Coefficients = tuple[float, float, float]
PAPER_C2 = 85.56
"""c^2 as printed, m^2/s^2."""
SHAPE = 4.0 * (16.0 / np.pi**3) ** 2
"""B over d: the first sine's share of a product of parabolas."""
_ROUNDS = 50


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


def published_variables(moved: FloatArray, radius: FloatArray, depth: FloatArray) -> PublishedVariables:
    """Compute Table 1 from the frames with deformation.

    Parameters
    ----------
    moved : ndarray, shape (n, m, 2)
        Displacements of the markers, m, after the causal moving average; NaN where not known.
    radius : ndarray, shape (n,)
        Of the circle through the nine inner markers, m.
    depth : ndarray, shape (n,)
        Of the tool, m.

    Raises
    ------
    InputError
        No radius is known, or in no frame did anything move.
    """
    if not len(moved):
        raise InputError("in no frame of the film did the markers move; the article's variables need one that did")
    fits = fit_parabolas(np.arange(len(moved), dtype=np.float64), moved * 1e3)
    o, p = (
        (float(np.nanmean(fits.a[:, axis])), float(np.nanmean(fits.b[:, axis])), float(np.nanmean(fits.c[:, axis])))
        for axis in (0, 1)
    )
    frame = largest_sample(np.arange(len(radius), dtype=np.float64), radius).frame
    with np.errstate(divide="ignore", invalid="ignore"):
        d = float(np.float64(depth[frame]) * 1e3 / (_value(o, frame) * _value(p, frame)))
    return evaluate(o, p, d, 2e3 * float(radius[frame]))


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


@dataclass(frozen=True, slots=True)
class SoundVariables:
    """The same variables with dimensions.

    Parameters
    ----------
    o, p : tuple of 3 floats
        Coefficients of x^2 (1/m^2), x (1/m) and 1, x from the border of the window.
    d : float
        Depth, m.
    a, b : float
        Sides of the window, m.
    c : float
        Wave speed, m/s.
    wave_number : float
        lambda_11, an angular frequency, 1/s.
    amplitude : float
        B_11, m.
    """

    o: tuple[float, float, float]
    p: tuple[float, float, float]
    d: float
    a: float
    b: float
    c: float
    wave_number: float
    amplitude: float


def sound_variables(
    rest: FloatArray, moved: FloatArray, radius: float, depth: float, speed: float, thickness: float | None = None
) -> SoundVariables:
    """Compute the variables at the instant of the largest radius.

    Parameters
    ----------
    rest : ndarray, shape (k, 2)
        Where the markers around the tool rest, m from the tool axis.
    moved : ndarray, shape (k, 2)
        How far they have moved, m; perspective corrected. NaN where not known.
    radius : float
        Of the largest circle through the nine inner markers, m.
    depth : float
        Of the sheet's middle, m.
    speed : float
        c = sqrt(T / (rho h)), T the tension in N/m, m/s.
    thickness : float, optional
        Of the sheet, m: a and b are then measured by the markers' motion.

    Raises
    ------
    InputError
        A length or the speed is not positive, or the markers do not move outwards.
    """
    for name, value, unit in (("radius", radius, "m"), ("depth", depth, "m"), ("speed", speed, "m/s")):
        if not value > 0.0:
            raise InputError(f"{name} = {value:g} {unit}; allowed: more than 0")
    a, b = (2.0 * radius, 2.0 * radius) if thickness is None else _window(rest, moved, 4.0 * thickness * depth)
    o, p = ((-4.0 / side**2, 4.0 / side, 0.0) for side in (a, b))
    wave_number = speed * np.pi * float(np.sqrt(1.0 / a**2 + 1.0 / b**2))
    return SoundVariables(o, p, depth, a, b, speed, wave_number, SHAPE * depth)


def _window(rest: FloatArray, moved: FloatArray, strength: float) -> tuple[float, float]:
    """Sides a, b with u_x = strength x p(y) / a^2 and u_y = strength y O(x) / b^2, by least squares in turn."""
    if not strength > 0.0:
        raise InputError("thickness times depth is not positive; allowed: more than 0 m")
    known = np.isfinite(moved).all(axis=1)
    place, way = rest[known], moved[known]
    inverse = np.zeros(2)
    for _ in range(_ROUNDS):
        shape = 1.0 - 4.0 * inverse * place**2
        reach = place * shape[:, ::-1]
        inverse = (way * reach).sum(axis=0) / (strength * (reach**2).sum(axis=0))
    if not (np.isfinite(inverse).all() and (inverse > 0.0).all()):
        raise InputError("the markers around the tool do not move outwards: no window fits; allowed: a press")
    return float(inverse[0] ** -0.5), float(inverse[1] ** -0.5)


def side_by_side(published: PublishedVariables, sound: SoundVariables) -> list[dict[str, Any]]:
    """Give both ways as rows with `variable`, `paper`, `paper_unit`, `sound`, `sound_unit`."""
    rows = [
        ("O(x)", published.o, "mm over frame number, used as mm", sound.o, "1/m2, 1/m, 1"),
        ("p(y)", published.p, "mm over frame number, used as mm", sound.p, "1/m2, 1/m, 1"),
        ("d", published.d, "none that fits", sound.d, "m"),
        ("a", published.a, "mm", sound.a, "m"),
        ("b", published.b, "mm", sound.b, "m"),
        ("c", float(np.sqrt(published.c2)), "m/s", sound.c, "m/s"),
        ("lambda_11", published.wave_number, "m/s over mm", sound.wave_number, "1/s"),
        ("B_11", published.amplitude, "called mm", sound.amplitude, "m"),
        ("B_11 as printed", published.amplitude_as_printed, "called mm", None, ""),
    ]
    names = ("variable", "paper", "paper_unit", "sound", "sound_unit")
    return [dict(zip(names, row, strict=True)) for row in rows]
