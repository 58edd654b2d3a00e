"""A rigid round tool with a rounded edge, over which the tissue slides without friction at finite strain.

The surface may not enter the tool: springs push each point out of it along the tool's normal, and the tool stands where
they carry its force. They are as stiff as the shortest waves that the modes lack, so that what a point enters by is
what those would give. The tool is a cylinder with a quarter of a torus for an edge; the touched part of it grows with
the press, and tissue moves over the edge as it is pressed.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import toms748
from scipy.special import j0, j1

from wavemodel.arrays import FloatArray
from wavemodel.layered.finite_strain.modal_body import StackBody
from wavemodel.layered.finite_strain.tool_contact import on_surface
from wavemodel.layered.tractions import Traction

SHORTER = 5.0
"""A spring gives as much as a half-space of the first layer under a wave that is so many times shorter than the modes'
shortest. Set on one press (`skin-5N`, edge of 0.5 mm), where depths are then within 0.4 %; with 3 and 8 within 0.4 and
0.6 %."""
PANEL = 4
AHEAD = 0.1
"""Of the radius, inside the face and outside the tool, as far as points of the surface may come to touch the edge."""
FINE = 30
"""Panels of points over the edge."""
CLOSE = 1e-12
"""Of the depth, to which a tool is put where it carries its force."""


@dataclass(frozen=True)
class RoundedTool:
    """A cylinder with a flat face and a rounded edge.

    Attributes
    ----------
    radius, edge
        In m, the edge no larger than the radius.
    """

    radius: float
    edge: float

    @property
    def face(self) -> float:
        """Radius of the flat face, m."""
        return self.radius - self.edge

    def entered(self, radius: FloatArray, height: FloatArray) -> FloatArray:
        """(6, P) how deep points at radii and heights over the face (P,), m, are in it, with its slopes and bends.

        First the depth in m, then its derivatives by radius and height, then the second ones, by radius twice, by both
        and by height twice, 1/m. Beside the face and its edge there is the wall; over the face matter is as deep as it
        is high.
        """
        x, y = np.maximum(radius - self.face, 0.0), np.minimum(height - self.edge, 0.0)
        reach = np.maximum(np.hypot(x, y), 1e-300)
        out, up, none = -x / reach, -y / reach, np.zeros_like(x)
        corner = np.stack([self.edge - reach, out, up, -up * up / reach, up * out / reach, -out * out / reach])
        corner[3:, y == 0.0] = 0.0
        return np.where(x == 0.0, np.stack([height, none, none + 1.0, none, none, none]), corner)


@dataclass(frozen=True)
class Entered:
    """M points of the surface that have entered the tool.

    Attributes
    ----------
    outward, down
        (M, N) their motion with the amplitudes U and W of the surface.
    spring, push
        (M,) N/m and N.
    slope, bend
        (2, M) and (3, M) first and second derivatives of how deep they are, by radius and height.
    """

    outward: FloatArray
    down: FloatArray
    spring: FloatArray
    push: FloatArray
    slope: FloatArray
    bend: FloatArray

    def change(self, outward: FloatArray, up: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(M,) and (M,) change of the forces along radius and height with motion (M,) along the two, N."""
        along = self.spring * (self.slope[0] * outward + self.slope[1] * up)
        rr, rh, hh = self.push * self.bend
        return along * self.slope[0] + rr * outward + rh * up, along * self.slope[1] + rh * outward + hh * up


@dataclass(frozen=True)
class SlidingState:
    """The tool and the points that have entered it; see `ContactState`.

    Attributes
    ----------
    contact
        Of it.
    depth, potential
        See `ContactState`.
    points
        That have entered.
    """

    contact: "SlidingContact"
    depth: float
    potential: float
    points: Entered

    @cached_property
    def forces(self) -> FloatArray:
        """(N, 2 n) in N."""
        return self._pushed(self.points.push * self.points.slope[0], self.points.push * self.points.slope[1])

    def change(self, direction: FloatArray) -> FloatArray:
        """(N, 2 n) change of the forces, the tool following."""
        points = self.points
        if not points.push.size:
            return np.zeros_like(direction)
        along, up = points.change(points.outward @ direction[:, 0], -points.down @ direction[:, self.contact.node])
        lowered = points.change(np.zeros_like(up), np.ones_like(up))
        following = -up.sum() / lowered[1].sum()
        return self._pushed(along + following * lowered[0], up + following * lowered[1])

    def relieve(self, answer: FloatArray) -> FloatArray:
        """The linear answer with the springs (Woodbury), without the bend of the tool."""
        if not self.points.push.size:
            return answer
        out, down = self._ways
        held = self._holding @ (out @ answer[:, 0] + down @ answer[:, self.contact.node])
        columns = self.contact.columns
        return np.asarray(answer - columns[..., 0] * (held @ out)[:, None] - columns[..., 1] * (held @ down)[:, None])

    @cached_property
    def _ways(self) -> tuple[FloatArray, FloatArray]:
        """(M, N) and (M, N) change of the points' ways out with U and W, by the roots of their springs."""
        root, points = np.sqrt(self.points.spring), self.points
        out, up = root * points.slope
        return out[:, None] * points.outward, -up[:, None] * points.down

    @cached_property
    def _holding(self) -> FloatArray:
        """(M, M) what the springs hold of the ways that the linear body would go, the tool following."""
        (uu, uw), (wu, ww) = self.contact.flexibility
        out, down = self._ways
        rising = np.sqrt(self.points.spring) * self.points.slope[1]
        follows = np.eye(rising.size) - np.outer(rising, rising) / (rising @ rising)
        modal = (out * uu + down * wu) @ out.T + (out * uw + down * ww) @ down.T
        return np.asarray(follows @ np.linalg.inv(np.eye(rising.size) + follows @ modal @ follows) @ follows)

    def _pushed(self, outward: FloatArray, up: FloatArray) -> FloatArray:
        """(N, 2 n) forces on the amplitudes from those along radius and height on the points (M,)."""
        out = np.zeros_like(self.contact.load)
        out[:, 0], out[:, self.contact.node] = outward @ self.points.outward, -up @ self.points.down
        return out


class SlidingContact:
    """A rigid tool without friction.

    Parameters
    ----------
    body
        The body.
    tool
        With a flat face.
    traction
        Of unit force under a flat tool as wide as the face, which is the limit of small presses.
    compliance
        Depth per force there, m/N.
    """

    def __init__(self, body: StackBody, tool: RoundedTool, traction: Traction, compliance: float) -> None:
        self.tool, self.node, self.compliance = tool, body.nodes, compliance
        push = on_surface(body, traction.basis.transform(body.radial.wavenumber))
        self.load: FloatArray = push @ traction.coefficients
        limit = float(body.radial.wavenumber[-1])
        self._radius, area = _points(tool, limit)
        phase = np.outer(self._radius, body.radial.wavenumber)
        self._outward, self._down = -j1(phase), j0(phase)
        shear, bulk = float(body.thickness.shear[0]), float(body.thickness.bulk[0])
        self._spring = area * SHORTER * limit * 2.0 * shear * (bulk + shear / 3.0) / (bulk + 4.0 / 3.0 * shear)
        surface = [0, self.node]
        self.columns = body.linear_compliance[:, :, surface]
        self.flexibility = np.moveaxis(self.columns[:, surface], 0, -1)

    def state(self, amplitude: FloatArray, force: float) -> SlidingState:
        """Under a force, N."""
        radius = self._radius + self._outward @ amplitude[:, 0]
        sunk = self._down @ amplitude[:, self.node]
        depth = self._carrying(radius, sunk, force)
        entered = self.tool.entered(radius, depth - sunk)
        at = entered[0] > 0.0 if force > 0.0 else np.zeros(radius.size, dtype=bool)
        deep, spring = entered[:, at], self._spring[at]
        push = spring * deep[0]
        points = Entered(self._outward[at], self._down[at], spring, push, deep[1:3], deep[3:])
        return SlidingState(self, depth, 0.5 * float(push @ deep[0]) - force * depth, points)

    def _carrying(self, radius: FloatArray, sunk: FloatArray, force: float) -> float:
        """Depth, m, at which the springs carry a force, N."""

        def missing(depth: float) -> float:
            entered = self.tool.entered(radius, depth - sunk)
            return float((self._spring * np.maximum(entered[0], 0.0)) @ entered[2]) - force

        low = float(sunk.min())
        if force <= 0.0:
            return low
        step = 0.01 * self.tool.radius
        while missing(low + step) < 0.0:
            low, step = low + step, 2.0 * step
        return float(toms748(missing, low, low + step, xtol=CLOSE * self.tool.radius))


def _points(tool: RoundedTool, limit: float) -> tuple[FloatArray, FloatArray]:
    """Radii (P,), m, at which the surface may touch a tool, and their areas, m2: closer together along the edge."""
    ahead = AHEAD * tool.radius
    start = max(tool.face - ahead, 0.0)
    width = min(tool.edge, 2.0 * ahead) / FINE
    inner = np.linspace(0.0, start, int(np.ceil(0.5 * start * limit)) + 1)
    outer = np.linspace(start, tool.radius + ahead, int(np.ceil((tool.radius + ahead - start) / width)) + 1)
    edges = np.concatenate([inner[:-1], outer])
    point, share = np.polynomial.legendre.leggauss(PANEL)
    half = 0.5 * np.diff(edges)[:, None]
    radius = (edges[:-1, None] + half * (point + 1.0)).ravel()
    return radius, 2.0 * np.pi * radius * (half * share).ravel()
