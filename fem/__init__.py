"""Finite-element solver of layered soft tissue."""
