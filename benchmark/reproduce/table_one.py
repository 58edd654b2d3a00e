"""Table 1 of the article (with eqs. 5 and 6, which print the same coefficients), number by number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from benchmark.reproduce.evidence import Chain
from benchmark.reproduce.item import SESSION, Item, compare
from benchmark.reproduce.printed import PRESS_MM
from wavemodel.published import PublishedWave, printed, table_one

MODES = 15
UNITS = ("mm/frame²", "mm/frame", "mm")
POWERS = ("coefficient of x²", "coefficient of x", "constant")


def table_one_items(chain: Chain) -> tuple[Item, ...]:
    """Return the items; what the article measured on its phantom is measured on the synthetic session."""
    return (
        *_parabola("O(x), eq. (5)", "O", printed.PARABOLA_X, chain),
        *_parabola("p(y), eq. (6)", "p", printed.PARABOLA_Y, chain),
        depth_factor(),
        squared_speed(),
        *(mode_number(name) for name in ("m", "n")),
        *(_side(name, chain) for name in ("a", "b")),
        *_wave(),
        _frequency_in_si(),
    )


def _parabola(label: str, name: str, parabola: printed.Parabola, chain: Chain) -> list[Item]:
    vertex = -0.5 * parabola.first / parabola.second
    specimen = "synthetic " if chain.synthetic else ""
    reason = (
        f"measured on the article's phantom, whose trials are not published; this is the mean over {chain.trials} "
        f"{specimen}trials in the same way, in which markers on opposite sides of the tool cancel; the printed vertex "
        f"lies at {vertex:.0f}, so it is a fit over frame numbers, used as if they were mm"
    )
    values = (parabola.second, parabola.first, parabola.constant)
    return [
        compare(
            f"Table 1: {label}, {POWERS[place]}",
            value,
            chain.variables.get(f"published.{name}_{2 - place}"),
            reason,
            UNITS[place],
            SESSION,
        )
        for place, value in enumerate(values)
    ]


def depth_factor() -> Item:
    """Return d of eq. (4): what makes f the depth of the tool in the middle of the window."""
    middle = np.array([0.5 * printed.SIDE])
    shape = float(printed.PARABOLA_X(middle)[0] * printed.PARABOLA_Y(middle)[0])
    reason = (
        f"f = d O p must be the {PRESS_MM:g} mm of section 3.3.3 in the middle of the window; with the printed d it is "
        f"{printed.DEPTH_FACTOR * shape:.2f} mm there"
    )
    return compare("Table 1: d", printed.DEPTH_FACTOR, PRESS_MM / shape, reason, "mm")


def squared_speed() -> Item:
    """Return c^2 from the printed c."""
    reason = (
        "the square of the printed c; T and rho are not printed, and with T in N and rho in kg/m³, as eq. (1) has "
        "them, T / rho would not be m²/s²"
    )
    return compare("Table 1: c²", printed.SPEED_SQUARED, printed.SPEED**2, reason, "m²/s²")


def mode_number(name: str) -> Item:
    """Return m or n of the largest coefficient of eq. (3)."""
    size = np.abs(PublishedWave("corrected", MODES).coefficient)
    place = np.unravel_index(int(size.argmax()), size.shape)[0 if name == "m" else 1]
    share = float(size[0, 0] ** 2 / (size**2).sum())
    reason = (
        f"assumed, not computed, in the article; m = n = 1 is the largest of the first {MODES} x {MODES} coefficients "
        f"of eq. (3) and holds {100 * share:.0f} % of the sum of their squares, for f is a nearly flat box"
    )
    return compare(f"Table 1: {name}", 1.0, float(place + 1), reason)


def _side(name: str, chain: Chain) -> Item:
    reason = (
        "the diameter of the largest circle through the nine markers: that of another specimen, whose markers are 8 mm "
        f"apart, for the article's trials are not published; its own c and lambda give {side_of_frequency():.4f} mm"
    )
    return compare(f"Table 1: {name}", printed.SIDE, chain.variables.get(f"published.{name}"), reason, "mm", SESSION)


def side_of_frequency() -> float:
    """Return a = b in mm from the printed c and lambda_11."""
    return float(printed.SPEED * np.pi * np.sqrt(2.0) / printed.FREQUENCY)


def _wave() -> Sequence[Item]:
    units: Mapping[float, str] = {printed.SPEED: "m/s", printed.FREQUENCY: "1/ms", printed.COEFFICIENT: "mm"}
    return [
        compare(f"Table 1: {row.item}", row.printed, row.value, row.reason, units[row.printed]) for row in table_one()
    ]


def _frequency_in_si() -> Item:
    value = float(PublishedWave("corrected").frequency[0, 0])
    reason = "with a in m like c, lambda is in 1/s: the printed one divides m/s by mm"
    return compare("Table 1: lambda_11 taken per second, as eq. (2) does", printed.FREQUENCY, value, reason, "1/s")
