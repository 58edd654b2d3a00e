"""The dry run: where the tool would be when, how long a trial takes, and both to look at. Nothing moves.

What only the specimen decides is assumed and marked: contact at depth zero, and one newton per millimetre for
moves to a force.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import singledispatch
from typing import TYPE_CHECKING

from bench_hw.errors import InputError
from bench_hw.motion.protocol_file import Approach, Cycle, Move, Protocol, Retract, Wait

if TYPE_CHECKING:
    from pathlib import Path


ASSUMED_STIFFNESS = 1000.0
"""Press force per depth assumed for moves to a force, N/m."""
PICTURE = "motion of a trial, tissuebench"
"""Title of the picture's file."""
Piece = tuple[float, float, bool]
_WIDTH, _HEIGHT = 64, 11


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
class MotionPlan:
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


def plan(protocol: Protocol, start_depth: float | None = None) -> MotionPlan:
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
    return MotionPlan(protocol.name, tuple(steps))


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


def summary(plan: MotionPlan, trials: int = 1) -> list[str]:
    """Say each step and the sum of times, a line each."""
    lines = [f"{plan.name}: {plan.duration:.1f} s a trial, {trials} trial(s): {plan.duration * trials:.1f} s in all"]
    for step in plan.steps:
        speed = abs(step.depth_to - step.depth_from) / step.duration if step.duration else 0.0
        lines.append(
            f"  {step.start:8.1f} s  {step.kind:<9}{step.duration:8.1f} s  "
            f"{step.depth_from * 1e3:+7.2f} to {step.depth_to * 1e3:+7.2f} mm  {speed * 1e3:6.2f} mm/s"
            + ("  (assumed)" if step.assumed else "")
        )
    if all(step.depth_from == step.depth_to for step in plan.steps):
        lines.append("  nothing moves: the tool stays where it is")
    if plan.assumed:
        lines.append(f"  assumed: contact at depth 0, {ASSUMED_STIFFNESS / 1e3:g} N/mm; the specimen decides")
    return lines


def drawing(plan: MotionPlan) -> list[str]:
    """Draw depth over time with characters, depth downwards."""
    depths = [_depth_at(plan, (column + 0.5) / _WIDTH * plan.duration) for column in range(_WIDTH)]
    low, high = min(depths), max(depths)
    span = (high - low) or 1e-3
    rows = [round((depth - low) / span * (_HEIGHT - 1)) for depth in depths]
    lines = []
    for row in range(_HEIGHT):
        label = f"{(low + span * row / (_HEIGHT - 1)) * 1e3:+7.2f} mm "
        lines.append(label + "|" + "".join("*" if at == row else " " for at in rows).rstrip())
    return [*lines, " " * 11 + "+" + "-" * _WIDTH, f"{'0':>12}{plan.duration:>{_WIDTH}.1f} s"]


def write_plot(plan: MotionPlan, path: Path) -> Path:
    """Write depth over time as an SVG picture, whole or not at all.

    Raises
    ------
    InputError
        There is a file that is no such picture, or the name has another ending.
    OSError
        The folder cannot be made or written.
    """
    import io

    if path.suffix.lower() != ".svg":
        raise InputError(f"{path}: the motion is drawn as SVG; allowed: a name that ends in .svg")
    from matplotlib.figure import Figure

    from bench_hw.storage.atomic import check_replaceable, write_bytes

    check_replaceable(path, PICTURE.encode(), "a picture of a motion")
    figure = Figure(figsize=(8.0, 3.0), layout="constrained")
    axes = figure.add_subplot()
    times = [0.0] + [step.start + step.duration for step in plan.steps]
    depths = [plan.steps[0].depth_from] + [step.depth_to for step in plan.steps]
    axes.plot(times, [depth * 1e3 for depth in depths])
    axes.axhline(0.0, linewidth=0.5, color="0.5")
    axes.invert_yaxis()
    axes.set(xlabel="time, s", ylabel="depth, mm", title=f"{plan.name}: {plan.duration:.1f} s (dry run)")
    picture = io.BytesIO()
    figure.savefig(picture, format="svg", metadata={"Date": None, "Title": PICTURE})
    return write_bytes(path, picture.getvalue())


def _depth_at(plan: MotionPlan, time: float) -> float:
    for step in plan.steps:
        if time <= step.start + step.duration and step.duration > 0.0:
            share = (time - step.start) / step.duration
            return step.depth_from + share * (step.depth_to - step.depth_from)
    return plan.steps[-1].depth_to
