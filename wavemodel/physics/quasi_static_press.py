"""A press without inertia on a body with options: from a history of depth to force, and back.

The elastic law is handed in as a function, so that any model of a specimen (layers on a base, a sheet over a hole, a
fitted curve) takes the same options. A history of depth is worked out as a whole, without a loop over its samples;
driven by force, each instant is solved for the depth at which the body answers with that force.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.load_history import Load, checked_load
from wavemodel.integrators.viscoelastic import Prony
from wavemodel.physics.contact import Adhesion, DryFriction, PermanentSet
from wavemodel.physics.elastic import Floor, InterfaceSlip, Pretension, StrainStiffening, StressSoftening
from wavemodel.physics.load_segment import BodyOption, LoadSegment, Memory
from wavemodel.physics.time_dependent import PoroelasticDrainage, RelaxingForce, ViscousDamping

ForceLaw: TypeAlias = Callable[[FloatArray], FloatArray]
"""Depths (n,) of 0 and more, m, to forces (n,), N: rising, zero at zero. It raises `WaveError` beyond its range."""
WIDENINGS = 60
EXACT = 1e-13
"""Of the force, and of the depth (relatively), to which a step is solved."""
NO_SET, NO_ADHESION = PermanentSet(0.0), Adhesion()


@dataclass(frozen=True)
class Physics:
    """Options of a body on top of an elastic law f(d), acting in this order.

    The tool meets the surface where `permanent_set` left it; `adhesion` says whether they touch. The elastic force is
    f, changed by `stiffening`, `pretension`, `floor`, `slip` and `softening`. It relaxes by `relaxation` and
    `drainage`, and `damping` and `friction` act beside it. A tool that is not held cannot be pulled.

    Attributes
    ----------
    stiffening, pretension, floor, slip, softening, permanent_set, relaxation, drainage, damping, friction, adhesion
        See the classes of these options.
    """

    stiffening: StrainStiffening | None = None
    pretension: Pretension | None = None
    floor: Floor | None = None
    slip: InterfaceSlip | None = None
    softening: StressSoftening | None = None
    permanent_set: PermanentSet | None = None
    relaxation: Prony | None = None
    drainage: PoroelasticDrainage | None = None
    damping: ViscousDamping | None = None
    friction: DryFriction | None = None
    adhesion: Adhesion | None = None

    @cached_property
    def elastic(self) -> tuple[BodyOption, ...]:
        """What changes the elastic force, in order."""
        chosen = (self.stiffening, self.pretension, self.floor, self.slip, self.softening)
        return tuple(option for option in chosen if option is not None)

    @cached_property
    def relaxing(self) -> tuple[BodyOption, ...]:
        """What lets the force relax, in order."""
        relaxation = None if self.relaxation is None else RelaxingForce(self.relaxation)
        return tuple(option for option in (relaxation, self.drainage) if option is not None)

    @cached_property
    def beside(self) -> tuple[BodyOption, ...]:
        """What acts beside the elastic force."""
        return tuple(option for option in (self.damping, self.friction) if option is not None)


@dataclass(frozen=True)
class PressState:
    """What a body remembers of a press: whether it is touched, and the memories of its options in their order."""

    touching: bool
    surface: Memory
    options: tuple[Memory, ...]


@dataclass(frozen=True)
class PressTrace:
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
        (n,) elastic part of the force, before it relaxes, N.
    touching
        (n,) whether tool and tissue are in contact.
    """

    depth: FloatArray
    surface: FloatArray
    force: FloatArray
    elastic: FloatArray
    touching: BoolArray


def joined(pieces: Sequence[PressTrace]) -> PressTrace:
    """One trace of several that follow each other."""
    return PressTrace(*(np.concatenate([getattr(one, item.name) for one in pieces]) for item in fields(PressTrace)))


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
    physics: Physics = Physics()

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

    def trace(self, time: FloatArray, depth: FloatArray) -> PressTrace:
        """The same, with the surface and the contact; see `force`."""
        load = checked_load("depth", time, depth)
        return self.follow(load.durations, load.value, self.rest())[0]

    def rest(self) -> PressState:
        """The untouched body."""
        count = len(self.physics.elastic) + len(self.physics.relaxing) + len(self.physics.beside)
        return PressState(False, (), ((),) * count)

    def follow(
        self, duration: FloatArray, depth: FloatArray, state: PressState, *, held: bool = False
    ) -> tuple[PressTrace, PressState]:
        """Go on from a state through further samples.

        Parameters
        ----------
        duration
            (n,) of the steps that end at the samples, s; see `LoadSegment`.
        depth
            (n,) of the tool, m.
        state
            Before the first sample; unchanged.
        held
            Whether tool and tissue are one: no lift-off, and any pull.
        """
        met, surface, set_memory = (self.physics.permanent_set or NO_SET).meet(duration, depth, state.surface)
        start = self._touched(duration, met, state.touching, held)
        memories = iter(state.options)
        elastic, first = _chain(self.physics.elastic, start, memories)
        relaxed, second = _chain(self.physics.relaxing, elastic, memories)
        force, third = relaxed.force, []
        for option in self.physics.beside:
            part, memory = option.act(elastic, next(memories))
            force = force + part
            third.append(memory)
        if not held:
            force = np.where(start.touching, np.maximum(force, -self._adhesion.force), 0.0)
        stands = np.where(start.touching, depth, surface)
        after = PressState(bool(start.touching[-1]), set_memory, (*first, *second, *third))
        return PressTrace(depth, stands, force, elastic.force, start.touching), after

    @cached_property
    def _adhesion(self) -> Adhesion:
        return self.physics.adhesion or NO_ADHESION

    def _touched(self, duration: FloatArray, met: FloatArray, before: bool, held: bool) -> LoadSegment:
        """Contact and the elastic force of the bare law; pulled, the law is that of the press with its sign."""
        reach = np.abs(met) if held or self._adhesion.force > 0.0 else np.maximum(met, 0.0)
        size = self.law(reach)
        touching = np.ones_like(met, dtype=np.bool_) if held else self._touching(met, size, before)
        return LoadSegment(duration, met, np.where(touching, np.copysign(size, met), 0.0), touching)

    def _touching(self, met: FloatArray, pull: FloatArray, before: bool) -> BoolArray:
        if self._adhesion.force == 0.0:
            return np.asarray(met >= 0.0)
        return self._adhesion.touching(met, pull, before)


def _chain(
    options: tuple[BodyOption, ...], segment: LoadSegment, memories: Iterator[Memory]
) -> tuple[LoadSegment, list[Memory]]:
    """Options one after the other."""
    after = []
    for option in options:
        force, memory = option.act(segment, next(memories))
        segment = replace(segment, force=force)
        after.append(memory)
    return segment, after


def driven(load: Load, law: ForceLaw, physics: Physics, scale: float) -> PressTrace:
    """Go through a load history, of force or depth, on an elastic law with options; see `drive_by_force`."""
    press = QuasiStaticPress(law, physics)
    if load.control == "force":
        return drive_by_force(press, load.time, load.value, scale)
    return press.trace(load.time, load.value)


def drive_by_force(press: QuasiStaticPress, time: FloatArray, force: FloatArray, scale: float) -> PressTrace:
    """Go through a history of force; the tool rests on the tissue all the time, also without force.

    Each step is solved for by bracketing, the options' memories being carried from step to step: about a millisecond
    a step.

    Parameters
    ----------
    press
        The body.
    time, force
        (n,) in s and N; see `QuasiStaticPress.force`.
    scale
        About the depth of the press, m: the search begins with a thousandth of it.

    Raises
    ------
    WaveError
        If the history is not usable, pulls more than adhesion holds, or asks for more than the law's range gives.
    """
    load = checked_load("force", time, force)
    _check_pull(press, load.value)
    state, depth, move, pieces = press.rest(), 0.0, 1e-3 * scale, []
    for duration, value in zip(load.durations, load.value.tolist(), strict=True):
        trace, state = _step(press, np.array([duration]), value, state, (depth, move))
        move = max(abs(float(trace.depth[0]) - depth), 1e-3 * scale)
        depth = float(trace.depth[0])
        pieces.append(trace)
    return joined(pieces)


def _check_pull(press: QuasiStaticPress, force: FloatArray) -> None:
    held = press.physics.adhesion.force if press.physics.adhesion else 0.0
    if force.min() < -held:
        at = int(force.argmin())
        raise WaveError(
            f"load: value[{at}] = {force[at]:g} N is not allowed: the tissue can be pulled by no more than its "
            f"adhesion, {held:g} N"
        )


def _step(
    press: QuasiStaticPress, duration: FloatArray, force: float, state: PressState, near: tuple[float, float]
) -> tuple[PressTrace, PressState]:
    def excess(depth: float) -> float:
        return float(press.follow(duration, np.array([depth]), state, held=True)[0].force[0]) - force

    low, high = _bracket(excess, *near)
    depth = low if low == high else brentq(excess, low, high, xtol=EXACT * (abs(low) + near[1]), rtol=1e-14)
    return press.follow(duration, np.array([depth]), state, held=True)


def _bracket(excess: Callable[[float], float], depth: float, move: float) -> tuple[float, float]:
    """Two depths between which the force comes to its value; twice the same where it is already there."""
    here = excess(depth)
    if here == 0.0:
        return depth, depth
    towards, step, before = -np.sign(here), 1.25 * move, depth
    for _ in range(WIDENINGS):
        after = before + towards * step
        if excess(after) * here <= 0.0:
            return min(before, after), max(before, after)
        before, step = after, 2.0 * step
    raise WaveError(f"force: no depth between {depth * 1e3:g} mm and {before * 1e3:g} mm answers with it")
