"""What a parameter is, two problems beside the one as told, and what a run has by it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from fem.arrays import FloatArray
from fem.errors import FemError
from fem.problem.problem import Problem
from fem.results.solution import Solution


@dataclass(frozen=True)
class ProblemChange:
    """One parameter a little smaller and a little larger.

    Attributes
    ----------
    less, more
        The problem with the parameter on either side of its value; one of them may be the problem itself.
    below, above
        How far the parameter is from its value there, not negative, in its own unit; together above 0.

    Raises
    ------
    FemError
        If they are not so.
    """

    less: Problem
    more: Problem
    below: float
    above: float

    def __post_init__(self) -> None:
        if not (min(self.below, self.above) >= 0.0 and 0.0 < self.width < math.inf):
            raise FemError(
                f"below = {self.below:g}, above = {self.above:g}: must be finite, 0 or more, and together above 0"
            )

    @property
    def width(self) -> float:
        """Difference of the parameter between the two."""
        return self.below + self.above


@dataclass(frozen=True)
class SecondDerivative:
    """Second derivatives of a solution with n steps and N nodes by one parameter.

    Attributes
    ----------
    force, depth
        (n,) in N and m.
    displacement
        Of the nodes, (n, N, components) in m, with the nodes moving.
    """

    force: FloatArray
    depth: FloatArray
    displacement: FloatArray


@dataclass(frozen=True)
class SolutionDerivative:
    """Derivatives of a solution with n steps and N nodes by one parameter, by whose unit all units are divided.

    Attributes
    ----------
    force
        Of the press, (n,) in N; zero where it is prescribed.
    depth
        (n,) in m; zero where it is prescribed.
    displacement
        Of the nodes, (n, N, components) in m, with the nodes moving.
    velocity
        Of the nodes' places at rest, (N, components) in m.
    second
        Second derivatives, where asked for.
    """

    force: FloatArray
    depth: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    second: SecondDerivative | None = None


@dataclass(frozen=True)
class DifferentiatedSolution:
    """A solution, and its derivatives by the name of each parameter."""

    solution: Solution
    by: Mapping[str, SolutionDerivative]
