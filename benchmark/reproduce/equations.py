"""Eqs. (7) and (8) of the article, number by number; (5) and (6) are with Table 1, which prints the same."""

from __future__ import annotations

import numpy as np

from benchmark.reproduce.item import Item, compare
from benchmark.reproduce.printed import PRESS_MM
from benchmark.reproduce.table_one import side_of_frequency
from wavemodel import PublishedWave, WaveError
from wavemodel.published import printed

MILLI = 1e-3
ROUNDING = 0.5e-4
"""Half of the last digit of the printed lambda."""


def equation_items() -> tuple[Item, ...]:
    """Return the items of eqs. (7) and (8)."""
    return (*_equation_7(), *_equation_8())


def _equation_7() -> list[Item]:
    as_printed, corrected = PublishedWave("as_printed"), PublishedWave("corrected")
    amplitude = float(corrected.coefficient[0, 0]) / MILLI
    frequency = float(as_printed.frequency[0, 0])
    side, low, high = (_side(printed.FREQUENCY + shift) for shift in (0.0, ROUNDING, -ROUNDING))
    why_side = (
        f"from the printed c and lambda; the rounding of lambda leaves {low:.4f} to {high:.4f} mm, which holds the "
        "printed side"
    )
    middle = np.array([0.5 * as_printed.side])
    deep = float(as_printed.deflection(middle, middle, 0.0)[0, 0]) / MILLI
    return [
        compare(
            "Eq. (7): amplitude by eq. (3), downwards",
            -printed.COEFFICIENT,
            -amplitude,
            "eq. (3) as it stands; the printed number follows if sin(n pi y / b) is written as sin(pi x / a)",
            "mm",
        ),
        compare(
            "Eq. (7): amplitude as B_11 of Table 1",
            -printed.COEFFICIENT,
            printed.COEFFICIENT,
            "Table 1 prints it with the other sign: eq. (7) counts upwards, f of eq. (4) downwards",
            "mm",
        ),
        compare("Eq. (7): factor of t", printed.FREQUENCY, frequency, "c in m/s over a in mm", "1/ms"),
        *(compare(f"Eq. (7): side under {axis}", printed.SIDE, side, why_side, "mm") for axis in ("x", "y")),
        compare(
            "Eq. (7): depth in the middle at t = 0, against the press of section 3.3.3",
            PRESS_MM,
            deep,
            "the wave starts some twenty times as deep as the tool ever was: d, in no proper unit, carries into B_11",
            "mm",
        ),
    ]


def _side(frequency: float) -> float:
    """Return a = b in mm that gives this lambda with the printed c."""
    return side_of_frequency() * printed.FREQUENCY / frequency


def _equation_8() -> list[Item]:
    """Depths fed to eq. (8) and read off eq. (7) again; the article expects what was fed."""
    beyond = "acos(depth / beta) has no value beyond a depth of 1, for beta is at most 1: eq. (8) lacks the amplitude"
    multiple = "eq. (8) lacks the amplitude, so that eq. (7) gives B_11 times the depth that was fed"
    circular = "acos(depth / (|B_11| beta)) / lambda returns what it is fed: circular, it predicts nothing"
    label = "Eq. (8): depth read off eq. (7) for {:g} mm fed in, {}"
    return [
        compare(label.format(1.0, "as printed"), 1.0, _replayed("as_printed", 1.0), multiple, "mm"),
        compare(label.format(PRESS_MM, "as printed"), PRESS_MM, _replayed("as_printed", PRESS_MM), beyond, "mm"),
        compare(
            label.format(PRESS_MM, "with the amplitude put in"),
            PRESS_MM,
            _replayed("corrected", PRESS_MM),
            circular,
            "mm",
        ),
    ]


def _replayed(variant: str, depth_mm: float) -> float | None:
    wave = PublishedWave(variant)
    middle = 0.5 * wave.side
    try:
        return float(wave.replay(np.array([MILLI * depth_mm]), middle, middle)[0]) / MILLI
    except WaveError:
        return None
