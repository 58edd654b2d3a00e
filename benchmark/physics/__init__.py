"""The physics that a model can have or lack: one file an effect, in `body`, `drive` and `observation` where it acts."""

from benchmark.physics.description import EffectDescription, EffectParameter, Option
from benchmark.physics.effect import (
    BodyResponse,
    DepthRecord,
    Effect,
    FemTerm,
    LowerFaceMotion,
    Motion,
    NotInFemError,
    PressHistory,
    Readings,
    Together,
    TrialContext,
)
from benchmark.physics.registry import SLUGS, catalogue, load_effects, option_effects

__all__ = [
    "SLUGS",
    "BodyResponse",
    "DepthRecord",
    "Effect",
    "EffectDescription",
    "EffectParameter",
    "FemTerm",
    "LowerFaceMotion",
    "Motion",
    "NotInFemError",
    "Option",
    "PressHistory",
    "Readings",
    "Together",
    "TrialContext",
    "catalogue",
    "load_effects",
    "option_effects",
]
