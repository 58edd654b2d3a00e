"""One printed number beside what it should be: the item, and all items for programs, as columns and in words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import product
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
BY_ROUNDING = "input rounding"
"""Instead of "no", where the printed inputs' own rounding leaves room for the printed number."""


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
    span
        The lowest and highest value that the rounding of the printed inputs leaves; None where there are none.
    """

    item: str
    printed: float
    recomputed: float | None
    agrees: bool
    reason: str
    unit: str
    basis: str
    span: tuple[float, float] | None = None

    @property
    def verdict(self) -> str:
        """Yes, no, or that the rounding of the inputs alone explains the difference."""
        if self.agrees or self.span is None:
            return "yes" if self.agrees else "no"
        half = half_last_digit(self.printed)
        inside = self.span[0] <= self.printed + half and self.span[1] >= self.printed - half
        return BY_ROUNDING if inside else "no"

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
    item: str,
    printed: float,
    recomputed: float | None,
    reason: str,
    unit: str = "",
    basis: str = PRINT,
    span: tuple[float, float] | None = None,
) -> Item:
    """Return the item of a printed number; a value that is not finite counts as none."""
    value = None if recomputed is None or not np.isfinite(recomputed) else float(recomputed)
    agrees = value is not None and abs(value - printed) <= half_last_digit(printed)
    return Item(item, printed, value, agrees, reason, unit, basis, span)


def rounding_span(function: Callable[..., float], *printed: float) -> tuple[float, float]:
    """The lowest and highest value of a function of printed numbers, each anywhere within its rounding.

    The function must be monotone in each of them: it is taken at their ends.
    """
    ends = [(each - half_last_digit(each), each + half_last_digit(each)) for each in printed]
    values = [float(function(*corner)) for corner in product(*ends)]
    return min(values), max(values)


def half_last_digit(printed: float) -> float:
    """Half a unit of the last digit of the shortest text that reads back to `printed`."""
    exponent = Decimal(repr(printed)).as_tuple().exponent
    return 0.5 * float(Decimal(1).scaleb(int(exponent))) * (1.0 + 1e-9)


def document(items: Sequence[Item]) -> dict[str, Any]:
    """Return the content of `reproduce.json`."""
    return {"schema": SCHEMA, "items": [item.to_dict() for item in items]}


def columns(items: Sequence[Item]) -> dict[str, list[Any]]:
    """Return the columns of `items.csv`."""
    names = ("item", "printed", "recomputed", "difference", "unit", "agrees", "verdict", "basis", "reason")
    return {name: [getattr(item, name) for item in items] for name in names}


def headline(items: Sequence[Item]) -> str:
    """Return the outcome in one sentence."""
    agreeing = sum(item.agrees for item in items)
    rounded = sum(item.verdict == BY_ROUNDING for item in items)
    more = f"; the rounding of the inputs explains {rounded} more" if rounded else ""
    return f"{agreeing} of {len(items)} recomputed values round to the printed number{more}"


def by_basis(items: Sequence[Item]) -> list[str]:
    """Say for each basis how many agree."""
    lines = []
    for basis, words in BASES.items():
        group = [item for item in items if item.basis == basis]
        lines.append(f"From {words} ({basis}): {sum(item.agrees for item in group)} of {len(group)} agree")
    return lines


def text_table(items: Sequence[Item]) -> str:
    """Return an aligned table, a line an item."""
    rows = [HEADINGS, *((item.item, *numbers(item)[:2], item.verdict) for item in items)]
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
