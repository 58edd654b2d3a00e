"""Finite-element solver of layered soft tissue.

Describe a :class:`Problem`, :func:`prepare` it once, run load histories on the model::

    import numpy as np, fem
    skin = fem.Layer("dermis", 1.5e-3, 1116.0, fem.NeoHookean(1e5, 0.48))
    fat = fem.Layer("fat", 10e-3, 971.0, fem.NeoHookean(2e4, 0.48), relaxation=(fem.PronyTerm(0.3, 0.5),))
    problem = fem.Problem((skin, fat), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded"), pretension=2e3)
    time = np.arange(1, 11) / 10
    solution = fem.prepare(problem).run(fem.Load("force", time, 2.0 * time))
    solution.depth                       # m, also force, reaction, top_deflection, profile(...), fields(...)

SI units; a press and its deflection are positive into the tissue. The package knows nothing of files,
reports or other models. Names are loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fem.errors import CheckpointError, FemError, NotDifferentiableError
    from fem.load import Load
    from fem.materials import (
        Fibre,
        FibreReinforced,
        Gent,
        LinearElastic,
        Material,
        MooneyRivlin,
        NeoHookean,
        Ogden,
        Yeoh,
    )
    from fem.materials.prony import PronyTerm
    from fem.mesh.surface.surface_file import read_surface
    from fem.problem.parts import Discretisation, Layer, Support, Tool
    from fem.problem.problem import Problem
    from fem.results.solution import Failure, Resumed, Solution, StepReport
    from fem.sensitivity.differentiate import differentiate
    from fem.sensitivity.problem_change import DifferentiatedSolution, ProblemChange, SolutionDerivative
    from fem.setup.mesh_error import MeshError, error_at_edge, estimate_mesh_error
    from fem.setup.prepare import prepare

__all__ = [
    "CheckpointError",
    "DifferentiatedSolution",
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
    "MeshError",
    "MooneyRivlin",
    "NeoHookean",
    "NotDifferentiableError",
    "Ogden",
    "Problem",
    "ProblemChange",
    "PronyTerm",
    "Resumed",
    "Solution",
    "SolutionDerivative",
    "StepReport",
    "Support",
    "Tool",
    "Yeoh",
    "differentiate",
    "error_at_edge",
    "estimate_mesh_error",
    "prepare",
    "read_surface",
]

_HOMES = {
    "errors": "CheckpointError FemError NotDifferentiableError",
    "load": "Load",
    "materials": "Fibre FibreReinforced Gent LinearElastic Material MooneyRivlin NeoHookean Ogden Yeoh",
    "materials.prony": "PronyTerm",
    "mesh.surface.surface_file": "read_surface",
    "problem.parts": "Discretisation Layer Support Tool",
    "problem.problem": "Problem",
    "results.solution": "Failure Resumed Solution StepReport",
    "sensitivity.differentiate": "differentiate",
    "sensitivity.problem_change": "DifferentiatedSolution ProblemChange SolutionDerivative",
    "setup.mesh_error": "MeshError error_at_edge estimate_mesh_error",
    "setup.prepare": "prepare",
}


def __getattr__(name: str) -> object:
    for home, names in _HOMES.items():
        if name in names.split():
            return globals().setdefault(name, getattr(import_module(f"fem.{home}"), name))
    raise AttributeError(f"module 'fem' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
