"""Running FEM and wave model side by side in processes of their own, and timing them."""

from benchmark.side_by_side.process import ModelProcess
from benchmark.side_by_side.runner import (
    NAMES,
    SAME_ANSWER,
    ModelRun,
    SideBySide,
    Speedup,
    run_side_by_side,
    speedup,
)
from benchmark.side_by_side.worker import Finished, Seconds

__all__ = [
    "NAMES",
    "SAME_ANSWER",
    "Finished",
    "ModelProcess",
    "ModelRun",
    "Seconds",
    "SideBySide",
    "Speedup",
    "run_side_by_side",
    "speedup",
]
