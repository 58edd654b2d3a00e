"""What the paper prints about its wave (Table 1), recomputed live."""

from dataclasses import dataclass

import numpy as np

from wavemodel.published import printed
from wavemodel.published.membrane import MILLI, PublishedWave


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
    root = float(np.sqrt(printed.SPEED_SQUARED))
    as_printed, corrected = PublishedWave("as_printed"), PublishedWave("corrected")
    by_equation = float(corrected.coefficient[0, 0]) / MILLI
    by_slip = float(as_printed.coefficient[0, 0]) / MILLI
    rows = (
        (
            "c, root of c^2 (eq. 1)",
            printed.SPEED,
            root,
            "the printed c is the root of a c^2 of 85.555 to 85.556, which rounds to 85.56",
        ),
        ("lambda_11 (eq. 3)", printed.FREQUENCY, float(as_printed.frequency[0, 0]), "c in m/s over a in mm: rad/ms"),
        (
            "B_11 (eq. 3 with eqs. 4 to 6)",
            printed.COEFFICIENT,
            by_equation,
            "the equations as they stand; the printed number follows if sin(n pi y / b) is written as sin(pi x / a)",
        ),
        (
            "B_11 with sin(n pi y / b) written as sin(pi x / a)",
            printed.COEFFICIENT,
            by_slip,
            "4d/(ab) int int O(x) p(y) sin^2(pi x / a) dx dy gives the printed number",
        ),
    )
    return tuple(Recomputed(item, old, new, abs(new - old) <= 0.5e-4, reason) for item, old, new, reason in rows)
