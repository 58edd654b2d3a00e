"""A session made ready: motion in segments, trials aligned row by row. Nothing here knows a model."""
