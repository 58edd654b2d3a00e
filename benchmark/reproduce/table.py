"""The items for programs, as columns, and in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmark.reproduce.item import BASES, Item
from reports.formatting import format_number

SCHEMA = 1
ROUND_OFF = 1e-12
NO_BREAK = "\N{NO-BREAK SPACE}"
HEADINGS = ("item", "printed", "recomputed", "agrees")


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
