"""Layers of very different stiffness on a half-space and on a rigid base, against layered elasticity.

Bonded, or sliding on each other without friction, in small and in finite strain. In finite strain the press is so small
that its answer is that of small strain; there the slip of the nodes along the other side is an unknown. The reference
is :mod:`fem.verification.layered_elasticity`, which shares nothing with the elements.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import Literal, TypeAlias

import numpy as np

from fem.load import Load
from fem.materials import LinearElastic, NeoHookean
from fem.problem.parts import Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.case import Case, Quantity
from fem.verification.layered_elasticity import ElasticStack, axis_deflection

RADIUS, PRESSURE = 5e-3, 1e3
ALLOWED_PERCENT = 0.3
SOURCE = "Hankel-transform solution of layered elasticity (own, semi-analytic)"


SMALL = 1e-3  # part of the pressure in finite strain
_Slipping: TypeAlias = tuple[str, str, tuple[float, ...], Literal["linear", "finite"]]
SLIPPING: tuple[_Slipping, ...] = (
    ("skin_bonded", "skin_bonded", (0.0, 0.0), "linear"),
    ("skin_bonded", "skin_bonded", (0.0, 0.0), "finite"),
    ("one_interface", "skin_bonded", (math.inf, 0.0), "finite"),
    ("stiff_on_soft", "stiff_on_soft", (0.0,) * 3, "linear"),
)


def _stack(thickness_mm: tuple[float, ...], modulus_kpa: tuple[float, ...], nu: tuple[float, ...]) -> ElasticStack:
    return ElasticStack(1e-3 * np.array(thickness_mm), 1e3 * np.array(modulus_kpa), np.array(nu))


STACKS: Mapping[str, ElasticStack] = MappingProxyType(
    {
        "stiff_on_soft": _stack((1.0, 2.0, 5.0, np.inf), (1e4, 1e2, 1e3, 20.0), (0.4, 0.49, 0.3, 0.48)),
        "soft_on_stiff": _stack((2.0, 1.0, 5.0, np.inf), (20.0, 1e3, 1e2, 1e4), (0.49, 0.3, 0.45, 0.35)),
        "skin": _stack((0.1, 1.5, 10.0, np.inf), (1e3, 1e2, 20.0, 5e2), (0.48, 0.48, 0.48, 0.48)),
        "skin_bonded": _stack((0.1, 1.5, 10.0), (1e3, 1e2, 20.0), (0.48, 0.48, 0.48)),
    }
)


def cases() -> tuple[Case, ...]:
    """One for each bonded stack."""
    return tuple(Case(f"layered/{name}", SOURCE, partial(interfaces, name)) for name in STACKS)


def slipping_cases() -> tuple[Case, ...]:
    """Skin on a base with one or both interfaces sliding, and layers on a half-space."""
    return tuple(
        Case(f"slipping/{word}_{kinematics}", SOURCE, partial(interfaces, stack, limits, kinematics))
        for word, stack, limits, kinematics in SLIPPING
    )


def interfaces(
    name: str, limits: tuple[float, ...] | None = None, kinematics: Literal["linear", "finite"] = "linear"
) -> tuple[Quantity, ...]:
    """Deflection on the axis at the surface and at each interface of a stack, bonded or with shear limits in Pa."""
    stack, unit, scale = STACKS[name], "mm", 1e3
    if limits is not None:
        stack, unit, scale = replace(stack, slipping=np.array(limits) == 0.0), "um", 1e6
    law = LinearElastic if kinematics == "linear" else NeoHookean
    moduli = zip(stack.thickness.tolist(), stack.youngs_modulus.tolist(), stack.poisson_ratio.tolist(), strict=True)
    layers = tuple(Layer(f"layer {n}", part[0], 1000.0, law(*part[1:])) for n, part in enumerate(moduli))
    support = Support("half_space" if np.isinf(stack.thickness[-1]) else "bonded")
    tool, pressure = Tool(RADIUS, "uniform_pressure"), PRESSURE * (1.0 if kinematics == "linear" else SMALL)
    model = prepare(Problem(layers, tool, support, kinematics, interface_shear_limit=limits))
    solution = model.run(Load("force", np.ones(1), np.array([pressure * np.pi * RADIUS**2])))
    exact = axis_deflection(stack, RADIUS, pressure)
    return tuple(
        Quantity(f"interface_{n}", scale * reference, scale * ours, unit, ALLOWED_PERCENT, model.unknowns)
        for n, (reference, ours) in enumerate(zip(exact.tolist(), solution.top_deflection[0].tolist(), strict=True))
    )
