"""Layers that slide on each other without friction, against layered elasticity; in small and in finite strain.

The reference is :mod:`fem.verification.layered_elasticity`. In finite strain the press is so small that its answer is
that of small strain; there the slip of the nodes along the other side is an unknown.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np

from fem.load import Load
from fem.materials import LinearElastic, NeoHookean
from fem.problem.parts import Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.case import Case, Quantity
from fem.verification.layered import PRESSURE, RADIUS, SOURCE, STACKS
from fem.verification.layered_elasticity import axis_deflection

ALLOWED_PERCENT = 0.3
SMALL = 1e-3  # part of the pressure in finite strain


def cases() -> tuple[Case, ...]:
    """Skin on a base with one or both interfaces sliding, and layers on a half-space."""
    return (
        Case("slipping/skin_bonded_linear", SOURCE, partial(interfaces, "skin_bonded", (0.0, 0.0), "linear")),
        Case("slipping/skin_bonded_finite", SOURCE, partial(interfaces, "skin_bonded", (0.0, 0.0), "finite")),
        Case("slipping/one_interface_finite", SOURCE, partial(interfaces, "skin_bonded", (math.inf, 0.0), "finite")),
        Case("slipping/stiff_on_soft_linear", SOURCE, partial(interfaces, "stiff_on_soft", (0.0,) * 3, "linear")),
    )


def interfaces(name: str, limits: tuple[float, ...], kinematics: Literal["linear", "finite"]) -> tuple[Quantity, ...]:
    """Deflection on the axis at the surface and at each interface of a stack."""
    stack = replace(STACKS[name], slipping=np.array(limits) == 0.0)
    law = LinearElastic if kinematics == "linear" else NeoHookean
    moduli = zip(stack.thickness.tolist(), stack.youngs_modulus.tolist(), stack.poisson_ratio.tolist(), strict=True)
    layers = tuple(Layer(f"layer {n}", part[0], 1000.0, law(*part[1:])) for n, part in enumerate(moduli))
    support = Support("half_space" if np.isinf(stack.thickness[-1]) else "bonded")
    tool, pressure = Tool(RADIUS, "uniform_pressure"), PRESSURE * (1.0 if kinematics == "linear" else SMALL)
    model = prepare(Problem(layers, tool, support, kinematics, interface_shear_limit=limits))
    solution = model.run(Load("force", np.ones(1), np.array([pressure * np.pi * RADIUS**2])))
    exact = axis_deflection(stack, RADIUS, pressure)
    return tuple(
        Quantity(f"interface_{n}", 1e6 * reference, 1e6 * ours, "um", ALLOWED_PERCENT, model.unknowns)
        for n, (reference, ours) in enumerate(zip(exact.tolist(), solution.top_deflection[0].tolist(), strict=True))
    )
