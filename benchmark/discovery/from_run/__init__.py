"""A finished run as the measurement: the wave model repaired against the finite elements."""

from benchmark.discovery.from_run.finished_run import FinishedRun, at_small_strain, is_run, read_run
from benchmark.discovery.from_run.run_answer import repair_run

__all__ = ["FinishedRun", "at_small_strain", "is_run", "read_run", "repair_run"]
