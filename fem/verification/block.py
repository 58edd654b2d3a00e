"""The three-dimensional block: the half-space, and skin against the axisymmetric solver."""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.load import Load
from fem.materials import LinearElastic
from fem.model import Model
from fem.prepare import prepare
from fem.problem import Layer, Problem, Support, Tool
from fem.verification import half_space
from fem.verification.case import Case, Quantity
from fem.verification.half_space import Geometry
from fem.verification.press import CONTACTS, LAYERS, POISSON_RATIO, RADIUS

ALLOWED_PERCENT = 0.5
FORCE = 0.1
AXISYMMETRIC = "own axisymmetric solver (0.1 N, small strain)"


def cases() -> tuple[Case, ...]:
    """Half-space under a disc and under a punch; skin under each contact."""
    discs = [_half_space("disc", half_space.disc, nu) for nu in (0.35, 0.499)]
    skins = [Case(f"block_axisymmetric/{contact}", AXISYMMETRIC, partial(skin, contact)) for contact in CONTACTS]
    return (*discs, _half_space("punch", half_space.punch, 0.499), *skins)


def _half_space(name: str, compute: half_space.Compute, nu: float) -> Case:
    name = f"block_half_space_{name}/nu_{nu:g}"
    return Case(name, half_space.SOURCE, partial(compute, nu, "block", ALLOWED_PERCENT))


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
