"""The way of a trial: drive (what the rig imposes) -> body (tissue, layers, contact) -> observation (sensor, camera).

Effects act around the elastic answer of a specimen, whichever model gives it, in the order in which they are handed in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol, TypeAlias

import numpy as np

from benchmark.models import UncoveredError
from benchmark.physics import Effect, LowerFaceMotion, Motion, PressHistory, Readings, TrialContext
from benchmark.response.force_curve import Array
from wavemodel import WaveError
from wavemodel.physics import Physics, QuasiStaticPress
from wavemodel.physics.quasi_static_press import PressTrace

Law: TypeAlias = Callable[[Array], Array]
"""Elastic force (n,) N over depths (n,) of 0 and more, m."""
Added: TypeAlias = tuple[Effect, Mapping[str, float]]
"""An effect with the values of its parameters, SI."""

FIRST_STEP = 1e-3
"""A trial begins this long after rest, s: what is shorter is taken as sudden."""


class Elastic(Protocol):
    """The elastic answer of a specimen under a tool."""

    def force(self, depth: Array) -> Array:
        """(n,) N at depths (n,) of 0 and more, m."""
        ...

    def lower_face(self, spread: LowerFaceMotion, rest: Array) -> tuple[Array, Array]:
        """Positions (n, m, 2) and sinking (n, m) of markers at rest positions (m, 2), m."""
        ...


def physics_of(added: Iterable[Added], around: TrialContext) -> Physics:
    """The options of the body that effects switch on."""
    options: dict[str, Any] = {}
    for effect, values in added:
        if effect.body is not None:
            options |= dict(effect.body(values, around))
    return Physics(**options)


@dataclass(frozen=True, eq=False)
class PressedBody:
    """An elastic law with a body's options, pressed through the times (n,) of a trial, the first just after rest."""

    law: Law
    time: Array
    physics: Physics

    def elastic(self, depth: Array) -> Array:
        """(n,) N without memory, through the options that are elastic."""
        kept = self.physics
        plain = Physics(stiffening=kept.stiffening, pretension=kept.pretension, floor=kept.floor)
        return QuasiStaticPress(self.law, plain).force(1.0 + np.arange(depth.size, dtype=np.float64), depth)

    def force(self, depth: Array) -> Array:
        """(n,) N."""
        return self.trace(depth).force

    def trace(self, depth: Array) -> PressTrace:
        """The press through depths (n,), m."""
        press = QuasiStaticPress(self.law, self.physics)
        return press.follow(np.diff(self.time, prepend=0.0), depth, press.rest())[0]


@dataclass(frozen=True, eq=False)
class TrialPipeline:
    """One condition with effects.

    Attributes
    ----------
    around : TrialContext
        What the effects may know of it; its markers are what is seen.
    effects : tuple of Effect
        In the order in which they act.
    distance : float or None
        From camera to lower face, where the model knows it, m.
    """

    around: TrialContext
    effects: tuple[Effect, ...]
    distance: float | None = None

    def readings(
        self,
        elastic: Elastic,
        values: Mapping[str, Mapping[str, float]],
        motion: Motion,
        gain: float = 1.0,
        shift: float = 0.0,
        height: float = 0.0,
    ) -> Readings:
        """What sensor and camera report in a trial.

        Parameters
        ----------
        elastic
            The specimen's elastic answer.
        values
            Parameters of each effect by its slug.
        motion
            As the actuator reports it, (n,) rows.
        gain, shift, height
            Factor on the stiffness, time by which force and frames are late against depth, s, and depth at which the
            tool touches, m.

        Raises
        ------
        wavemodel.WaveError
            A depth or a value that the body's options do not cover.
        """
        return self.of_several([elastic], values, [motion], [(gain, shift, height)])[0]

    def of_several(
        self,
        elastics: Sequence[Elastic],
        values: Mapping[str, Mapping[str, float]],
        motions: Sequence[Motion],
        own: Sequence[tuple[float, float, float]],
    ) -> list[Readings]:
        """`readings` of trials that share the effects' values: the elastic answer, motion, and own values of each.

        What they share is worked out once, and the lower face of those that share it in one go.
        """
        added = [(effect, values[effect.slug]) for effect in self.effects]
        physics = physics_of(added, self.around)
        moved = [_late_and_low(motion, shift, height) for motion, (_, shift, height) in zip(motions, own, strict=True)]
        traces = [
            _pressed(motion, added, _times(gain, elastic), physics)
            for elastic, motion, (gain, _, _) in zip(elastics, moved, own, strict=True)
        ]
        seen = self._seen(elastics, moved, traces, added)
        return [self._observed(readings, motion.read, added) for readings, motion in zip(seen, moved, strict=True)]

    def _observed(self, readings: Readings, motion: Motion, added: Sequence[Added]) -> Readings:
        """As sensor and camera report it."""
        for effect, own in added:
            if effect.observe is not None and (readings.markers is not None or not effect.needs_markers):
                readings = effect.observe(own, readings, motion, self.around)
        return readings

    def _seen(
        self, elastics: Sequence[Elastic], moved: Sequence[Motion], traces: Sequence[PressTrace], added: Sequence[Added]
    ) -> list[Readings]:
        """The force, and the markers where there are any, in the rows of the trial itself."""
        rest = self.around.markers
        forces = [trace.force[motion.earlier :] for motion, trace in zip(moved, traces, strict=True)]
        if rest is None:
            return [Readings(force) for force in forces]
        presses = [_history(motion, trace) for motion, trace in zip(moved, traces, strict=True)]
        spreads = [
            _from(motion.earlier, self._spread(press, added)) for motion, press in zip(moved, presses, strict=True)
        ]
        out = []
        for force, (markers, sink) in zip(forces, _lower_faces(elastics, spreads, rest), strict=True):
            if self.distance is not None:
                markers = markers / (1.0 - sink / self.distance)[..., None]
            out.append(Readings(force, markers, sink))
        return out

    def _spread(self, press: PressHistory, added: Sequence[Added]) -> LowerFaceMotion:
        """How a press moves the lower face."""
        under = np.where(press.touching, press.surface, np.maximum(press.surface, 0.0))
        spread = LowerFaceMotion(under, np.ones_like(under))
        for effect, values in added:
            if effect.lower_face is not None:
                spread = effect.lower_face(values, spread, press, self.around)
        return spread


def _times(gain: float, elastic: Elastic) -> Law:
    """The elastic law of a specimen that is so many times as stiff."""
    return lambda depth: gain * elastic.force(depth)


def _late_and_low(motion: Motion, shift: float, height: float) -> Motion:
    """A motion that sensors show late by a shift, s, of a tool that touches at a height, m."""
    if not (shift or height):
        return motion
    late = motion.before(shift)
    return replace(late, depth=late.depth - height)


def _history(motion: Motion, trace: PressTrace) -> PressHistory:
    """A press worked out, with where the surface stood."""
    return PressHistory(motion.time, trace.depth, trace.surface, trace.force, trace.elastic, trace.touching)


def _from(row: int, spread: LowerFaceMotion) -> LowerFaceMotion:
    """The motion of the lower face from a row on."""
    dent = None if spread.dent is None else (spread.dent[0][row:], spread.dent[1])
    return replace(spread, depth=spread.depth[row:], passed=spread.passed[row:], dent=dent)


def _lower_faces(
    elastics: Sequence[Elastic], spreads: Sequence[LowerFaceMotion], rest: Array
) -> list[tuple[Array, Array]]:
    """Positions and sinking of markers by each elastic answer; in one go where all go by the same one alike."""
    first = spreads[0]
    alike = all(each is elastics[0] for each in elastics) and all(_alike(first, each) for each in spreads)
    if len(spreads) == 1 or not alike:
        return [elastic.lower_face(spread, rest) for elastic, spread in zip(elastics, spreads, strict=True)]
    depth, passed = (np.concatenate([getattr(each, name) for each in spreads]) for name in ("depth", "passed"))
    dents = [each.dent for each in spreads if each.dent is not None]
    dent = (np.concatenate([outward for outward, _ in dents]), dents[0][1]) if dents else None
    moved, sunk = elastics[0].lower_face(LowerFaceMotion(depth, passed, first.centre, first.ratio, dent), rest)
    ends = np.cumsum([each.depth.size for each in spreads[:-1]])
    return list(zip(np.split(moved, ends), np.split(sunk, ends), strict=True))


def _alike(one: LowerFaceMotion, other: LowerFaceMotion) -> bool:
    """Whether two motions differ by what they have in each row alone."""
    inner = [None if each.dent is None else each.dent[1] for each in (one, other)]
    return one.centre == other.centre and one.ratio == other.ratio and inner[0] == inner[1]


def _driven(motion: Motion, added: Sequence[Added], body: PressedBody) -> Array:
    """Depth (n,) m to which the rig brings the tool."""
    depth = motion.depth
    for effect, own in added:
        if effect.drive is not None:
            depth = effect.drive(own, replace(motion, depth=depth), body)
    return depth


def _pressed(motion: Motion, added: Sequence[Added], law: Law, physics: Physics) -> PressTrace:
    """The press; where rows are means, damped by how the elastic force changes within them, not from one to the next.

    The change is that between the forces of the rows an interval of the record earlier and later.
    """
    body = PressedBody(law, motion.time - motion.time[0] + FIRST_STEP, physics)
    depth, damping = _driven(motion, added, body), physics.damping
    if motion.record is None:
        return body.trace(depth)
    if damping is None or damping.retardation == 0.0:
        return _torn_within(body.trace(depth), physics)
    free, step = replace(body, physics=replace(physics, damping=None)), motion.record.interval
    before, after = (free.trace(_driven(motion.before(each), added, body)).elastic for each in (step, -step))
    trace = free.trace(depth)
    force = trace.force + damping.retardation * (after - before) / (2.0 * step)
    force = np.where(trace.touching, np.maximum(force, np.minimum(trace.force, 0.0)), trace.force)
    return _torn_within(replace(trace, force=force), physics)


def _torn_within(trace: PressTrace, physics: Physics) -> PressTrace:
    """Rows that are means, of a tissue that lets go within one: the pull of its part before that.

    Force and elastic force go on over the depth as between the two rows before, and the tool from the middle between
    two rows to the next.
    """
    if physics.adhesion is None or physics.adhesion.force == 0.0:
        return trace
    gone = 1 + np.flatnonzero(trace.touching[:-1] & ~trace.touching[1:])
    depth, force = trace.depth, trace.force.copy()
    gone = gone[(gone > 1) & (gone < depth.size - 1)]
    gone = gone[(depth[gone - 2] > depth[gone - 1]) & (depth[gone] > depth[gone + 1])]
    earlier, last = depth[gone - 2], depth[gone - 1]
    slope, stiffness = ((part[gone - 2] - part[gone - 1]) / (earlier - last) for part in (trace.force, trace.elastic))
    left = np.divide(physics.adhesion.force + trace.elastic[gone - 1], stiffness, where=stiffness > 0.0, out=0.0 * last)
    torn = np.clip(last - left, depth[gone], last)
    for row in (gone - 1, gone):
        top, bottom = 0.5 * (depth[row - 1] + depth[row]), 0.5 * (depth[row] + depth[row + 1])
        until = np.clip(torn, bottom, top)
        pulled = trace.force[gone - 1] + slope * (0.5 * (top + until) - last)
        force[row] = np.where(until > bottom, (top - until) / (top - bottom) * pulled, force[row])
    return replace(trace, force=force)


@dataclass(frozen=True, eq=False)
class ForceAlone:
    """An elastic law whose lower face nobody sees."""

    law: Law

    def force(self, depth: Array) -> Array:
        """(n,) N at depths (n,), m."""
        return self.law(depth)

    def lower_face(self, spread: LowerFaceMotion, rest: Array) -> tuple[Array, Array]:
        """Markers that stay where they are."""
        return np.broadcast_to(rest, (spread.depth.size, *rest.shape)).copy(), np.zeros((spread.depth.size, len(rest)))


def trial_force(law: Law, added: Sequence[Added], time: Array, depth: Array, around: TrialContext) -> Array:
    """Force (n,) N that the sensor reports in a trial.

    Parameters
    ----------
    law
        The specimen's elastic law.
    added
        Effects with their values, in the order in which they act.
    time, depth
        (n,) s and m below contact.
    around
        What the effects may know of the trial.

    Raises
    ------
    UncoveredError
        A depth or a value that the effects do not cover.
    """
    motion = Motion(time, depth, np.gradient(np.gradient(depth, time), time))
    pipeline = TrialPipeline(replace(around, markers=None), tuple(effect for effect, _ in added))
    values = {effect.slug: own for effect, own in added}
    try:
        return pipeline.readings(ForceAlone(law), values, motion).force
    except WaveError as error:
        raise UncoveredError(str(error)) from None
