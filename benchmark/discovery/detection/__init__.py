"""Is there a disagreement, and where: residuals in cells, tested by sign flips of whole trials."""
