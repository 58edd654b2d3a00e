"""One printed number beside what it should be: the item, and all items for programs, as columns and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np

from reports.formatting import format_number

PRINT, SESSION, RUN = "print", "session", "5 N run"
BASES = {
    PRINT: "the article's other printed numbers",
    SESSION: "the shipped session of trials, which are synthetic",
    RUN: "FEM and wave model run here under 5 N",
}
"""What an item can be recomputed from, in words."""
SCHEMA = 1
ROUND_OFF = 1e-12
NO_BREAK = "\N{NO-BREAK SPACE}"
HEADINGS = ("item", "printed", "recomputed", "agrees")


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


def document(items: Sequence[Item]) -> dict[str, Any]:
    """Return the content of `reproduce.json`."""
    return {"schema": SCHEMA, "items": [item.to_dict() for item in items]}


def columns(items: Sequence[Item]) -> dict[str, list[Any]]:
    """Return the columns of `items.csv`."""
    names = ("item", "printed", "recomputed", "difference", "unit", "agrees", "basis", "reason")
    return {name: [getattr(item, name) for item in items] for name in names}


def headline(items: Sequence[Item]) -> str:
    """Return the outcome in one sentence."""
    agreeing = sum(item.agrees for item in items)
    return f"{agreeing} of {len(items)} recomputed values round to the printed number"


def by_basis(items: Sequence[Item]) -> list[str]:
    """Say for each basis how many agree."""
    lines = []
    for basis, words in BASES.items():
        group = [item for item in items if item.basis == basis]
        lines.append(f"From {words} ({basis}): {sum(item.agrees for item in group)} of {len(group)} agree")
    return lines


def text_table(items: Sequence[Item]) -> str:
    """Return an aligned table, a line an item."""
    rows = [HEADINGS, *((item.item, *numbers(item)[:2], "yes" if item.agrees else "no") for item in items)]
    widths = [max(len(row[place]) for row in rows) for place in range(len(HEADINGS))]
    return "\n".join(f"{row[0]:<{widths[0]}}  {row[1]:>{widths[1]}}  {row[2]:>{widths[2]}}  {row[3]}" for row in rows)


def numbers(item: Item) -> tuple[str, str, str]:
    """Printed number, recomputed number and difference as people read them."""
    nothing = float("nan")
    recomputed = nothing if item.recomputed is None else item.recomputed
    difference = nothing if item.difference is None else item.difference
    rounding = ROUND_OFF * max(abs(item.printed), abs(recomputed))
    shown = (
        format_number(item.printed, 7, trim=True),
        format_number(recomputed, 7, trim=True),
        format_number(0.0 if abs(difference) <= rounding else difference, 3, trim=True),
    )
    first, second, third = (text.replace(" ", NO_BREAK) for text in shown)
    return first, second, third
