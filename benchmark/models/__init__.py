"""One face over the finite-element solver, the wave models, and a user's own in their places."""

from benchmark.models.frames import frame_seconds
from benchmark.models.keeping import Keeping
from benchmark.models.own import NOTHING, Own
from benchmark.models.prepare import prepare, scenario_drive
from benchmark.models.reference import Reference, read_reference
from benchmark.models.result import (
    Array,
    Drive,
    FieldSnapshot,
    LastState,
    ModelResult,
    PreparedModel,
    Reading,
    Resumption,
    RunFailure,
    StepProgress,
    UncoveredError,
    silent,
)
from benchmark.models.user_file import UserFile, read_user_file

__all__ = [
    "NOTHING",
    "Array",
    "Drive",
    "FieldSnapshot",
    "Keeping",
    "LastState",
    "ModelResult",
    "Own",
    "PreparedModel",
    "Reading",
    "Reference",
    "Resumption",
    "RunFailure",
    "StepProgress",
    "UncoveredError",
    "UserFile",
    "frame_seconds",
    "prepare",
    "read_reference",
    "read_user_file",
    "scenario_drive",
    "silent",
]
