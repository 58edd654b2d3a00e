"""The article's printed numbers recomputed, and its figures redrawn: pure comparisons, then one page.

An item is one printed number beside what it should be. Each group of items is a file: `table_one`, `equations`,
`table_two`, `text`. What has to be run first, the marker chain on the shipped session and two presses to 5 N, is in
`evidence`.
"""

from benchmark.reproduce.carrying_out import Reproduced, reproduce
from benchmark.reproduce.item import Item

__all__ = ["Item", "Reproduced", "reproduce"]
