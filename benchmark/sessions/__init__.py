"""Trial sessions that ship with the product, a folder each; how they were made is said beside them."""

from pathlib import Path

SHIPPED = Path(__file__).parent
HIDDEN_EFFECT = "gel_pad"
"""The session in which an effect is hidden: what `discover` should find there is in gel_pad_truth.toml beside."""
