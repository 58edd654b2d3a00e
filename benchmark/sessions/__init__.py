"""Trial sessions that ship with the product, a folder each; how they were made is said beside them."""

from pathlib import Path

SHIPPED = Path(__file__).parent
