"""The model's own error in a press: independent functions of depth, and the standard deviation of each.

What is left when the usual part of the error estimated for the mesh is taken off: size, slope over depth, and a bend:
a Gaussian process over depth with mean zero (Kennedy and O'Hagan 2001, Journal of the Royal Statistical Society B
63:425), as a share of the force, in its Karhunen-Loeve functions. The bend is confounded with every parameter that
bends the force over depth as it may: it widens intervals, and what it takes up is no finding about the specimen. Where
one tool alone tells layers apart by that bend, intervals rest on its size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmark.files.tool import TOUCHING, Tool
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
OTHER_CODE = 5e-4
"""Standard deviation of slope and bend between codes whose meshes converge, a share of the force.

On a mesh with a fan round the tool's sharp edge another code's force leaves ours by 0.01 % (rms) round a line over
depth. On grids of squares it left 0.15 %, which changed with the grid: elements at the edge fold one after another.
"""
SHARE_TAKEN = 0.65
"""Share of the error estimated for the mesh that is taken off the force, but for what goes with the depth.

Eight presses of three layers against twice as fine meshes, without a fan at the edge: 0.55 to 0.9 of the estimate was
there. What elements over a hole leave at the edge is taken off whole: of five sheets with limits from more rings,
pressed to 0.2 to 0.6 of their thickness, slopes of up to 0.65 % of the force become 0.36 % at most, sizes 0.2 %.
"""
SHARE_OF_SIZE = 0.3
"""Standard deviation of the size that is left then, over that error."""
SHARE_OF_MESH = 0.2
"""Standard deviation of slope and bend that elements of finite size make, over that error: 0.05 to 0.2 was seen."""
SIZE = 1e-3
"""Standard deviation of the size between codes in the limit of refinement, a share of the force."""
JUMPS_OF_SPHERE, JUMPS_OF_EDGE = 7e-4, 4e-3
"""Standard deviation of the jumps that nodes leave as they come into touch, a share of the force: of a sphere, and of
an edge as large as the tool, with the square of the edge's share. Measured round smooth curves over depth, on 8 mm at
0.2 to 2 mm under a tool of 5 mm (docs/verification.md).
"""
MESH_UNTOLD = 0.01
"""Error of the force, a share, where none is estimated: the largest seen under bonded tools on default meshes."""


@dataclass(frozen=True)
class ModelError:
    """How a press of the model may be wrong.

    Attributes
    ----------
    size, slope, bend : float
        Standard deviations of size, of slope (at both ends of the depth) and of bend, shares of the force; above 0.
    """

    size: float
    slope: float
    bend: float

    @cached_property
    def deviations(self) -> Array:
        """(m,) standard deviations of the functions' factors."""
        return np.append([self.size, self.slope], self.bend * np.sqrt(_kernel()[0]))


def touches(tool: Tool) -> bool:
    """Whether nodes come into touch with the tool one by one."""
    return tool.contact in TOUCHING and tool.edge_radius is not None


def jumps(tool: Tool) -> float:
    """Standard deviation of the jumps of the force over depth under a tool, a share of it; 0 where none touches."""
    if not touches(tool):
        return 0.0
    share = (tool.edge_radius or tool.radius) / tool.radius
    return JUMPS_OF_SPHERE if share >= 1.0 else JUMPS_OF_EDGE * share**2


def model_error(
    mesh_error: float | None, trust: float = 0.0, discrepancy: float = 0.0, jumping: float = 0.0
) -> ModelError:
    """The error of a press after the usual part of its mesh's is taken off.

    `mesh_error` is what is estimated for the mesh, a share of the force; None: no estimate, and nothing taken off.
    Size and slope are no surer than `trust`, the bend no smaller than `discrepancy`, none surer than by its `jumping`;
    shares of the force.
    """
    mesh = MESH_UNTOLD if mesh_error is None else mesh_error
    size = math.hypot(SIZE, SHARE_OF_SIZE * mesh, jumping)
    course = math.hypot(OTHER_CODE, SHARE_OF_MESH * mesh, jumping)
    return ModelError(max(size, trust), max(course, trust), max(course, discrepancy))


def taken(mesh_error: float | None, at_edge: float | Array) -> float | Array:
    """The usual part of a mesh's error over depth, shares of the force; 0 where none is estimated.

    Of the estimate at the largest depth the part `at_edge` of a stuck tool, which begins at none, is taken at each
    depth (k,) as it is there, of the rest a share at all depths.
    """
    if mesh_error is None:
        return 0.0
    deepest = float(np.asarray(at_edge).flat[-1])
    return at_edge + SHARE_TAKEN * (mesh_error - deepest)


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
