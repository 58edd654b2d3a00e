"""A press of skin at large strain: what must hold whatever the answer is.

Unloading must retrace loading (the law has a potential and no memory), the support must return the prescribed force,
and halving the elements must hardly change the depth.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.analysis.prepared import Model
from fem.arrays import FloatArray
from fem.load import Load
from fem.materials import NeoHookean
from fem.problem.parts import Discretisation, Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.body import worst
from fem.verification.case import Case, Quantity

CONTACTS = ("uniform_pressure", "rigid_bonded")
LAYERS = (("epidermis", 1e-4, 1e6), ("dermis", 1.5e-3, 1e5), ("fat", 1e-2, 2e4))
POISSON_RATIO, RADIUS, PEAK, STEPS = 0.48, 5e-3, 5.0, 10
RETRACE_PERCENT, REACTION_PERCENT, MESH_PERCENT = 1e-6, 1e-6, 0.5
ELASTIC = "an elastic body has no memory: loading path (5 N, large strain)"
EQUILIBRIUM = "equilibrium: prescribed force (5 N, large strain)"
FINER = "own mesh with half the element size (5 N, large strain)"


def cases() -> tuple[Case, ...]:
    """Retracing, reaction and mesh error for each contact."""
    kinds = (("retrace", ELASTIC, retrace), ("reaction", EQUILIBRIUM, reaction), ("mesh_halving", FINER, mesh_halving))
    return tuple(
        Case(f"{name}/{contact}", source, partial(function, contact))
        for name, source, function in kinds
        for contact in CONTACTS
    )


def retrace(contact: str) -> tuple[Quantity, ...]:
    """Depth on the way down at the load where it is farthest from the way up."""
    model = skin(contact)
    depth = _run(model, np.concatenate((_ramp(), _ramp()[-2::-1])))[0]
    up, down = depth[: STEPS - 1], depth[: STEPS - 1 : -1]
    step = int(np.argmax(np.abs(down / up - 1.0)))
    found = (1e3 * float(up[step]), 1e3 * float(down[step]))
    return (Quantity("", *found, "mm", RETRACE_PERCENT, model.unknowns),)


def reaction(contact: str) -> tuple[Quantity, ...]:
    """Force that the support returns, at the step where it is farthest from the tool's, relative to it."""
    model = skin(contact)
    returned = _run(model, _ramp())[1]
    return (Quantity("force_ratio", 1.0, worst(returned / _ramp(), 1.0), "", REACTION_PERCENT, model.unknowns),)


def mesh_halving(contact: str) -> tuple[Quantity, ...]:
    """Depth at the peak with the default mesh against the fine one."""
    model = skin(contact)
    fine = 1e3 * float(_run(skin(contact, Discretisation("fine")), _ramp())[0][-1])
    ours = 1e3 * float(_run(model, _ramp())[0][-1])
    return (Quantity("depth", fine, ours, "mm", MESH_PERCENT, model.unknowns),)


def skin(contact: str, discretisation: Discretisation | None = None) -> Model:
    """Three layers of skin on a rigid base."""
    layers = tuple(Layer(name, h, 1000.0, NeoHookean(modulus, POISSON_RATIO)) for name, h, modulus in LAYERS)
    problem = Problem(
        layers, Tool(RADIUS, contact), Support("bonded"), discretisation=discretisation or Discretisation()
    )
    return prepare(problem)


def _ramp() -> FloatArray:
    out: FloatArray = PEAK * np.arange(1, STEPS + 1) / STEPS
    return out


def _run(model: Model, force: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Depth in m and reaction in N, (n,) each.

    Raises
    ------
    ArithmeticError
        If the run did not reach its end.
    """
    solution = model.run(Load("force", np.arange(1.0, len(force) + 1.0), force))
    if solution.failure is not None:
        raise ArithmeticError(str(solution.failure))
    return solution.depth, solution.reaction
