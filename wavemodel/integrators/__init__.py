"""Integrators in time: exact for piecewise-linear loads, and the quasi-static reduction."""
