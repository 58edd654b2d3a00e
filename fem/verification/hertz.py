"""A rigid sphere pressed lightly on a half-space by real contact, against Hertz.

F = 4/3 E / (1 - nu^2) sqrt(R) w^(3/2) without friction (Johnson, Contact Mechanics, 1985, chapter 4), for contact radii
sqrt(R w) much smaller than R.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Literal

import numpy as np

from fem.load import Load
from fem.materials import NeoHookean
from fem.problem.parts import Discretisation, Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.case import Case, Quantity
from fem.verification.half_space import Geometry

RADIUS, YOUNGS_MODULUS = 0.01, 2e4
INDENTATIONS = (1e-3, 4e-3)  # over the radius
POISSON_RATIOS = (0.45, 0.499)
ALLOWED_PERCENT = 1.0
SOURCE = "Hertz; Johnson, Contact Mechanics (1985), chapter 4, closed form"


def cases() -> tuple[Case, ...]:
    """A light and a firmer press at two Poisson's ratios."""
    return tuple(Case(f"hertz/nu_{nu:g}", SOURCE, partial(sphere, nu)) for nu in POISSON_RATIOS)


def sphere(
    poisson_ratio: float,
    indentations: tuple[float, ...] = INDENTATIONS,
    geometry: Geometry = "axisymmetric",
    density: Literal["coarse", "fine"] = "fine",
) -> tuple[Quantity, ...]:
    """Force at each indentation, over the radius."""
    layer = Layer("half-space", math.inf, 1000.0, NeoHookean(YOUNGS_MODULUS, poisson_ratio))
    tool = Tool(RADIUS, "rigid_frictionless", RADIUS)
    problem = Problem((layer,), tool, Support("half_space"), "finite", Discretisation(density), geometry)
    model = prepare(problem)
    depths = [share * RADIUS for share in indentations]
    solution = model.run(Load("depth", np.arange(1.0, len(depths) + 1.0), np.array(depths)))
    modulus = YOUNGS_MODULUS / (1.0 - poisson_ratio**2)
    exact = [4.0 / 3.0 * modulus * math.sqrt(RADIUS) * depth**1.5 for depth in depths]
    return tuple(
        Quantity(f"indentation_{share:g}", 1e3 * reference, 1e3 * force, "mN", ALLOWED_PERCENT, model.unknowns)
        for share, reference, force in zip(indentations, exact, solution.force.tolist(), strict=True)
    )
