"""The half-space: a disc of uniform pressure, and a flat frictionless punch.

On the axis under a disc of radius a with pressure q (Johnson, Contact Mechanics, chapter 3):
u_z = (1 + nu) q / E (2 (1 - nu) (s - z) + z (1 - z / s)), s = sqrt(a^2 + z^2).
Flat punch: F = 2 E a w / (1 - nu^2) (the same chapter).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Literal, TypeAlias

import numpy as np

from fem.analysis.model import Model
from fem.arrays import FloatArray
from fem.load import Load
from fem.materials import LinearElastic
from fem.problem.parts import Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.case import Case, Quantity

Geometry: TypeAlias = Literal["axisymmetric", "block"]
Compute: TypeAlias = Callable[[float, Geometry, float], tuple[Quantity, ...]]

YOUNGS_MODULUS, RADIUS, PRESSURE, INDENTATION = 200e6, 0.15, 1.1e6, 1e-3
DEPTHS = (0.0, 0.1, 0.15, 0.3, 1.0)
POISSON_RATIOS = (0.35, 0.49, 0.499)
ALLOWED_PERCENT = 0.1
SOURCE = "Johnson, Contact Mechanics (1985), chapter 3, closed form"


def cases() -> tuple[Case, ...]:
    """A disc load and a flat punch at each Poisson's ratio."""
    discs = [Case(f"half_space_disc/nu_{nu:g}", SOURCE, partial(disc, nu)) for nu in POISSON_RATIOS]
    punches = [Case(f"half_space_punch/nu_{nu:g}", SOURCE, partial(punch, nu)) for nu in POISSON_RATIOS]
    return (*discs, *punches)


def settlement(depth: FloatArray, poisson_ratio: float) -> FloatArray:
    """Closed-form deflection (n,) in m on the axis at depths (n,) in m under the disc of this case."""
    slant = np.sqrt(RADIUS**2 + depth**2)
    shape = 2.0 * (1.0 - poisson_ratio) * (slant - depth) + depth * (1.0 - depth / slant)
    out: FloatArray = (1.0 + poisson_ratio) * PRESSURE / YOUNGS_MODULUS * shape
    return out


def disc(
    poisson_ratio: float, geometry: Geometry = "axisymmetric", allowed: float = ALLOWED_PERCENT
) -> tuple[Quantity, ...]:
    """Deflection on the axis at all depths, each the top of a layer of the same material."""
    model = half_space("uniform_pressure", poisson_ratio, (*np.diff(DEPTHS).tolist(), np.inf), geometry)
    solution = model.run(Load("force", np.ones(1), np.array([PRESSURE * np.pi * RADIUS**2])))
    exact = settlement(np.array(DEPTHS), poisson_ratio)
    return tuple(
        Quantity(f"z_{1e3 * depth:g}mm", 1e3 * reference, 1e3 * ours, "mm", allowed, model.unknowns)
        for depth, reference, ours in zip(DEPTHS, exact.tolist(), solution.top_deflection[0].tolist(), strict=True)
    )


def punch(
    poisson_ratio: float, geometry: Geometry = "axisymmetric", allowed: float = ALLOWED_PERCENT
) -> tuple[Quantity, ...]:
    """Force of a punch pressed 1 mm deep."""
    model = half_space("rigid_frictionless", poisson_ratio, (np.inf,), geometry)
    force = float(model.run(Load("depth", np.ones(1), np.array([INDENTATION]))).force[0])
    exact = 2.0 * YOUNGS_MODULUS * RADIUS * INDENTATION / (1.0 - poisson_ratio**2)
    return (Quantity("", 1e-3 * exact, 1e-3 * force, "kN", allowed, model.unknowns),)


def half_space(
    contact: str, poisson_ratio: float, thickness: tuple[float, ...], geometry: Geometry = "axisymmetric"
) -> Model:
    """Model of layers of one material, the last endless, under a tool."""
    material = LinearElastic(YOUNGS_MODULUS, poisson_ratio)
    layers = tuple(Layer(f"layer {n}", t, 1800.0, material) for n, t in enumerate(thickness))
    return prepare(Problem(layers, Tool(RADIUS, contact), Support("half_space"), "linear", geometry=geometry))
