"""A rigid round tool with a rounded edge, over which the tissue slides at finite strain, with or without friction.

The surface may not enter the tool: springs push each point out of it along the tool's normal, and the tool stands where
they carry its force. They are as stiff as the shortest waves that the modes lack, so that what a point enters by is
what those would give. The tool is a cylinder with a quarter of a torus for an edge; the touched part of it grows with
the press, and tissue moves over the edge as it is pressed.

With friction like springs hold each point along the tool's profile where it was at the load before, until they pull
with the share of what it pushes that Coulomb's law allows; that share goes by the equilibrium before, which is found
again until it stays (J. C. Simo and T. A. Laursen 1992, Comput Struct 42:97).
"""

from copy import copy
from dataclasses import dataclass, fields, replace
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
FINE = 6
"""Panels of points over the edge."""
CLOSE = 1e-12
"""Of the depth, to which a tool is put where it carries its force."""
SETTLED = 0.03
"""Of all friction that may act, by how much it may change when an equilibrium is found again."""


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

    def along(self, radius: FloatArray, height: FloatArray) -> FloatArray:
        """(3, P) the length along the profile from the axis to the nearest point, m, and its slopes by the two."""
        x, y = np.maximum(radius - self.face, 0.0), np.minimum(height - self.edge, 0.0)
        reach = np.maximum(np.hypot(x, y), 1e-300)
        length = np.minimum(radius, self.face) + self.edge * np.arctan2(x, -y) + np.maximum(height - self.edge, 0.0)
        shorter = np.where((x > 0.0) & (y < 0.0), self.edge / reach, 1.0)
        return np.stack([length, -y / reach * shorter, x / reach * shorter])


@dataclass(frozen=True)
class Held:
    """M ways in which the tool holds points of the surface: out of it, and along it.

    Attributes
    ----------
    outward, down
        (M, N) motion of the point with the amplitudes U and W of the surface.
    spring, push
        (M,) N/m and N; a spring that slides has none.
    slope, bend
        (2, M) and (3, M) first and second derivatives of the way by radius and height.
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
class Grip:
    """What friction goes by at P points of the surface.

    Attributes
    ----------
    coefficient
        Coulomb's.
    anchor
        (P,) length along the profile at which each is not pulled, m.
    limit
        (P,) the strongest pull, N.
    """

    coefficient: float
    anchor: FloatArray
    limit: FloatArray

    def pull(self, spring: FloatArray, length: FloatArray) -> tuple[FloatArray, float]:
        """(P,) pull back along the profile at lengths (P,), m, in N, and its potential, J (Huber's)."""
        stretch = length - self.anchor
        pull = np.clip(spring * stretch, -self.limit, self.limit)
        return pull, float(pull @ (stretch - 0.5 * pull / spring))


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
        Its ways of holding the surface.
    """

    contact: "SlidingContact"
    depth: float
    potential: float
    points: Held

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
        out, down, _ = self._ways
        held = self._holding @ (out @ answer[:, 0] + down @ answer[:, self.contact.node])
        columns = self.contact.columns
        return np.asarray(answer - columns[..., 0] * (held @ out)[:, None] - columns[..., 1] * (held @ down)[:, None])

    @cached_property
    def _ways(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(M, N), (M, N) and (M,) change of the ways with U, with W and with the tool, by the roots of the springs."""
        points, holds = self.points, self.points.spring > 0.0
        out, up = np.sqrt(points.spring[holds]) * points.slope[:, holds]
        return out[:, None] * points.outward[holds], -up[:, None] * points.down[holds], up

    @cached_property
    def _holding(self) -> FloatArray:
        """(M, M) what the springs hold of the ways that the linear body would go, the tool following."""
        (uu, uw), (wu, ww) = self.contact.flexibility
        out, down, rising = self._ways
        follows = np.eye(rising.size) - np.outer(rising, rising) / (rising @ rising)
        modal = (out * uu + down * wu) @ out.T + (out * uw + down * ww) @ down.T
        return np.asarray(follows @ np.linalg.inv(np.eye(rising.size) + follows @ modal @ follows) @ follows)

    def _pushed(self, outward: FloatArray, up: FloatArray) -> FloatArray:
        """(N, 2 n) forces on the amplitudes from those along radius and height on the points (M,)."""
        out = np.zeros_like(self.contact.load)
        out[:, 0], out[:, self.contact.node] = outward @ self.points.outward, -up @ self.points.down
        return out


class SlidingContact:
    """A rigid tool over which the tissue slides.

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
    friction
        Coulomb's coefficient.
    """

    def __init__(
        self, body: StackBody, tool: RoundedTool, traction: Traction, compliance: float, friction: float = 0.0
    ) -> None:
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
        anchor = tool.along(self._radius, np.zeros_like(self._radius))[0]
        self.grip = Grip(friction, anchor, np.zeros_like(anchor)) if friction > 0.0 else None

    def state(self, amplitude: FloatArray, force: float) -> SlidingState:
        """Under a force, N."""
        radius, height, depth = self._placed(amplitude, force)
        entered = self.tool.entered(radius, height)
        at = entered[0] > 0.0 if force > 0.0 else np.zeros(radius.size, dtype=bool)
        deep, spring = entered[:, at], self._spring[at]
        push = spring * deep[0]
        points = Held(self._outward[at], self._down[at], spring, push, deep[1:3], deep[3:])
        potential = 0.5 * float(push @ deep[0]) - force * depth
        if self.grip is not None and force > 0.0:
            dragged, more = self._dragged(self.grip, radius, height)
            points, potential = _joined(points, dragged), potential + more
        return SlidingState(self, depth, potential, points)

    def again(self, amplitude: FloatArray, force: float) -> "SlidingContact | None":
        """The contact with friction by what points push; None where it was that."""
        if self.grip is None:
            return None
        deep = self.tool.entered(*self._placed(amplitude, force)[:2])[0]
        limit = self.grip.coefficient * self._spring * np.maximum(deep, 0.0)
        if np.abs(limit - self.grip.limit).sum() <= SETTLED * limit.sum():
            return None
        return self._gripping(replace(self.grip, limit=limit))

    def after(self, amplitude: FloatArray, force: float) -> "SlidingContact":
        """The contact whose friction goes on from here."""
        if self.grip is None:
            return self
        length = self.tool.along(*self._placed(amplitude, force)[:2])[0]
        pull, _ = self.grip.pull(self._spring, length)
        return self._gripping(replace(self.grip, anchor=length - pull / self._spring))

    def _gripping(self, grip: Grip) -> "SlidingContact":
        other = copy(self)
        other.grip = grip
        return other

    def _placed(self, amplitude: FloatArray, force: float) -> tuple[FloatArray, FloatArray, float]:
        """(P,) and (P,) radius of the points and height over the face, and its depth, m."""
        radius = self._radius + self._outward @ amplitude[:, 0]
        sunk = self._down @ amplitude[:, self.node]
        depth = self._carrying(radius, sunk, force)
        return radius, depth - sunk, depth

    def _dragged(self, grip: Grip, radius: FloatArray, height: FloatArray) -> tuple[Held, float]:
        """The points that friction holds, and its potential, J."""
        length = self.tool.along(radius, height)
        pull, potential = grip.pull(self._spring, length[0])
        at = grip.limit > 0.0
        spring = np.where(np.abs(pull) < grip.limit, self._spring, 0.0)[at]
        slope = length[1:, at]
        held = Held(self._outward[at], self._down[at], spring, pull[at], slope, np.zeros((3, spring.size)))
        return held, potential

    def _carrying(self, radius: FloatArray, sunk: FloatArray, force: float) -> float:
        """Depth, m, at which the springs carry a force, N."""

        def missing(depth: float) -> float:
            entered = self.tool.entered(radius, depth - sunk)
            return float((self._spring * np.maximum(entered[0], 0.0)) @ entered[2]) - force + dragged(depth)

        def dragged(depth: float) -> float:
            if self.grip is None:
                return 0.0
            length = self.tool.along(radius, depth - sunk)
            return float(self.grip.pull(self._spring, length[0])[0] @ length[2])

        low = float(sunk.min())
        if force <= 0.0:
            return low
        step = 0.01 * self.tool.radius
        while missing(low) > 0.0:
            low -= step
        while missing(low + step) < 0.0:
            low, step = low + step, 2.0 * step
        return float(toms748(missing, low, low + step, xtol=CLOSE * self.tool.radius))


def _joined(first: Held, second: Held) -> Held:
    """Both ways of holding together."""
    points_first = ("outward", "down")
    return Held(*(
        np.concatenate([getattr(first, each.name), getattr(second, each.name)], 0 if each.name in points_first else -1)
        for each in fields(Held)
    ))  # fmt: skip


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
