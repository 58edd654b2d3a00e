"""The physics that a model can have or lack: one file an effect, in `body`, `drive` and `observation` where it acts."""

from benchmark.physics.description import EffectDescription, EffectParameter
from benchmark.physics.effect import (
    BodyResponse,
    Effect,
    LowerFaceMotion,
    Motion,
    PressHistory,
    Readings,
    TrialContext,
)
from benchmark.physics.registry import SLUGS, catalogue, load_effects

__all__ = [
    "SLUGS",
    "BodyResponse",
    "Effect",
    "EffectDescription",
    "EffectParameter",
    "LowerFaceMotion",
    "Motion",
    "PressHistory",
    "Readings",
    "TrialContext",
    "catalogue",
    "load_effects",
]
