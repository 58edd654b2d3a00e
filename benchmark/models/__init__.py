"""One face over the finite-element solver, the wave models, and a user's own in their places."""

from benchmark.models.model_result import (
    Array,
    Drive,
    FemChoices,
    FieldSnapshot,
    Keeping,
    LastState,
    ModelResult,
    PreparedModel,
    Reading,
    Resumption,
    RunFailure,
    StepProgress,
    UncoveredError,
    WaveChoices,
    silent,
)
from benchmark.models.own_models import NOTHING, Own, Reference, read_reference
from benchmark.models.prepare import frame_seconds, prepare, scenario_drive
from benchmark.models.user_file import UserFile, read_user_file

__all__ = [
    "NOTHING",
    "Array",
    "Drive",
    "FemChoices",
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
    "WaveChoices",
    "frame_seconds",
    "prepare",
    "read_reference",
    "read_user_file",
    "scenario_drive",
    "silent",
]
