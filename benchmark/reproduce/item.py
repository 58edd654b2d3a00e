"""One printed number beside what it should be."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np

PRINT, SESSION, RUN = "print", "session", "5 N run"
BASES = {
    PRINT: "the article's other printed numbers",
    SESSION: "the shipped session of trials, which are synthetic",
    RUN: "FEM and wave model run here under 5 N",
}
"""What an item can be recomputed from, in words."""


@dataclass(frozen=True)
class Item:
    """One printed number beside what it should be.

    Attributes
    ----------
    item
        Where it is printed, and what it is.
    printed
        As printed.
    recomputed
        In the same unit; None where there is no value.
    agrees
        Whether `recomputed` rounds to the printed number, at its last printed digit.
    reason
        Why they differ, or how the value was recomputed.
    unit
        As the article has it; "" for none.
    basis
        What it was recomputed from, one of `BASES`.
    """

    item: str
    printed: float
    recomputed: float | None
    agrees: bool
    reason: str
    unit: str
    basis: str

    @property
    def difference(self) -> float | None:
        """Recomputed less printed."""
        return None if self.recomputed is None else self.recomputed - self.printed

    def to_dict(self) -> dict[str, Any]:
        """Return the item as `reproduce.json` has it."""
        return {
            "item": self.item,
            "printed": self.printed,
            "recomputed": self.recomputed,
            "agrees": self.agrees,
            "reason": self.reason,
        }


def compare(
    item: str, printed: float, recomputed: float | None, reason: str, unit: str = "", basis: str = PRINT
) -> Item:
    """Return the item of a printed number; a value that is not finite counts as none."""
    value = None if recomputed is None or not np.isfinite(recomputed) else float(recomputed)
    agrees = value is not None and abs(value - printed) <= half_last_digit(printed)
    return Item(item, printed, value, agrees, reason, unit, basis)


def half_last_digit(printed: float) -> float:
    """Half a unit of the last digit of the shortest text that reads back to `printed`."""
    exponent = Decimal(repr(printed)).as_tuple().exponent
    return 0.5 * float(Decimal(1).scaleb(int(exponent))) * (1.0 + 1e-9)
