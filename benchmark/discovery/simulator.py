"""The model under repair: a trial's motion to every reading, through the effects on a base of given shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from benchmark.discovery.bases.law import BaseLaw
from benchmark.discovery.discovery_result import Array
from benchmark.physics import Effect, LowerFaceMotion, Motion, PressHistory, Readings, TrialContext
from benchmark.physics.effect import Values

FIRST_STEP = 1e-3
"""A history begins this long after rest, s: what is shorter is taken as sudden."""


@dataclass(frozen=True)
class Shape:
    """How the base deviates from its tables; all zero for the tables themselves.

    Attributes
    ----------
    modulus : float
        Natural logarithm of the common factor on the moduli.
    radius, exponent : float
        Relative change of the tool's radius, change of the force's exponent.
    bend, turn : float
        Amounts of the second and third shifted Legendre polynomial over depth in the force.
    width, marker_exponent, marker_size : float
        Relative width of the marker field, change of its exponent over depth, relative size.
    """

    modulus: float = 0.0
    radius: float = 0.0
    exponent: float = 0.0
    bend: float = 0.0
    turn: float = 0.0
    width: float = 0.0
    marker_exponent: float = 0.0
    marker_size: float = 0.0


@dataclass(frozen=True, eq=False)
class Bent:
    """A base with a shape: force and marker courses over its depth grid."""

    law: BaseLaw
    shape: Shape
    deep: float

    @cached_property
    def force(self) -> Array:
        """(k,) N."""
        law, shape = self.law, self.shape
        x = np.clip(law.depth / self.deep, 0.0, None)
        inside = np.minimum(x, 1.0)
        second, third = 6 * inside**2 - 6 * inside + 1, 20 * inside**3 - 30 * inside**2 + 12 * inside - 1
        first, second_order = law.force_by_radius
        force = law.force + shape.radius * first + shape.radius**2 * second_order
        bent = force * (1.0 + shape.bend * second + shape.turn * third) * np.maximum(x, 1e-4) ** shape.exponent
        return np.asarray(np.exp(shape.modulus) * np.maximum(bent, 0.0))

    @cached_property
    def slope(self) -> float:
        """N/m beyond the grid."""
        return float((self.force[-1] - self.force[-20]) / (self.law.depth[-1] - self.law.depth[-20]))

    def push(self, depth: Array, gain: float) -> Array:
        """(n,) N at depths (n,) of 0 and more; straight on beyond the grid."""
        force = np.interp(depth, self.law.depth, self.force)
        return np.asarray(gain * (force + self.slope * np.maximum(depth - self.law.depth[-1], 0.0)))

    @cached_property
    def outward(self) -> tuple[Array, Array]:
        """Courses (c, k) over depth and shapes (c, q) over radius of the outward motion with this tool radius."""
        law = self.law
        pairs = [law.outward] if law.outward is not None else []
        pairs += [(self.shape.radius**order * c, s) for order, (c, s) in enumerate(law.outward_by_radius, start=1)]
        courses, shapes = zip(*pairs, strict=True)
        return np.concatenate(courses), np.concatenate(shapes)

    def field(self, pair: tuple[Array, Array], depth: Array, radius: Array) -> Array:
        """(n, m) motion by courses and shapes at depths (n,), mirrored above the surface, and radii (m,)."""
        courses, shapes = pair
        size = np.abs(depth)
        growth = np.maximum(size / self.deep, 1e-4) ** self.shape.marker_exponent * np.sign(depth)
        at = np.clip(size / self.law.depth[1], 0.0, self.law.depth.size - 1.000001)
        low = at.astype(np.int64)
        share = at - low
        over_depth = (courses[:, low] * (1.0 - share) + courses[:, low + 1] * share) * growth
        over_radius = np.array([np.interp(radius, self.law.radius, row, right=0.0) for row in shapes])
        return np.asarray(over_depth.T @ over_radius)


@dataclass(frozen=True, eq=False)
class Body:
    """An elastic law with the body effects' options, pressed through the times of a trial."""

    bent: Bent
    gain: float
    time: Array
    physics: Any

    def elastic(self, depth: Array) -> Array:
        """(n,) N without memory, through the options that are elastic."""
        from dataclasses import replace

        from wavemodel.physics import Physics, QuasiStaticPress

        kept = self.physics
        plain = Physics(stiffening=kept.stiffening, pretension=kept.pretension, floor=kept.floor)
        still = replace(self, physics=plain)
        time = 1.0 + np.arange(depth.size, dtype=np.float64)
        return QuasiStaticPress(still._law, plain).force(time, depth)

    def force(self, depth: Array) -> Array:
        """(n,) N."""
        return np.asarray(self.trace(depth).force)

    def trace(self, depth: Array) -> Any:
        """The press as `wavemodel.physics` gives it."""
        from wavemodel.physics.quasi_static_press import QuasiStaticPress

        press = QuasiStaticPress(self._law, self.physics)
        return press.follow(np.diff(self.time, prepend=0.0), depth, press.rest())[0]

    def _law(self, depth: Array) -> Array:
        return self.bent.push(depth, self.gain)


@dataclass(frozen=True, eq=False)
class Simulator:
    """One condition's base with effects.

    Attributes
    ----------
    law : BaseLaw
    around : TrialContext
    effects : tuple of Effect
        In the order in which they act.
    distance : float or None
        From camera to lower face, where the base model knows it, m.
    """

    law: BaseLaw
    around: TrialContext
    effects: tuple[Effect, ...]
    distance: float | None = None

    def bent(self, shape: Shape) -> Bent:
        """The base with a shape, worked out once for all trials."""
        return Bent(self.law, shape, self.around.peak_depth)

    def readings(
        self,
        bent: Bent,
        values: Mapping[str, Values],
        motion: Motion,
        gain: float = 1.0,
        shift: float = 0.0,
        height: float = 0.0,
    ) -> Readings:
        """What sensor and camera report in a trial.

        Parameters
        ----------
        bent
            The base.
        values
            Parameters of each effect by its slug.
        motion
            As the actuator reports it, (n,) rows.
        gain, shift, height
            Factor on the stiffness, time by which force and frames are late against depth, s, and depth at which the
            tool touches, m.
        """
        if shift or height:
            late = motion.time - shift
            motion = Motion(motion.time, np.interp(late, motion.time, motion.depth) - height, motion.acceleration)
        body = Body(bent, gain, motion.time - motion.time[0] + FIRST_STEP, self._physics(values))
        depth = motion.depth
        for effect in self.effects:
            if effect.drive is not None:
                depth = effect.drive(values[effect.slug], Motion(motion.time, depth, motion.acceleration), body)
        trace = body.trace(depth)
        press = PressHistory(motion.time, depth, trace.surface, trace.force, trace.elastic, trace.touching)
        readings = self._seen(bent, press, values)
        for effect in self.effects:
            if effect.observe is not None:
                readings = effect.observe(values[effect.slug], readings, motion, self.around)
        return readings

    def _physics(self, values: Mapping[str, Values]) -> Any:
        from wavemodel.physics.body import Physics

        options: dict[str, Any] = {}
        for effect in self.effects:
            if effect.body is not None:
                options |= effect.body(values[effect.slug], self.around)
        return Physics(**options)

    def _seen(self, bent: Bent, press: PressHistory, values: Mapping[str, Values]) -> Readings:
        if self.around.markers is None:
            return Readings(press.force)
        under = np.where(press.touching, press.surface, np.maximum(press.surface, 0.0))
        face = LowerFaceMotion(under, np.ones_like(under))
        for effect in self.effects:
            if effect.lower_face is not None:
                face = effect.lower_face(values[effect.slug], face, press, self.around)
        markers, sink = lower_face(bent, face, self.around.markers)
        if self.distance is not None:
            markers = markers / (1.0 - sink / self.distance)[..., None]
        return Readings(press.force, markers, sink)


def lower_face(bent: Bent, face: LowerFaceMotion, rest: Array) -> tuple[Array, Array]:
    """Positions (n, m, 2) and sinking (n, m) of markers at rest positions (m, 2), m."""
    law, shape = bent.law, bent.shape
    rows, count = face.depth.size, len(rest)
    if law.outward is None or law.sink is None:
        return np.broadcast_to(rest, (rows, count, 2)).copy(), np.zeros((rows, count))
    x, y = (rest - np.asarray(face.centre)).T
    root = np.sqrt(face.ratio)
    radius = np.sqrt(x**2 / root + y**2 * root)
    read = radius / (1.0 + shape.width)
    safe = np.maximum(radius, 1e-12)
    along = np.column_stack([x / root / safe, y * root / safe])
    out = bent.field(bent.outward, face.depth, read)
    moved = (1.0 + shape.marker_size) * face.passed[:, None] * out
    if face.dent is not None:
        moved = moved + face.dent[0][:, None] / np.maximum(radius, face.dent[1])
    return rest + moved[..., None] * along, bent.field(law.sink, face.depth, read)


def ordered(effects: Sequence[Effect], catalogue: Sequence[Effect]) -> tuple[Effect, ...]:
    """Effects in the order of the catalogue, own ones last."""
    slugs = [effect.slug for effect in catalogue]
    return tuple(sorted(effects, key=lambda each: slugs.index(each.slug) if each.slug in slugs else len(slugs)))
