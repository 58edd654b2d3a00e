"""The small-strain answer to a press of 1 N, and the warning where small strain is exceeded."""

from __future__ import annotations

import numpy as np

from fem.record import reaction
from fem.solving import Equilibrium, State, at_rest

LARGEST_SMALL_STRAIN = 0.05


def unit_state(problem: Equilibrium) -> tuple[State, float]:
    """State under 1 N in linear kinematics and the reaction (N) to it.

    The tangent at rest is factorised here; its two passes of refinement bring the residual to round-off.
    """
    system, rest = problem.system.plain, at_rest(problem)
    tangent = system.tangent(rest)
    problem.solver.factorise(tangent)
    y = problem.solver.solve(problem.unit_load[:, None])[:, 0]
    y = y + problem.solver.solve((problem.unit_load - system.linear_residual(rest, y))[:, None])[:, 0]
    force = system.linear_force(rest, y)
    return State(y, system.linear_pressure(rest, y), 1.0), reaction(system, force)


def strain_warning(strains: list[float]) -> tuple[str, ...]:
    """Warn of the first step whose largest strain passes 5 %."""
    beyond = np.flatnonzero(np.array(strains) > LARGEST_SMALL_STRAIN)
    if beyond.size == 0:
        return ()
    return (
        f"SMALL-STRAIN THEORY EXCEEDED: kinematics = 'linear', but the strain reaches {100 * max(strains):.3g} % "
        f"and passes {100 * LARGEST_SMALL_STRAIN:g} % from step {int(beyond[0]) + 1} of {len(strains)} on; these "
        "results are not a prediction of a large press, use kinematics = 'finite'",
    )
