"""A finished run as the measurement: the wave model repaired against the finite elements."""

from benchmark.discovery.from_run.answer import repair_run
from benchmark.discovery.from_run.reading import FinishedRun, is_run, read_run

__all__ = ["FinishedRun", "is_run", "read_run", "repair_run"]
