"""A finished run as the measurement: the wave model repaired against the finite elements."""

from benchmark.discovery.from_run.answer import repair_run
from benchmark.discovery.from_run.reading import FinishedRun, is_run, read_run
from benchmark.discovery.from_run.small_strain import at_small_strain

__all__ = ["FinishedRun", "at_small_strain", "is_run", "read_run", "repair_run"]
