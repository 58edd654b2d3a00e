"""What holds a layered sheet: a tool on its upper face, a plate on its lower one, or a clamped border.

Contact tractions are sums of functions that have the singularity of an edge, each acting on a face: under a disc
P_j(c) / c with c = sqrt(1 - (r / a)^2), even degrees along the axis and odd ones outwards (see
`wavemodel.layered.tractions`); on the plate round a hole P_j(2 c - 1) / c with c = sqrt((r - b) / (B - b)), both ways;
at a clamped border the shear force on each node (the modes leave no outward motion there). Each function's work on the
displacement is that on the motion of what holds the face, but for a spring that is `STIFFNESS` times as stiff as the
sheet's material: stiff enough, and the tangent can be factorised as a positive matrix.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from wavemodel.arrays import FloatArray
from wavemodel.sheet.layered.stretched_modes import StretchedModes

STIFFNESS = 1e4
FUNCTIONS = 8
"""Of each direction under a tool: as many as the modes resolve at the edge; more would lock them."""
POINTS = 240


@dataclass(frozen=True)
class HeldFaces:
    """J traction functions on the 2 n N amplitudes of a sheet.

    Attributes
    ----------
    push
        (A, J) forces on the amplitudes.
    spring
        (J,) N/m.
    with_tool
        (J,) how far each function's work follows the tool's depth: one, or zero.
    load
        (A,) forces of a pressure of unit force; None under a rigid tool.
    """

    push: FloatArray
    spring: FloatArray
    with_tool: FloatArray
    load: FloatArray | None

    def reaction(self, amplitude: FloatArray, depth: float) -> FloatArray:
        """(J,) tractions on the sheet, N, with the tool at a depth, m."""
        return np.asarray(self.spring * (self.with_tool * depth - self.push.T @ amplitude))


@dataclass(frozen=True)
class Amplitudes:
    """Where the amplitudes are: U of each mode and node, then W.

    Attributes
    ----------
    modes
        N of U, N + 1 of W.
    nodes
        n through the thickness.
    """

    modes: StretchedModes
    nodes: int

    @property
    def outward(self) -> int:
        """How many are of U."""
        return self.modes.count * self.nodes

    @property
    def size(self) -> int:
        """All."""
        return self.outward + (self.modes.count + 1) * self.nodes

    def outward_forces(self, node: int, work: FloatArray) -> FloatArray:
        """(A, J) forces on one node's amplitudes of U from work (J, N) on its functions."""
        return self._placed(work, node, self.outward)

    def level_forces(self, node: int, work: FloatArray) -> FloatArray:
        """(A, J) forces on one node's amplitudes of W from work (J, N + 1) on its functions."""
        return self._placed(work, self.outward + node, self.size)

    def _placed(self, work: FloatArray, first: int, end: int) -> FloatArray:
        out = np.zeros((self.size, len(work)))
        out[first : end : self.nodes] = work.T
        return out


def pressure_on(place: Amplitudes, radius: float) -> FloatArray:
    """(A,) forces of a uniform pressure of unit force on a disc (m) of the upper face."""
    height, share = _half_range()
    level = place.modes.level(radius * np.sqrt(1.0 - height**2))[0]
    return place.level_forces(0, (2.0 * height * share @ level)[None])[:, 0]


def bonded_tool(place: Amplitudes, radius: float) -> FloatArray:
    """(A, 2 J) of the functions under a disc (m) of the upper face; only the first has a net force, of one."""
    height, share = _half_range()
    at = radius * np.sqrt(1.0 - height**2)
    powers = legendre.legvander(height, 2 * FUNCTIONS - 1).T * share
    level = place.level_forces(0, powers[0::2] @ place.modes.level(at)[0])
    return np.hstack([level, place.outward_forces(0, powers[1::2] @ place.modes.outward(at)[0])])


def plate(place: Amplitudes, hole: float, near: float) -> FloatArray:
    """(A, 2 J) of the functions on the lower face outside a hole (m), as many as tell lengths `near` (m) at its rim."""
    root, share = _half_range()
    ring = place.modes.radius.border - hole
    at = hole + ring * root**2
    powers = legendre.legvander(2.0 * root - 1.0, math.ceil(math.sqrt(ring / near)) - 1).T * (share * at / hole)
    last = place.nodes - 1
    level = place.level_forces(last, powers @ place.modes.level(at)[0])
    return np.hstack([level, place.outward_forces(last, powers @ place.modes.outward(at)[0])])


def border(place: Amplitudes) -> FloatArray:
    """(A, n) of a shear force on each node of the border."""
    level = place.modes.level(np.array([place.modes.radius.border]))[0]
    return np.hstack([place.level_forces(node, level) for node in range(place.nodes)])


def _half_range() -> tuple[FloatArray, FloatArray]:
    """Gauss's points and weights on [0, 1]."""
    point, share = legendre.leggauss(POINTS)
    return 0.5 * (point + 1.0), 0.5 * share
