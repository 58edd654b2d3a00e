"""The measuring bench: drivers, simulated twins, recording and vision."""
