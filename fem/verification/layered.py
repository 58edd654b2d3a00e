"""Bonded layers of very different stiffness on a half-space and on a rigid base, against layered elasticity.

The reference is :mod:`fem.verification.layered_elasticity`, which shares nothing with the elements.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType

import numpy as np

from fem.load import Load
from fem.materials import LinearElastic
from fem.problem.parts import Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.case import Case, Quantity
from fem.verification.layered_elasticity import ElasticStack, axis_deflection

RADIUS, PRESSURE = 5e-3, 1e3
ALLOWED_PERCENT = 0.3
SOURCE = "Hankel-transform solution of layered elasticity (own, semi-analytic)"


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
    """One for each stack."""
    return tuple(Case(f"layered/{name}", SOURCE, partial(interfaces, name)) for name in STACKS)


def interfaces(name: str) -> tuple[Quantity, ...]:
    """Deflection on the axis at the surface and at each interface of a stack."""
    stack = STACKS[name]
    layers = tuple(
        Layer(f"layer {n}", thickness, 1000.0, LinearElastic(modulus, nu))
        for n, (thickness, modulus, nu) in enumerate(
            zip(stack.thickness.tolist(), stack.youngs_modulus.tolist(), stack.poisson_ratio.tolist(), strict=True)
        )
    )
    support = Support("half_space" if np.isinf(stack.thickness[-1]) else "bonded")
    model = prepare(Problem(layers, Tool(RADIUS, "uniform_pressure"), support, "linear"))
    solution = model.run(Load("force", np.ones(1), np.array([PRESSURE * np.pi * RADIUS**2])))
    exact = axis_deflection(stack, RADIUS, PRESSURE)
    return tuple(
        Quantity(f"interface_{n}", 1e3 * reference, 1e3 * ours, "mm", ALLOWED_PERCENT, model.unknowns)
        for n, (reference, ours) in enumerate(zip(exact.tolist(), solution.top_deflection[0].tolist(), strict=True))
    )
