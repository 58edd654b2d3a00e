"""Discs, punches and a sphere on a half-space, and a punch on a bonded layer, in closed form.

- Disc of radius a with pressure q on a half-space, on the axis (Johnson, Contact Mechanics, chapter 3):
  u_z = (1 + nu) q / E (2 (1 - nu) (s - z) + z (1 - z / s)), s = sqrt(a^2 + z^2).
- Flat frictionless punch: F = 2 E a w / (1 - nu^2) (the same chapter).
- The same punch on a bonded layer (Hayes, Keer, Herrmann and Mockros, J. Biomech. 5 (1972) 541):
  kappa = (1 - nu^2) F / (2 a E w) at nu = 0.45, recomputed to five digits from the paper's integral equation (the
  printed table drifts by -0.6 % at the largest a / h).
- Rigid sphere pressed lightly, by real contact (Hertz; Johnson, chapter 4): F = 4/3 E / (1 - nu^2) sqrt(R) w^(3/2),
  for contact radii sqrt(R w) much smaller than R.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Literal, TypeAlias

import numpy as np

from fem.analysis.prepared import Model
from fem.arrays import FloatArray
from fem.load import Load
from fem.materials import LinearElastic, NeoHookean
from fem.problem.parts import Discretisation, Layer, Support, Tool
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
HAYES_KAPPA: Mapping[float, float] = MappingProxyType(
    {0.2: 1.2523, 0.4: 1.5993, 0.6: 2.0328, 0.8: 2.5354, 1.0: 3.0914, 1.5: 4.6576, 2.0: 6.4206}
)
HAYES_RADIUS, HAYES_YOUNGS_MODULUS, HAYES_POISSON_RATIO, HAYES_INDENTATION = 5e-3, 2e4, 0.45, 1e-5
HAYES_SOURCE = "Hayes et al., J. Biomech. 5 (1972) 541, recomputed to five digits"
HERTZ_RADIUS, HERTZ_YOUNGS_MODULUS = 0.01, 2e4
INDENTATIONS = (1e-3, 4e-3)  # over the radius
HERTZ_POISSON_RATIOS = (0.45, 0.499)
HERTZ_ALLOWED_PERCENT = 1.0
HERTZ_SOURCE = "Hertz; Johnson, Contact Mechanics (1985), chapter 4, closed form"


def half_space_cases() -> tuple[Case, ...]:
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


def hayes_cases() -> tuple[Case, ...]:
    """One for each ratio of tool radius to thickness."""
    return tuple(Case(f"hayes/ratio_{ratio:g}", HAYES_SOURCE, partial(bonded_layer, ratio)) for ratio in HAYES_KAPPA)


def hayes_kappa(force: float) -> float:
    """Dimensionless stiffness of a force in N at the indentation of this case."""
    return (1.0 - HAYES_POISSON_RATIO**2) * force / (2.0 * HAYES_RADIUS * HAYES_YOUNGS_MODULUS * HAYES_INDENTATION)


def bonded_layer(ratio: float) -> tuple[Quantity, ...]:
    """Stiffness of a layer of thickness a / ratio."""
    layer = Layer("cartilage", HAYES_RADIUS / ratio, 1100.0, LinearElastic(HAYES_YOUNGS_MODULUS, HAYES_POISSON_RATIO))
    model = prepare(Problem((layer,), Tool(HAYES_RADIUS, "rigid_frictionless"), Support("bonded"), "linear"))
    force = float(model.run(Load("depth", np.ones(1), np.array([HAYES_INDENTATION]))).force[0])
    return (Quantity("", HAYES_KAPPA[ratio], hayes_kappa(force), "", ALLOWED_PERCENT, model.unknowns),)


def hertz_cases() -> tuple[Case, ...]:
    """A light and a firmer press at two Poisson's ratios."""
    return tuple(Case(f"hertz/nu_{nu:g}", HERTZ_SOURCE, partial(sphere, nu)) for nu in HERTZ_POISSON_RATIOS)


def sphere(
    poisson_ratio: float,
    indentations: tuple[float, ...] = INDENTATIONS,
    geometry: Geometry = "axisymmetric",
    density: Literal["coarse", "fine"] = "fine",
) -> tuple[Quantity, ...]:
    """Force at each indentation, over the radius."""
    layer = Layer("half-space", math.inf, 1000.0, NeoHookean(HERTZ_YOUNGS_MODULUS, poisson_ratio))
    tool = Tool(HERTZ_RADIUS, "rigid_frictionless", HERTZ_RADIUS)
    problem = Problem((layer,), tool, Support("half_space"), "finite", Discretisation(density), geometry)
    model = prepare(problem)
    depths = [share * HERTZ_RADIUS for share in indentations]
    solution = model.run(Load("depth", np.arange(1.0, len(depths) + 1.0), np.array(depths)))
    modulus = HERTZ_YOUNGS_MODULUS / (1.0 - poisson_ratio**2)
    exact = [4.0 / 3.0 * modulus * math.sqrt(HERTZ_RADIUS) * depth**1.5 for depth in depths]
    return tuple(
        Quantity(f"indentation_{share:g}", 1e3 * reference, 1e3 * force, "mN", HERTZ_ALLOWED_PERCENT, model.unknowns)
        for share, reference, force in zip(indentations, exact, solution.force.tolist(), strict=True)
    )
