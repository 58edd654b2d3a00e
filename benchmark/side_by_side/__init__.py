"""Running FEM and wave model side by side in processes of their own, and timing them."""

from benchmark.side_by_side.messages import Finished, Seconds
from benchmark.side_by_side.process import ModelProcess, single_threaded_children
from benchmark.side_by_side.runner import NAMES, ModelRun, SideBySide, run_side_by_side
from benchmark.side_by_side.timing import Speedup, speedup

__all__ = [
    "NAMES",
    "Finished",
    "ModelProcess",
    "ModelRun",
    "Seconds",
    "SideBySide",
    "Speedup",
    "run_side_by_side",
    "single_threaded_children",
    "speedup",
]
