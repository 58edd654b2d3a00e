"""The published membrane, eqs. (1) to (8) of the paper: "as_printed" and "corrected".

u_tt = c^2 (u_xx + u_yy) on a square of side a with zero border (eq. 1), released at rest from f(x, y) (eq. 4):

    u = sum_mn B_mn cos(lambda_mn t) sin(m pi x / a) sin(n pi y / b)             (eq. 2)
    B_mn = 4/(ab) int int f sin(m pi x / a) sin(n pi y / b) dx dy                 (eq. 3)
    lambda_mn = c pi sqrt(m^2 / a^2 + n^2 / b^2)
    f = d O(x) p(y)                                                               (eq. 4 to 6)

The paper keeps m = n = 1 (eq. 7). What differs between the variants:

================== ============================================ =======================================
                   as_printed                                   corrected
================== ============================================ =======================================
B_11               39.2012 mm, which eq. (3) gives when          31.7788 mm, eq. (3) as it stands
                   sin(n pi y / b) is written sin(pi x / a)
lambda_11          1.7409 taken per second, though c is in m/s   1740.9 rad/s
                   and a in mm
time of a depth    acos(depth / beta) / lambda (eq. 8)           acos(depth / (B beta)) / lambda
================== ============================================ =======================================

Deflections are positive downwards here; eq. (7) counts upwards. Either variant returns the depth it was fed or a
multiple of it: it is calibrated on the value it is then compared with, and predicts nothing.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError

# What the paper prints (Table 1 and eqs. 5 to 8), lengths in mm as there.
DEPTH_FACTOR = 14.3321
"""d of eq. (4), mm."""
SIDE = 23.6053
"""a = b, mm."""
SPEED_SQUARED = 85.56
"""c^2, printed without unit; m2/s2."""
SPEED = 9.2496
"""c as printed; it is the root of 85.555 to 85.556, not of 85.56 (9.24986)."""
FREQUENCY = 1.7409
"""lambda_11 as printed: c in m/s over a side in mm, so that its unit is rad/ms."""
COEFFICIENT = 39.2012
"""B_11 as printed, mm."""


@dataclass(frozen=True)
class Parabola:
    """second x^2 + first x + constant, x in mm.

    Attributes
    ----------
    second, first, constant
        In 1/mm2, 1/mm and without unit.
    """

    second: float
    first: float
    constant: float

    def __call__(self, position: FloatArray) -> FloatArray:
        """Value at positions in mm."""
        return np.asarray((self.second * position + self.first) * position + self.constant)


PARABOLA_X = Parabola(-8.393e-6, 0.002, 1.3322)
"""O(x), eq. (5). It was fitted against frame numbers, with its vertex at frame 119, and is used as if x were mm."""
PARABOLA_Y = Parabola(-8.1904e-6, 0.002, 0.9876)
"""p(y), eq. (6), likewise with its vertex at 122."""

VARIANTS = ("as_printed", "corrected")
MILLI = 1e-3


@dataclass(frozen=True)
class PublishedWave:
    """Sum of N x N modes of the published membrane.

    Attributes
    ----------
    variant
        "as_printed" or "corrected".
    modes
        N; the paper has one.

    Raises
    ------
    WaveError
        If the variant is neither word or there is no mode.
    """

    variant: str = "corrected"
    modes: int = 1

    def __post_init__(self) -> None:
        if self.variant not in VARIANTS:
            raise WaveError(f"variant = {self.variant!r} is not allowed: one of {', '.join(VARIANTS)}")
        if self.modes < 1:
            raise WaveError(f"modes = {self.modes} is not allowed: at least 1")

    @property
    def side(self) -> float:
        """Side a = b, m."""
        return SIDE * MILLI

    @cached_property
    def order(self) -> FloatArray:
        """(N,) 1..N."""
        return np.arange(1.0, self.modes + 1.0)

    @cached_property
    def frequency(self) -> FloatArray:
        """(N, N) lambda_mn, rad/s: with the printed c and side, whose mm the printed variant takes for metres."""
        squares = self.order**2
        speed, side = (SPEED, SIDE) if self.variant == "as_printed" else (np.sqrt(SPEED_SQUARED), self.side)
        return np.asarray(speed * np.pi / side * np.sqrt(squares[:, None] + squares))

    @cached_property
    def coefficient(self) -> FloatArray:
        """(N, N) B_mn of eq. (3) with eqs. (4) to (6), m."""
        nodes, weights = _quadrature(self.modes)
        sines = np.sin(np.outer(self.order * np.pi / SIDE, nodes))
        along_x, along_y = PARABOLA_X(nodes) * weights, PARABOLA_Y(nodes) * weights
        if self.variant == "corrected":
            integral = np.outer(sines @ along_x, sines @ along_y)
        else:
            integral = (sines * along_x) @ sines.T * along_y.sum()
        return np.asarray(4.0 * DEPTH_FACTOR / SIDE**2 * integral * MILLI)

    def initial(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """f(x, y) of eq. (4) at (P,) and (Q,) positions in m from the corner: (P, Q) in m."""
        shape = np.outer(PARABOLA_X(x / MILLI), PARABOLA_Y(y / MILLI))
        return np.asarray(DEPTH_FACTOR * MILLI * shape)

    def deflection(self, x: FloatArray, y: FloatArray, time: float) -> FloatArray:
        """u(x, y, t) of eqs. (2) and (7), downwards.

        Parameters
        ----------
        x, y
            (P,) and (Q,) positions from the corner, m.
        time
            In s.

        Returns
        -------
        ndarray (P, Q)
            In m.
        """
        state = self.coefficient * np.cos(self.frequency * time)
        sines_x = np.sin(np.outer(x, self.order * np.pi / self.side))
        sines_y = np.sin(np.outer(y, self.order * np.pi / self.side))
        return np.asarray(sines_x @ state @ sines_y.T)

    def time_of_depth(self, depth: FloatArray, x: float, y: float) -> FloatArray:
        """Time at which the first mode has a depth under the tool, eq. (8).

        Parameters
        ----------
        depth
            (n,) in m.
        x, y
            Tool position from the corner, m.

        Returns
        -------
        ndarray (n,)
            In s. As printed, depth and beta are compared as numbers, the depth in mm.

        Raises
        ------
        WaveError
            If eq. (8) has no solution: the depth is beyond the amplitude (as printed: beyond beta, in mm).
        """
        beta = float(np.sin(np.pi * x / self.side) * np.sin(np.pi * y / self.side))
        reach = MILLI * beta if self.variant == "as_printed" else abs(float(self.coefficient[0, 0])) * beta
        if not np.all(np.abs(depth) <= reach):
            raise WaveError(
                f"depth = {np.abs(depth).max() / MILLI:g} mm is not allowed: eq. (8) reaches {reach / MILLI:g} mm at "
                f"x = {x / MILLI:g} mm, y = {y / MILLI:g} mm"
            )
        return np.asarray(np.arccos(depth / reach) / self.frequency[0, 0])

    def replay(self, depth: FloatArray, x: float, y: float) -> FloatArray:
        """The paper's protocol: feed depths (n,) to eq. (8) and read eq. (7) at that time, (n,) in m.

        Corrected it returns what it was fed; as printed, B_11 in mm times that. It is circular.
        """
        beta = float(np.sin(np.pi * x / self.side) * np.sin(np.pi * y / self.side))
        turn = np.cos(self.frequency[0, 0] * self.time_of_depth(depth, x, y))
        return np.asarray(self.coefficient[0, 0] * beta * turn)


def _quadrature(modes: int) -> tuple[FloatArray, FloatArray]:
    """Gauss points (mm) and weights on the side, exact to rounding for the sines of so many modes."""
    point, weight = np.polynomial.legendre.leggauss(32 + 4 * modes)
    return 0.5 * SIDE * (point + 1.0), 0.5 * SIDE * weight


@dataclass(frozen=True)
class Recomputed:
    """One printed number beside what its equation gives.

    Attributes
    ----------
    item
        What it is, with its equation.
    printed, value
        As printed, and recomputed from the other printed numbers (in the paper's units).
    agrees
        Whether the value rounds to the printed one.
    reason
        Why not, or how.
    """

    item: str
    printed: float
    value: float
    agrees: bool
    reason: str


def table_one() -> tuple[Recomputed, ...]:
    """Table 1 of the paper: c, lambda_11 and B_11."""
    root = float(np.sqrt(SPEED_SQUARED))
    as_printed, corrected = PublishedWave("as_printed"), PublishedWave("corrected")
    by_equation = float(corrected.coefficient[0, 0]) / MILLI
    by_slip = float(as_printed.coefficient[0, 0]) / MILLI
    rows = (
        (
            "c, root of c^2 (eq. 1)",
            SPEED,
            root,
            "the printed c is the root of a c^2 of 85.555 to 85.556, which rounds to 85.56",
        ),
        ("lambda_11 (eq. 3)", FREQUENCY, float(as_printed.frequency[0, 0]), "c in m/s over a in mm: rad/ms"),
        (
            "B_11 (eq. 3 with eqs. 4 to 6)",
            COEFFICIENT,
            by_equation,
            "the equations as they stand; the printed number follows if sin(n pi y / b) is written as sin(pi x / a)",
        ),
        (
            "B_11 with sin(n pi y / b) written as sin(pi x / a)",
            COEFFICIENT,
            by_slip,
            "4d/(ab) int int O(x) p(y) sin^2(pi x / a) dx dy gives the printed number",
        ),
    )
    return tuple(Recomputed(item, old, new, abs(new - old) <= 0.5e-4, reason) for item, old, new, reason in rows)
