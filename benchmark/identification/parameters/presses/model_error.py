"""The model's own error in a press: independent functions of depth, and the standard deviation of each.

Its size, its slope over depth, and a bend: a Gaussian process over depth with mean zero (Kennedy and O'Hagan 2001,
Journal of the Royal Statistical Society B 63:425), as a share of the force, in its Karhunen-Loeve functions. The bend
is confounded with every parameter that bends the force over depth as it may: it widens intervals, and what it takes up
is no finding about the specimen. Where one tool alone tells layers apart by that bend, intervals rest on its size.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmark.response.force_curve import Array

PLAIN = 2
"""Functions before those of the bend: size and slope."""
LENGTH = 0.3
"""Length over which a bend changes, as a share of the press's depth. First choice."""
FUNCTIONS = 5
"""Of the bend: they hold 99.7 % of its variance."""
COUNT = PLAIN + FUNCTIONS
POINTS = 200
LARGEST = 0.3
"""Largest standard deviation of a discrepancy that a fit takes, a share of the force: beyond that there is no model."""
OTHER_CODE = 0.002
"""Standard deviation of the bend between codes on fine meshes, a share of the force.

Under a sharp tool of 3 mm on skin another code leaves 0.06 to 0.14 % (rms) round a line over depth, whatever the mesh
of either; over a hole 0.01 to 0.02 %.
"""
SHARE_OF_MESH = 0.5
"""Standard deviation of the bend that elements of finite size make, over the error that is estimated for the force.

Between meshes the bend was 0.05 to 0.2 of that error on three layers; more is taken, for it is no estimate of a shape.
"""
MESH_UNTOLD = 0.01
"""Error of the force, a share, where none is estimated: the largest seen under bonded tools on default meshes."""


@dataclass(frozen=True)
class ModelError:
    """How a press of the model may be wrong.

    Attributes
    ----------
    trust : float
        Standard deviation of size and of slope (at both ends of the depth), shares of the force.
    bend : float
        Standard deviation of the bend, a share of the force; above 0.
    """

    trust: float
    bend: float

    @cached_property
    def deviations(self) -> Array:
        """(m,) standard deviations of the functions' factors."""
        return np.append(np.full(PLAIN, self.trust), self.bend * np.sqrt(_kernel()[0]))


def bend_of(mesh_error: float | None) -> float:
    """Standard deviation of the bend of a press whose force is estimated to be wrong by a share; None: no estimate."""
    return float(np.hypot(OTHER_CODE, SHARE_OF_MESH * (MESH_UNTOLD if mesh_error is None else mesh_error)))


def functions(count: int) -> Array:
    """(m, count) functions of the model's error at even depths from 0 to the press's depth."""
    depth = np.linspace(0.0, 1.0, count)
    bends = [np.interp(depth, _places(), one) for one in _kernel()[1]]
    return np.vstack([np.ones(count), 2.0 * depth - 1.0, bends])


def _places() -> Array:
    return (np.arange(POINTS) + 0.5) / POINTS


def _kernel() -> tuple[Array, Array]:
    """Variances (f,) and functions (f, k) of unit mean square of a process of unit variance, the largest first."""
    places = _places()
    matrix = np.exp(-0.5 * ((places[:, None] - places) / LENGTH) ** 2) / POINTS
    sizes, vectors = np.linalg.eigh(matrix)
    return sizes[::-1][:FUNCTIONS], (vectors[:, ::-1][:, :FUNCTIONS] * np.sqrt(POINTS)).T
