"""The three-dimensional block: the half-space, and skin against the axisymmetric solver, tied and touched."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from fem.analysis.prepared import Model
from fem.load import Load
from fem.materials import LinearElastic, NeoHookean
from fem.problem.parts import TOUCHING, Discretisation, Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification import indentation
from fem.verification.case import Case, Quantity
from fem.verification.indentation import Geometry
from fem.verification.press import CONTACTS, LAYERS, POISSON_RATIO, RADIUS

ALLOWED_PERCENT = 0.5
FORCE = 0.1
AXISYMMETRIC = "own axisymmetric solver (0.1 N, small strain)"
PUNCH_FORCE, EDGE_RADIUS, FRICTION, SPHERE_INDENTATION = 0.5, 1e-3, 0.3, 4e-3
FINE_SOURCE = "own axisymmetric solver, fine mesh (0.5 N, large strain, real contact)"


def cases() -> tuple[Case, ...]:
    """Half-space under a disc and under a punch; skin under each contact."""
    discs = [_half_space("disc", indentation.disc, nu) for nu in (0.35, 0.499)]
    skins = [Case(f"block_axisymmetric/{contact}", AXISYMMETRIC, partial(skin, contact)) for contact in CONTACTS]
    punches = [Case(f"block_punch/{contact}", FINE_SOURCE, partial(punch, contact)) for contact in TOUCHING]
    return (*discs, _half_space("punch", indentation.punch, 0.499), *skins, *punches, _sphere(0.499))


def _sphere(nu: float) -> Case:
    return Case(
        f"block_hertz/nu_{nu:g}",
        indentation.HERTZ_SOURCE,
        partial(indentation.sphere, nu, (SPHERE_INDENTATION,), "block", "coarse"),
    )


def _half_space(name: str, compute: indentation.Compute, nu: float) -> Case:
    name = f"block_half_space_{name}/nu_{nu:g}"
    return Case(name, indentation.SOURCE, partial(compute, nu, "block", ALLOWED_PERCENT))


def skin(contact: str) -> tuple[Quantity, ...]:
    """Deflection of each layer's top face on the axis."""
    load = Load("force", np.ones(1), np.array([FORCE]))
    block, axial = _model(contact, "block"), _model(contact, "axisymmetric")
    ours, reference = (1e3 * model.run(load).top_deflection[0] for model in (block, axial))
    return tuple(
        Quantity(name, exact, found, "mm", ALLOWED_PERCENT, block.unknowns)
        for (name, _, _), exact, found in zip(LAYERS, reference.tolist(), ours.tolist(), strict=True)
    )


def _model(contact: str, geometry: Geometry) -> Model:
    layers = tuple(Layer(name, h, 1000.0, LinearElastic(modulus, POISSON_RATIO)) for name, h, modulus in LAYERS)
    return prepare(Problem(layers, Tool(RADIUS, contact), Support("bonded"), "linear", geometry=geometry))


def punch(contact: str) -> tuple[Quantity, ...]:
    """Deflection of each layer's top face on the axis under a punch with a rounded edge."""
    load = Load("force", np.ones(1), np.array([PUNCH_FORCE]))
    block, axial = _touched(contact, "block", "default"), _touched(contact, "axisymmetric", "fine")
    ours, reference = (1e3 * model.run(load).top_deflection[-1] for model in (block, axial))
    return tuple(
        Quantity(name, exact, found, "mm", ALLOWED_PERCENT, block.unknowns)
        for (name, _, _), exact, found in zip(LAYERS, reference.tolist(), ours.tolist(), strict=True)
    )


def _touched(contact: str, geometry: Geometry, density: Literal["default", "fine"]) -> Model:
    layers = tuple(Layer(name, h, 1000.0, NeoHookean(modulus, POISSON_RATIO)) for name, h, modulus in LAYERS)
    tool = Tool(RADIUS, contact, EDGE_RADIUS, friction_coefficient=FRICTION)
    problem = Problem(layers, tool, Support("bonded"), "finite", Discretisation(density), geometry)
    return prepare(problem)
