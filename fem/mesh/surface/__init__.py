"""Specimens bounded by a surface: reading, checking and repairing it, filling it with tetrahedra."""
