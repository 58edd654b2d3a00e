"""One face over the finite-element solver and the wave models."""

from benchmark.models.prepare import prepare, scenario_drive
from benchmark.models.result import (
    Array,
    Drive,
    FieldSnapshot,
    ModelResult,
    PreparedModel,
    RunFailure,
    StepProgress,
    UncoveredError,
    silent,
)

__all__ = [
    "Array",
    "Drive",
    "FieldSnapshot",
    "ModelResult",
    "PreparedModel",
    "RunFailure",
    "StepProgress",
    "UncoveredError",
    "prepare",
    "scenario_drive",
    "silent",
]
