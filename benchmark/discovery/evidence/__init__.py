"""What held-out trials say for a candidate, and the search for effects by it."""
