"""What passes between the harness and a model's process: small frozen dataclasses, nothing else."""

from __future__ import annotations

from dataclasses import dataclass

from benchmark.models import ModelResult, StepProgress


@dataclass(frozen=True)
class RunCommand:
    """Set the model up and follow the load history; `keep_result` False returns the timing alone."""

    keep_result: bool


@dataclass(frozen=True)
class Remark:
    """What a person should know while the model runs, one sentence."""

    text: str


@dataclass(frozen=True)
class Seconds:
    """One execution: set-up, then wall and CPU time of the load history alone, in s.

    Reading profiles and fields off the finished history counts as neither.
    """

    setup: float
    wall: float
    cpu: float


@dataclass(frozen=True)
class Finished:
    """A finished execution, complete or stopped early.

    Attributes
    ----------
    seconds
        What it took.
    result
        None where it was not asked for.
    peak_memory
        Of its process in bytes where it is known.
    frame
        Wall s of a picture of all faces (`benchmark.models.frames`); None where it was not timed.
    """

    seconds: Seconds
    result: ModelResult | None
    peak_memory: int | None = None
    frame: float | None = None


@dataclass(frozen=True)
class Declined:
    """The model does not cover the scenario."""

    reason: str


@dataclass(frozen=True)
class Crashed:
    """An exception in the model's process. `input_error` says that the scenario, not the code, is at fault."""

    message: str
    trace: str
    input_error: bool


Answer = Finished | Declined | Crashed
Message = StepProgress | Remark | Answer
