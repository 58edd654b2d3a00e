"""The dry run: where the tool would be when, and how long a trial takes. Nothing moves.

What only the specimen decides is assumed and marked: contact at depth zero, and one newton per millimetre for
moves to a force.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import singledispatch

from bench_hw.motion.protocol import Approach, Cycle, Move, Protocol, Retract, Wait

ASSUMED_STIFFNESS = 1000.0
"""Press force per depth assumed for moves to a force, N/m."""


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """One straight piece of the motion.

    Parameters
    ----------
    segment : int
        Number of the segment, from 1.
    kind : str
        Its kind.
    start, duration : float
        s.
    depth_from, depth_to : float
        m.
    assumed : bool
        Whether the specimen decides it.
    """

    segment: int
    kind: str
    start: float
    duration: float
    depth_from: float
    depth_to: float
    assumed: bool = False


@dataclass(frozen=True, slots=True)
class Plan:
    """A protocol's dry run."""

    name: str
    steps: tuple[PlannedStep, ...]

    @property
    def duration(self) -> float:
        """Sum of all times, s."""
        return sum(step.duration for step in self.steps)

    @property
    def assumed(self) -> bool:
        """Whether any time depends on what was assumed of the specimen."""
        return any(step.assumed for step in self.steps)

    @property
    def deepest(self) -> float:
        """Largest depth, m."""
        return max((step.depth_to for step in self.steps), default=0.0)


def plan(protocol: Protocol, start_depth: float | None = None) -> Plan:
    """Work out a protocol's motion.

    Parameters
    ----------
    protocol : Protocol
        What to do.
    start_depth : float, optional
        Where the tool stands at the start, m; by default where the protocol leaves it between trials.
    """
    depth = protocol.rest_depth if start_depth is None else start_depth
    steps: list[PlannedStep] = []
    time = 0.0
    for number, segment in enumerate(protocol.segments, start=1):
        for duration, target, assumed in _pieces(segment, depth):
            if duration == 0.0:
                continue
            steps.append(PlannedStep(number, segment.kind, time, duration, depth, target, assumed))
            time, depth = time + duration, target
    return Plan(protocol.name, tuple(steps))


Piece = tuple[float, float, bool]


@singledispatch
def _pieces(segment: object, depth: float) -> Iterator[Piece]:  # noqa: ARG001 - the dispatch's signature
    """Duration (s), depth at the end (m) and whether assumed, of each straight piece of a segment."""
    raise TypeError(f"no plan for {type(segment).__name__}")


@_pieces.register
def _(segment: Wait, depth: float) -> Iterator[Piece]:
    yield segment.duration, depth, False


@_pieces.register
def _(segment: Approach, depth: float) -> Iterator[Piece]:
    yield abs(depth) / segment.speed, 0.0, True


@_pieces.register
def _(segment: Move, depth: float) -> Iterator[Piece]:
    target = (segment.force or 0.0) / ASSUMED_STIFFNESS if segment.depth is None else segment.depth
    yield abs(target - depth) / segment.speed, target, segment.depth is None


@_pieces.register
def _(segment: Retract, depth: float) -> Iterator[Piece]:
    yield abs(segment.depth - depth) / segment.speed, segment.depth, False


@_pieces.register
def _(segment: Cycle, depth: float) -> Iterator[Piece]:
    first, second = segment.depth
    yield abs(first - depth) / segment.speed, first, False
    for _number in range(segment.count):
        yield abs(second - first) / segment.speed, second, False
        yield abs(second - first) / segment.speed, first, False
