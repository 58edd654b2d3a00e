"""The model's own error in a press: independent functions of depth, and the standard deviation of each.

By default its size and its slope over depth. A discrepancy term on request is a Gaussian process over depth with mean
zero (Kennedy and O'Hagan 2001, Journal of the Royal Statistical Society B 63:425), as a share of the force, in its
Karhunen-Loeve functions. It is confounded with every parameter that bends the force over depth as it may: it widens
intervals, and what it takes up is no finding about the specimen.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmark.response.force_curve import Array

PLAIN = 2
"""Functions that every press has, before those of a discrepancy: size and slope."""
LENGTH = 0.3
"""Length over which a discrepancy changes, as a share of the press's depth. First choice."""
FUNCTIONS = 5
"""Of the discrepancy: they hold 99.7 % of its variance."""
POINTS = 200
LARGEST = 0.3
"""Largest standard deviation of a discrepancy that a fit takes, a share of the force: beyond that there is no model."""


@dataclass(frozen=True)
class ModelError:
    """How a press of the model may be wrong.

    Attributes
    ----------
    trust : float
        Standard deviation of size and of slope (at both ends of the depth), shares of the force.
    discrepancy : float
        Standard deviation of the discrepancy, a share of the force; 0 for none.
    """

    trust: float
    discrepancy: float = 0.0

    @cached_property
    def deviations(self) -> Array:
        """(m,) standard deviations of the functions' factors."""
        size = np.full(PLAIN, self.trust)
        if not self.discrepancy:
            return size
        return np.append(size, self.discrepancy * np.sqrt(_kernel()[0]))

    def functions(self, count: int) -> Array:
        """(m, count) at even depths from 0 to the press's depth."""
        own = np.vstack([np.ones(count), np.linspace(-1.0, 1.0, count)])
        if not self.discrepancy:
            return own
        depth = np.linspace(0.0, 1.0, count)
        return np.vstack([own, [np.interp(depth, _places(), one) for one in _kernel()[1]]])


def _places() -> Array:
    return (np.arange(POINTS) + 0.5) / POINTS


def _kernel() -> tuple[Array, Array]:
    """Variances (f,) and functions (f, k) of unit mean square of a process of unit variance, the largest first."""
    places = _places()
    matrix = np.exp(-0.5 * ((places[:, None] - places) / LENGTH) ** 2) / POINTS
    sizes, vectors = np.linalg.eigh(matrix)
    return sizes[::-1][:FUNCTIONS], (vectors[:, ::-1][:, :FUNCTIONS] * np.sqrt(POINTS)).T
