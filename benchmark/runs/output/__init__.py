"""Where a result goes and what is in its folder: place, manifest-safe writing, unfinished work, JSON, pictures."""
