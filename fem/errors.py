"""Errors of the finite-element package: input that cannot be used.

A run that does not converge is not an error here; it is a :class:`fem.solution.Solution` with a
:class:`fem.solution.Failure`.
"""

from __future__ import annotations


class FemError(ValueError):
    """Input the solver cannot use; the message names the parameter, its value, its unit and what is allowed."""


class CheckpointError(FemError):
    """A checkpoint that cannot be written, is damaged, or belongs to another problem.

    Attributes
    ----------
    problem
        What is wrong; the message goes on with what to do.
    """

    def __init__(self, problem: str, remedy: str = ""):
        super().__init__(f"{problem}; {remedy}" if remedy else problem)
        self.problem = problem
