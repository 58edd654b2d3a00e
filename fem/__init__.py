"""Finite-element solver of layered soft tissue.

Describe a :class:`Problem`, :func:`prepare` it once, run load histories on the model::

    model = fem.prepare(problem)
    solution = model.run(fem.Load("force", time, force))

SI units; a press and its deflection are positive into the tissue. The package knows nothing of files,
reports or other models.
"""

from fem.errors import CheckpointError, FemError
from fem.load import Load
from fem.materials import Fibre, FibreReinforced, Gent, LinearElastic, Material, MooneyRivlin, NeoHookean, Ogden, Yeoh
from fem.materials.prony import PronyTerm
from fem.mesh.surface.surface_file import read_surface
from fem.problem.parts import Discretisation, Layer, Support, Tool
from fem.problem.problem import Problem
from fem.results.solution import Failure, Resumed, Solution, StepReport
from fem.setup.prepare import prepare

__all__ = [
    "CheckpointError",
    "Discretisation",
    "Failure",
    "FemError",
    "Fibre",
    "FibreReinforced",
    "Gent",
    "Layer",
    "LinearElastic",
    "Load",
    "Material",
    "MooneyRivlin",
    "NeoHookean",
    "Ogden",
    "Problem",
    "PronyTerm",
    "Resumed",
    "Solution",
    "StepReport",
    "Support",
    "Tool",
    "Yeoh",
    "prepare",
    "read_surface",
]
