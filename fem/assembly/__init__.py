"""Discrete equations of mixed elements: geometry at the points, sums into the unknowns, and the system of equations."""
