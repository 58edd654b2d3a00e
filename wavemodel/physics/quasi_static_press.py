"""A press without inertia on a body with options: from a history of depth to force, and back.

The elastic law is handed in as a function, so that any model of a specimen (layers on a base, a sheet over a hole, a
fitted curve) takes the same options. A history of depth is worked out as a whole, without a loop over its samples;
driven by force, each instant is solved for the depth at which the body answers with that force.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.lags import LagStage, Standing, standing
from wavemodel.integrators.load_history import Load, checked_load
from wavemodel.integrators.viscoelastic import Prony
from wavemodel.physics.contact import Adhesion, DryFriction, PermanentSet
from wavemodel.physics.elastic import Floor, InterfaceSlip, Pretension, StrainStiffening, StressSoftening
from wavemodel.physics.load_segment import BodyOption, LoadSegment, Memory, RelaxingOption
from wavemodel.physics.time_dependent import PoroelasticDrainage, RelaxingForce, ViscousDamping

ForceLaw: TypeAlias = Callable[[FloatArray], FloatArray]
"""Depths (n,) of 0 and more, m, to forces (n,), N: rising, zero at zero. It raises `WaveError` beyond its range."""
WIDENINGS = 60
EXACT = 1e-13
"""Of the force, and of the depth (relatively), to which a step is solved."""
CHORDS, CLOSE = 60, 1e-12
"""At most so many, and the share of the force to which they are to come, for where a free surface stands: false
position, an end that stays halved (M. Dowell and P. Jarratt, BIT 11 (1971) 168)."""
PASSES = 12
"""At most, where how fast fluid drains goes with where the tool touches."""
NO_SET, NO_ADHESION = PermanentSet(0.0), Adhesion()


@dataclass(frozen=True)
class Physics:
    """Options of a body on top of an elastic law f(d), acting in this order.

    The tool meets the surface where `permanent_set` left it; `adhesion` says whether they touch. The elastic force is
    f, changed by `stiffening`, `pretension`, `floor`, `slip` and `softening`. It relaxes by `relaxation` and
    `drainage`, and `damping` and `friction` act beside it. A tool that is not held cannot be pulled: one that goes up
    faster than the tissue creeps loses it, and meets it again where it then stands.

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
    def relaxing(self) -> tuple[RelaxingOption, ...]:
        """What lets the force relax, in order."""
        relaxation = None if self.relaxation is None else RelaxingForce(self.relaxation)
        return tuple(option for option in (relaxation, self.drainage) if option is not None)

    @property
    def retardation(self) -> float:
        """Kelvin-Voigt time, s."""
        return 0.0 if self.damping is None else self.damping.retardation

    @property
    def drains_alike(self) -> bool:
        """Whether fluid drains alike however deep the tool is."""
        return self.drainage is None or self.drainage.edge == 0.0

    @cached_property
    def beside(self) -> tuple[BodyOption, ...]:
        """What acts beside the elastic force."""
        return tuple(option for option in (self.damping, self.friction) if option is not None)


@dataclass(frozen=True)
class PressState:
    """What a body remembers of a press: whether it is touched, and the memories of its options in their order.

    `depth` is that of the last touch below where permanent set left the surface, m: a free one stands no deeper.
    """

    touching: bool
    surface: Memory
    options: tuple[Memory, ...]
    depth: float = 0.0


@dataclass(frozen=True)
class PressTrace:
    """n samples of a press.

    Attributes
    ----------
    depth
        (n,) of the tool, m.
    force
        (n,) on the tool, N.
    elastic
        (n,) elastic part of the force, before it relaxes, N.
    touching
        (n,) whether tool and tissue are in contact.
    stands
        Works out `surface`, which costs as much as the rest and not every reader needs.
    """

    depth: FloatArray
    force: FloatArray
    elastic: FloatArray
    touching: BoolArray
    stands: Callable[[], FloatArray]

    @cached_property
    def surface(self) -> FloatArray:
        """(n,) where the tissue under the tool stands, m.

        At the tool where they touch, else where it has crept back to, in the end where permanent set left it.
        """
        return self.stands()


def joined(pieces: Sequence[PressTrace]) -> PressTrace:
    """One trace of several that follow each other."""
    depth, force, elastic, touching = (
        np.concatenate([getattr(one, name) for one in pieces]) for name in ("depth", "force", "elastic", "touching")
    )
    return PressTrace(depth, force, elastic, touching, lambda: np.concatenate([one.surface for one in pieces]))


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
        tool, first = self._elastic(self._touched(duration, met, state.touching, held), state)
        elastic = tool
        if not held and (self.physics.relaxing or self.physics.retardation):
            elastic, relaxed, second = self._unheld(tool, state)
        else:
            relaxed, second = _chain(self.physics.relaxing, elastic, iter(state.options[len(first) :]))
        memories = iter(state.options[len(first) + len(second) :])
        force, third = relaxed.force, []
        for option in self.physics.beside:
            part, memory = option.act(elastic, next(memories))
            force = force + part
            third.append(memory)
        if not held:
            force = np.where(elastic.touching, np.maximum(force, -self._adhesion.force), 0.0)
        options = (*first, *second, *third)
        after = PressState(bool(elastic.touching[-1]), set_memory, options, float(_last_touched(elastic, state)[-1]))

        def stands() -> FloatArray:
            scale = np.divide(depth - surface, met, out=np.ones_like(depth), where=met != 0.0)
            below = np.maximum(self._stood(tool, elastic, state), 0.0)
            return np.where(elastic.touching, depth, surface + scale * below)

        return PressTrace(depth, force, elastic.force, elastic.touching, stands), after

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

    def _elastic(self, bare: LoadSegment, state: PressState) -> tuple[LoadSegment, list[Memory]]:
        return _chain(self.physics.elastic, bare, iter(state.options))

    def _unheld(self, tool: LoadSegment, state: PressState) -> tuple[LoadSegment, LoadSegment, list[Memory]]:
        """Elastic and relaxed force of a surface that a tool may lose, and what relaxes remembers."""
        segment, touching = tool, tool.touching
        for _ in range(PASSES):
            found = self._standing(segment, tool, state)
            segment = replace(tool, force=found.value, touching=~found.free)
            if self.physics.drains_alike or np.array_equal(segment.touching, touching):
                break
            touching = segment.touching
        second = [(one.last, *np.real(one.state).tolist()) for one in found.memories]
        return segment, replace(segment, force=found.answer), second

    def _standing(self, before: LoadSegment, tool: LoadSegment, state: PressState) -> Standing:
        """How the surface stands under a tool, drained as far as it was touched before."""
        memories = state.options[len(self.physics.elastic) :]
        last = next((memory[0] for memory in memories if memory), float(tool.force[0]) if tool.endless else 0.0)
        return standing(
            self._stages(replace(before, depth=_last_touched(before, state)), state),
            tool.duration,
            tool.force,
            tool.touching,
            rate=self.physics.retardation,
            last=last,
            hold=self._adhesion.force,
            held=state.touching,
        )

    def _stages(self, segment: LoadSegment, state: PressState) -> list[LagStage]:
        stages: list[LagStage] = []
        memories = state.options[len(self.physics.elastic) :]
        for option, memory in zip(self.physics.relaxing, memories, strict=False):
            if stages:
                segment = replace(segment, force=stages[-1].follow(segment.force)[0])
            stages.append(option.stage(segment, memory))
        return stages

    def _stood(self, tool: LoadSegment, elastic: LoadSegment, state: PressState) -> FloatArray:
        """(n,) depth below the surface at which it stands, m; what a tool does not touch is at that of its force."""
        away = ~elastic.touching & (elastic.force > 0.0)
        return self._depth_at(tool, elastic.force, away, state) if away.any() else tool.depth

    def _depth_at(self, tool: LoadSegment, force: FloatArray, away: BoolArray, state: PressState) -> FloatArray:
        """(n,) depth below the surface at which it stands, m: the tool's, or where it is away that of its force."""
        high = np.maximum(np.maximum.accumulate(tool.depth), state.depth)
        low, side = np.zeros_like(high), np.zeros(high.size)

        def off(depth: FloatArray) -> FloatArray:
            tried, _ = self._elastic(self._bare(tool, np.where(away, depth, tool.depth), tool.touching | away), state)
            return tried.force - force

        under, over, middle = off(low), off(high), high
        for _ in range(CHORDS):
            width = over - under
            middle = high - over * np.divide(high - low, width, out=np.zeros_like(width), where=width != 0.0)
            left = off(middle)
            if np.all(np.abs(left[away]) <= CLOSE * np.abs(force[away])):
                break
            below = left < 0.0
            under, over = np.where(side > 0.0, 0.5 * under, under), np.where(side < 0.0, 0.5 * over, over)
            low, high = np.where(below, middle, low), np.where(below, high, middle)
            under, over = np.where(below, left, under), np.where(below, over, left)
            side = np.where(below, -1.0, 1.0)
        return np.where(away, middle, tool.depth)

    def _bare(self, tool: LoadSegment, depth: FloatArray, touching: BoolArray) -> LoadSegment:
        """The bare law at other depths."""
        size = self.law(np.where(touching, np.abs(depth), 0.0))
        return LoadSegment(tool.duration, depth, np.where(touching, np.copysign(size, depth), 0.0), touching)


def _last_touched(segment: LoadSegment, state: PressState) -> FloatArray:
    """(n,) depth below the surface, m: the tool's, or where it is away that at which it last touched."""
    at = np.maximum.accumulate(np.where(segment.touching, np.arange(segment.depth.size), -1))
    return np.where(at >= 0, segment.depth[at], state.depth)


def _chain(
    options: Sequence[BodyOption], segment: LoadSegment, memories: Iterator[Memory]
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
