"""Carrying a protocol out, one observation at a time; no device is touched here.

`carry_out` is a generator: before each `next` its caller brings the `Observation` up to date; it yields a
command for the actuator, something to note in the trial file, or None when there is nothing to do but wait.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import singledispatch

from bench_hw.errors import DeviceError
from bench_hw.motion.protocol_file import Approach, Cycle, Move, Protocol, Retract, Wait

_PATIENCE = 3.0
_GRACE = 2.0
_AHEAD = 0.5
"""How far ahead of the tool a press to a force is sent, s of its speed: as far as a board goes that nobody stops."""
_LEAST_AHEAD = 4.0
"""The least of that in the actuator's own uncertainties, so that its dead band does not stop it on the way."""


class MotionError(DeviceError):
    """The motion cannot be carried out: nothing touched, a force out of reach, an actuator that stands still."""


@dataclass(frozen=True, slots=True)
class MoveTo:
    """Send the actuator to `position` (m) at `speed` (m/s)."""

    position: float
    speed: float


@dataclass(frozen=True, slots=True)
class Halt:
    """Stop the actuator where it is."""


@dataclass(frozen=True, slots=True)
class Note:
    """Something to write down: a short kind and a sentence."""

    kind: str
    message: str


Action = MoveTo | Halt | Note | None


@dataclass(slots=True)
class Observation:
    """What is known at this moment; the caller updates the first three.

    Parameters
    ----------
    time : float
        Clock, s.
    position : float
        Actuator, m from fully retracted.
    press : float
        Press force, N.
    zero : float
        Position of depth zero, m; an approach sets it.
    tolerance : float
        Half-width within which the actuator counts as arrived, m.
    travel : tuple of 2 floats
        Lowest and highest position allowed, m.
    """

    time: float
    position: float
    press: float
    zero: float
    tolerance: float
    travel: tuple[float, float]

    def at(self, position: float) -> bool:
        """Whether the actuator has arrived at `position`."""
        return abs(self.position - position) <= self.tolerance


def carry_out(protocol: Protocol, now: Observation) -> Iterator[Action]:
    """Go through all segments.

    Raises
    ------
    MotionError
        From `next`: what was asked for cannot be done.
    """
    for number, segment in enumerate(protocol.segments, start=1):
        yield Note("segment", f"{number} of {len(protocol.segments)}: {segment.kind}")
        yield from _steps(segment, now)


def go_to(position: float, speed: float, now: Observation) -> Iterator[Action]:
    """Bring the tool to a position (m from fully retracted), apart from any protocol.

    Raises
    ------
    MotionError
        From `next`: it is outside the travel, or the actuator does not get there.
    """
    yield from _go(now, position, speed)


@singledispatch
def _steps(segment: object, now: Observation) -> Iterator[Action]:  # noqa: ARG001 - the dispatch's signature
    raise TypeError(f"no steps for {type(segment).__name__}")


@_steps.register
def _(segment: Wait, now: Observation) -> Iterator[Action]:
    end = now.time + segment.duration
    while now.time < end:
        yield None


@_steps.register
def _(segment: Approach, now: Observation) -> Iterator[Action]:
    target = min(now.zero + segment.max_depth, now.travel[1])
    _check_in_air(segment, now)
    for action in _go(now, target, segment.speed, until=segment.touch_force):
        yield action
        _check_direction(segment, now)
    if now.press < segment.touch_force:
        raise MotionError(
            f"approach: no touch of {segment.touch_force:g} N down to {(target - now.zero) * 1e3:.2f} mm "
            f"(press force {now.press:.3f} N); raise max_depth, or put the specimen nearer"
        )
    now.zero = now.position
    yield Note("touch", f"touched at position {now.position * 1e3:.3f} mm with {now.press:.4f} N")


def _check_in_air(segment: Approach, now: Observation) -> None:
    """Refuse a touch before the tool has moved: where it stands would be taken for the specimen's surface."""
    if now.press >= segment.touch_force:
        raise MotionError(
            f"approach: the press force is {now.press:.3f} N before the tool moves, at position "
            f"{now.position * 1e3:.2f} mm; allowed is less than touch_force ({segment.touch_force:g} N): zero the "
            "sensor (force.bias = true in the rig file), or let the tool begin in air"
        )


def _check_direction(segment: Approach, now: Observation) -> None:
    """End an approach that would press on and on: the force grows the wrong way."""
    if now.press <= -segment.touch_force:
        raise MotionError(
            f"approach: the press force is {now.press:.3f} N at position {now.position * 1e3:.2f} mm, negative where "
            "the tool presses: turn the sign of force.press_axis in the rig file, or zero the sensor (force.bias)"
        )


@_steps.register
def _(segment: Move, now: Observation) -> Iterator[Action]:
    if segment.depth is not None:
        yield from _go(now, now.zero + segment.depth, segment.speed)
        return
    force = segment.force or 0.0
    down = now.press < force
    target = now.travel[1] if down else now.travel[0]
    ahead = max(_AHEAD * segment.speed, _LEAST_AHEAD * now.tolerance) if down else None
    yield from _go(now, target, segment.speed, until=force, down=down, ahead=ahead)
    if (now.press < force) if down else (now.press > force):
        raise MotionError(
            f"move: {force:g} N was not reached within the travel (press force {now.press:.3f} N at "
            f"position {now.position * 1e3:.2f} mm)"
        )


@_steps.register
def _(segment: Retract, now: Observation) -> Iterator[Action]:
    yield from _go(now, now.zero + segment.depth, segment.speed)


@_steps.register
def _(segment: Cycle, now: Observation) -> Iterator[Action]:
    first, second = (now.zero + depth for depth in segment.depth)
    yield from _go(now, first, segment.speed)
    for number in range(1, segment.count + 1):
        yield Note("cycle", f"cycle {number} of {segment.count}")
        yield from _go(now, second, segment.speed)
        yield from _go(now, first, segment.speed)


def _go(
    now: Observation,
    target: float,
    speed: float,
    *,
    until: float | None = None,
    down: bool = True,
    ahead: float | None = None,
) -> Iterator[Action]:
    """Move to `target` and wait for it, or stop on the way when the press force passes `until`.

    With `ahead` (m) the actuator is never sent farther than that beyond where it stands; it is sent on before it comes
    there, so that it does not stop. A board has no watchdog: it goes on to where it was sent when its computer dies.
    """
    target = _inside_travel(now, target)
    if now.at(target) and until is None:
        return
    deadline = now.time + _PATIENCE * abs(target - now.position) / speed + _GRACE
    sent = target if ahead is None else min(target, now.position + ahead)
    yield MoveTo(sent, speed)
    while not now.at(target):
        if until is not None and (now.press >= until if down else now.press <= until):
            yield Halt()
            return
        if now.time > deadline:
            raise MotionError(
                f"the actuator did not reach {target * 1e3:.2f} mm in {_PATIENCE:g} times the time it needs: it "
                f"stands at {now.position * 1e3:.2f} mm; check its power and the load"
            )
        if ahead is not None and sent < target and sent - now.position <= 0.5 * ahead:
            sent = min(target, now.position + ahead)
            yield MoveTo(sent, speed)
        yield None


def _inside_travel(now: Observation, target: float) -> float:
    """Refuse what is outside the travel; what is within the actuator's own uncertainty of it goes to its end."""
    low, high = now.travel
    if not low - now.tolerance <= target <= high + now.tolerance:
        raise MotionError(
            f"target position {target * 1e3:.2f} mm (depth {(target - now.zero) * 1e3:.2f} mm) is outside the "
            f"travel of {low * 1e3:g} to {high * 1e3:g} mm"
        )
    return min(max(target, low), high)
