"""The elastic force-depth curves of a session's specimen, each from one depth ramp of the finite-element solver.

An elastic force depends on the depth alone, so a ramp serves every depth history, and every unloading.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmark.errors import SolverError
from benchmark.files import Load, Scenario, Session, Support, Tissue, Tool
from benchmark.fitting import ForceCurve
from benchmark.models import Drive, ModelResult, StepProgress, prepare
from benchmark.runs.listener import Advance, Listener

Setup = tuple[Tool, Support]

STEP = 0.5e-3
LEAST_STEPS = 24
MOST_STEPS = 40
LEAST_REACH = 0.5
"""A curve that the solver followed at least this far of the depth asked for serves, with a warning."""


@dataclass(frozen=True)
class BaseCurves:
    """One curve for each tool and support, and what a reader must know of them."""

    curves: Mapping[Setup, ForceCurve]
    warnings: tuple[str, ...]


def base_curves(session: Session, depths: Mapping[Setup, float], listener: Listener) -> BaseCurves:
    """Compute a curve for each tool and support, deep enough for the `depths` (m) asked for.

    Raises
    ------
    SolverError
        The solver stops before half the depth, saying where.
    """
    curves, warnings = {}, []
    with listener.progress(f"{session.name}: force over depth of the specimen") as advance:
        for number, (setup, depth) in enumerate(depths.items(), start=1):
            scenario = setup_scenario(session, session.specimen, setup)
            result = _ramp(scenario, depth, f"FEM {number}", advance)
            curves[setup] = ForceCurve(result.depth, result.force)
            if result.failure is not None:
                warnings.append(_shallow(result, depth))
    return BaseCurves(curves, tuple(warnings))


def setup_scenario(session: Session, tissue: Tissue, setup: Setup) -> Scenario:
    """Return a scenario of a tissue under one tool and support of the session; its load is a place holder."""
    tool, support = setup
    load = Load(control="depth", peak=STEP, shape="ramp", duration=1.0, observations=1)
    return session.scenario(tissue, tool, support, load)


def _ramp(scenario: Scenario, depth: float, task: str, advance: Advance) -> ModelResult:
    """Ramp to `depth`, or as far as the solver follows."""
    steps = min(max(math.ceil(depth / STEP), LEAST_STEPS), MOST_STEPS)
    fractions = np.arange(1, steps + 1) / steps

    def on_step(step: StepProgress) -> None:
        advance(task, step.step, step.total, f"{1e3 * step.depth:.3g} mm")

    result = prepare("fem", scenario).run(Drive("depth", fractions, depth * fractions), on_step)
    if result.failure is not None and result.time.size < max(LEAST_REACH * steps, 2):
        raise SolverError(
            f"session {scenario.name}: {_stop(result, depth)}; a thicker specimen, a larger tool or trials of less "
            "depth can be followed"
        )
    return result


def _stop(result: ModelResult, depth: float) -> str:
    failure = result.failure
    assert failure is not None
    return (
        f"the finite-element curve of the specimen is needed to {1e3 * depth:.4g} mm but stopped at "
        f"{1e3 * failure.reached:.4g} mm ({failure.reason})"
    )


def _shallow(result: ModelResult, depth: float) -> str:
    return f"{_stop(result, depth)}; deeper rows are left out of the fit and have no finite-element force"
