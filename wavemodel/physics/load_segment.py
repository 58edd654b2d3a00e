"""A piece of a load history as the options of a body see it, and what an option is."""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

from wavemodel.arrays import BoolArray, FloatArray
from wavemodel.integrators.lags import LagStage

Memory: TypeAlias = tuple[float, ...]
"""What an option remembers between two pieces of a history; empty before the first."""


@dataclass(frozen=True)
class LoadSegment:
    """n successive samples.

    Attributes
    ----------
    duration
        (n,) of the steps that end at the samples, s. The first is zero where the body has been in the first state for
        ever.
    depth
        (n,) of the tool below the surface as it stands, m; negative in air, or while the tissue is pulled.
    force
        (n,) as far as it is worked out, N.
    touching
        (n,) whether tool and tissue are in contact.
    """

    duration: FloatArray
    depth: FloatArray
    force: FloatArray
    touching: BoolArray

    @property
    def endless(self) -> bool:
        """Whether the body has been in its first state for ever."""
        return bool(self.duration[0] == 0.0)


class BodyOption(Protocol):
    """One effect: it changes the force, knowing its own past."""

    def act(self, segment: LoadSegment, memory: Memory) -> tuple[FloatArray, Memory]:
        """(n,) force with the effect, and the memory after the last sample."""
        ...


class RelaxingOption(BodyOption, Protocol):
    """One that lets the force relax."""

    def stage(self, segment: LoadSegment, memory: Memory) -> LagStage:
        """Its lags over the steps of a segment, whose force may still be another, with their memory."""
        ...
