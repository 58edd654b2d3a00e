"""A press without inertia on a body with options: from a history of depth to force, and back.

The elastic law is handed in as a function, so that any model of a specimen (layers on a base, a sheet over a hole, a
fitted curve) takes the same options. A history of depth is worked out as a whole, without a loop over its samples.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.integrators.load import checked_load
from wavemodel.physics.adhesion import Adhesion
from wavemodel.physics.body import Physics
from wavemodel.physics.course import Course, Memory, Option
from wavemodel.physics.permanent_set import PermanentSet

ForceLaw: TypeAlias = Callable[[FloatArray], FloatArray]
"""Depths (n,) of 0 and more, m, to forces (n,), N: rising, zero at zero. It raises `WaveError` beyond its range."""


@dataclass(frozen=True)
class PressState:
    """What a body remembers of a press: whether it is touched, and the memories of its options in their order."""

    touching: bool
    surface: Memory
    options: tuple[Memory, ...]


@dataclass(frozen=True)
class Trace:
    """n samples of a press.

    Attributes
    ----------
    depth
        (n,) of the tool, m.
    surface
        (n,) where the tissue under the tool stands, m: at the tool where they touch, else where permanent set left it.
    force
        (n,) on the tool, N.
    elastic
        (n,) elastic part of the force, before it fades, N.
    touching
        (n,) whether tool and tissue are in contact.
    """

    depth: FloatArray
    surface: FloatArray
    force: FloatArray
    elastic: FloatArray
    touching: BoolArray


def joined(pieces: Sequence[Trace]) -> Trace:
    """One trace of several that follow each other."""
    return Trace(*(np.concatenate([getattr(one, item.name) for one in pieces]) for item in fields(Trace)))


@dataclass(frozen=True)
class QuasiStaticPress:
    """An elastic law with the options of a body.

    Attributes
    ----------
    law
        Force over depth of the elastic body.
    physics
        Its options; none by default.
    """

    law: ForceLaw
    physics: Physics = Physics()  # noqa: RUF009 (frozen)

    def force(self, time: FloatArray, depth: FloatArray) -> FloatArray:
        """(n,) force on a tool that is moved through depths (n,) at times (n,).

        Parameters
        ----------
        time
            In s, rising. The state before the first is at rest, from time zero on; a history that starts at or before
            zero starts from the body at rest at its first depth.
        depth
            In m, of the tool below the untouched surface; negative in air. Linear between the instants.

        Raises
        ------
        WaveError
            If the history is not usable, or deeper than the law's range.
        """
        return self.trace(time, depth).force

    def trace(self, time: FloatArray, depth: FloatArray) -> Trace:
        """The same, with the surface and the contact; see `force`."""
        load = checked_load("depth", time, depth)
        return self.follow(load.durations, load.value, self.rest())[0]

    def rest(self) -> PressState:
        """The untouched body."""
        count = len(self.physics.elastic) + len(self.physics.fading) + len(self.physics.beside)
        return PressState(False, (), ((),) * count)

    def follow(
        self, duration: FloatArray, depth: FloatArray, state: PressState, *, held: bool = False
    ) -> tuple[Trace, PressState]:
        """Go on from a state through further samples.

        Parameters
        ----------
        duration
            (n,) of the steps that end at the samples, s; see `Course`.
        depth
            (n,) of the tool, m.
        state
            Before the first sample; unchanged.
        held
            Whether tool and tissue are one: no lift-off, and any pull.
        """
        met, surface, set_memory = (self.physics.permanent_set or PermanentSet(0.0)).meet(depth, state.surface)
        start = self._touched(duration, met, state.touching, held)
        memories = iter(state.options)
        elastic, first = _chain(self.physics.elastic, start, memories)
        faded, second = _chain(self.physics.fading, elastic, memories)
        force, third = faded.force, []
        for option in self.physics.beside:
            part, memory = option.act(elastic, next(memories))
            force = force + part
            third.append(memory)
        if not held:
            force = np.where(start.touching, np.maximum(force, -self._adhesion.force), 0.0)
        stands = np.where(start.touching, depth, surface)
        after = PressState(bool(start.touching[-1]), set_memory, (*first, *second, *third))
        return Trace(depth, stands, force, elastic.force, start.touching), after

    @property
    def _adhesion(self) -> Adhesion:
        return self.physics.adhesion or Adhesion()

    def _touched(self, duration: FloatArray, met: FloatArray, before: bool, held: bool) -> Course:
        """Contact and the elastic force of the bare law; pulled, the law is that of the press with its sign."""
        reach = np.abs(met) if held or self._adhesion.force > 0.0 else np.maximum(met, 0.0)
        size = self.law(reach)
        touching = np.ones_like(met, dtype=np.bool_) if held else self._touching(met, size, before)
        return Course(duration, met, np.where(touching, np.copysign(size, met), 0.0), touching)

    def _touching(self, met: FloatArray, pull: FloatArray, before: bool) -> BoolArray:
        if self._adhesion.force == 0.0:
            return np.asarray(met >= 0.0)
        return self._adhesion.touching(met, pull, before)


def _chain(options: tuple[Option, ...], course: Course, memories: Iterator[Memory]) -> tuple[Course, list[Memory]]:
    """Options one after the other."""
    after = []
    for option in options:
        force, memory = option.act(course, next(memories))
        course = replace(course, force=force)
        after.append(memory)
    return course, after
