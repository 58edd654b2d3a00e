"""The published model: one wave of one membrane, as printed and corrected."""

from wavemodel.published.membrane import VARIANTS, PublishedWave, Recomputed, table_one

__all__ = ["VARIANTS", "PublishedWave", "Recomputed", "table_one"]
