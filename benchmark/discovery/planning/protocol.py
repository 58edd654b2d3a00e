"""Protocols as the bench reads them: the motion of an experiment in time, its duration, and its file."""

from __future__ import annotations

import numpy as np

from bench_hw.configuration import validated
from bench_hw.motion.plan import Plan, plan
from bench_hw.motion.protocol import Protocol
from benchmark.discovery.planning.menu import Experiment
from benchmark.discovery.result import Array

BETWEEN = 0.5
"""Minutes between two trials."""


def motion(experiment: Experiment, rows: int) -> tuple[Array, Array]:
    """Time s and depth m (rows,) of one trial, evenly spaced."""
    steps = dry_run(experiment).steps
    times = np.array([0.0, *(step.start + step.duration for step in steps)])
    depths = np.array([steps[0].depth_from, *(step.depth_to for step in steps)])
    time = np.linspace(0.0, times[-1], rows)
    return time, np.interp(time, times, depths)


def minutes(experiment: Experiment, trials: int) -> float:
    """Bench time of as many trials."""
    return experiment.setup_minutes + trials * (dry_run(experiment).duration / 60.0 + BETWEEN)


def protocol_toml(experiment: Experiment) -> str:
    """The protocol file, checked as the bench checks it."""
    import tomli_w

    table = experiment.table()
    validated(Protocol, table, experiment.name)
    return tomli_w.dumps(table)


def dry_run(experiment: Experiment) -> Plan:
    """Where the tool would be when."""
    return plan(validated(Protocol, experiment.table(), experiment.name))
