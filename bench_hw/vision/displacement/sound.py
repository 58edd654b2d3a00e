"""Table 1 in a way whose dimensions are right: lengths in metres, shapes without a unit, lambda in 1/s.

The initial deflection is f(x, y) = d O(x) p(y) with O and p parabolas of place, 1 in the middle and 0 at the border of
a window a x b; d is the depth itself. What a camera from below can tell of the shape is the slope: markers on the
lower face of a sheet of thickness h move by u = -(h / 2) grad f, so for a parabola by u_x = 4 h d x p(y) / a^2. That
gives a and b, each from its own axis. Without the thickness they are the diameter of the largest circle, as in the
article. B = (4 / a b) int int f sin sin = 4 (16 / pi^3)^2 d, and lambda = c pi sqrt(1 / a^2 + 1 / b^2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bench_hw.errors import InputError
from bench_hw.vision.displacement.published import PublishedVariables
from bench_hw.vision.displacement.tracks import FloatArray

SHAPE = 4.0 * (16.0 / np.pi**3) ** 2
"""B over d: the first sine's share of a product of parabolas."""
_ROUNDS = 50


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
