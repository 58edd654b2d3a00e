"""The article's printed numbers recomputed, and its figures redrawn: pure comparisons, then one page.

An item is one printed number beside what it should be: those of the article's wave are in `article_wave`, those of its
statistics in `article_statistics`. What has to be run first, the marker chain on the shipped session and two presses to
5 N, is in `evidence`.
"""

from benchmark.reproduce.items import Item
from benchmark.reproduce.reproduction import Reproduced, reproduce

__all__ = ["Item", "Reproduced", "reproduce"]
