"""Protocols of motion: what a file may say (segments, their keys, units and bounds; SI inside), and how it is read.

Depths are measured from the touch (the last `approach` of the trial) or, before one, from the rig's nominal
contact; positive into the specimen. A `hold` after a `move` to a force holds the position, not the force.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from bench_hw.configuration import (
    Duration,
    Force,
    Length,
    Speed,
    StrictModel,
    find_file,
    read_toml,
    shipped_files,
    validated,
)

CLEARANCE = 2e-3
"""Distance to the specimen between trials of a protocol without a retraction, m."""
MOST_FORCE = 100.0
"""Largest force of a protocol, N."""
Depth = Annotated[Length, Field(ge=-0.1, le=0.1)]
Pace = Annotated[Speed, Field(gt=0.0, le=0.1)]
Time = Annotated[Duration, Field(gt=0.0, le=86_400.0)]
Push = Annotated[Force, Field(gt=0.0, le=MOST_FORCE)]


class Wait(StrictModel):
    """Stay where the tool is: `rest` in air, `hold` in the specimen."""

    kind: Literal["rest", "hold"]
    duration: Time


class Approach(StrictModel):
    """Go down until the press force reaches `touch_force`; that place becomes depth zero."""

    kind: Literal["approach"]
    touch_force: Push
    speed: Pace
    max_depth: Annotated[Length, Field(gt=0.0, le=0.1)]


class Move(StrictModel):
    """Go to a depth, or up or down until the press force is reached."""

    kind: Literal["move"]
    depth: Depth | None = None
    force: Annotated[Force, Field(ge=0.0, le=MOST_FORCE)] | None = None
    speed: Pace

    @model_validator(mode="after")
    def _one_target(self) -> Self:
        if (self.depth is None) == (self.force is None):
            raise ValueError("a move needs either depth or force")
        return self


class Cycle(StrictModel):
    """Go to the first depth, then `count` times to the second and back."""

    kind: Literal["cycle"]
    depth: tuple[Depth, Depth]
    speed: Pace
    count: Annotated[int, Field(ge=1, le=10_000, strict=True)]

    @model_validator(mode="after")
    def _two_depths(self) -> Self:
        if self.depth[0] == self.depth[1]:
            raise ValueError("the two depths of a cycle must differ")
        return self


class Retract(StrictModel):
    """Go back to a depth, usually a negative one (in air)."""

    kind: Literal["retract"]
    depth: Depth
    speed: Pace


Segment = Annotated[Wait | Approach | Move | Cycle | Retract, Field(discriminator="kind")]


class Protocol(StrictModel):
    """A whole protocol.

    `setup` is what a person must do first (another tool, a rigid block, a picture of a ruler): it is shown
    before the capture begins and not acted upon.
    """

    schema_version: Annotated[Literal[1], Field(alias="schema")]
    name: Annotated[str, Field(min_length=1, max_length=100)]
    description: str = ""
    setup: dict[str, Any] = Field(default_factory=dict)
    segments: Annotated[tuple[Segment, ...], Field(min_length=1, max_length=10_000)]

    @property
    def fastest(self) -> float:
        """Largest speed of any segment, m/s; 0 if nothing moves."""
        return max((getattr(segment, "speed", 0.0) for segment in self.segments), default=0.0)

    @property
    def moves(self) -> bool:
        """Whether anything in it moves; a protocol that only rests needs no depth zero."""
        return any(not isinstance(segment, Wait) for segment in self.segments)

    @property
    def rest_depth(self) -> float:
        """Depth at which it leaves the tool between trials, m: that of its last retraction, else 2 mm in air.

        A protocol that only rests leaves the tool where it is; without a place of its own this is 0.
        """
        if not self.moves:
            return 0.0
        depths = [segment.depth for segment in self.segments if isinstance(segment, Retract)]
        return depths[-1] if depths else -CLEARANCE

    @property
    def approach(self) -> Approach | None:
        """Its first approach: whether and how the tool finds the specimen by touch."""
        return next((segment for segment in self.segments if isinstance(segment, Approach)), None)

    @property
    def depths(self) -> tuple[float, ...]:
        """Every depth it names, m (the farthest of an approach is none: the travel limits it)."""
        named = [depth for segment in self.segments for depth in _depths(segment)]
        return tuple(named)


def _depths(segment: Wait | Approach | Move | Cycle | Retract) -> tuple[float, ...]:
    if isinstance(segment, Cycle):
        return segment.depth
    if isinstance(segment, Move | Retract) and segment.depth is not None:
        return (segment.depth,)
    return ()


@dataclass(frozen=True, slots=True)
class LoadedProtocol:
    """A protocol, the text of its file and where that was."""

    protocol: Protocol
    text: str
    path: Path


def shipped_protocols() -> dict[str, Path]:
    """Give the shipped protocols: name to path."""
    return shipped_files("bench_hw.motion")


def load_protocol(name_or_path: str | Path) -> LoadedProtocol:
    """Read a protocol of motion.

    Raises
    ------
    InputError
        No such file or shipped name, or the file says something that is not allowed.
    """
    path = find_file("protocol", name_or_path, shipped_protocols())
    tables, text = read_toml(path)
    return LoadedProtocol(validated(Protocol, tables, str(path)), text, path)
