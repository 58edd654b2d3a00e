"""Rigid frictionless punch on a bonded layer (Hayes, Keer, Herrmann and Mockros, J. Biomech. 5 (1972) 541).

kappa = (1 - nu^2) F / (2 a E w) at nu = 0.45, recomputed to five digits from the paper's integral equation (the
printed table drifts by -0.6 % at the largest a / h).
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

KAPPA: Mapping[float, float] = MappingProxyType(
    {0.2: 1.2523, 0.4: 1.5993, 0.6: 2.0328, 0.8: 2.5354, 1.0: 3.0914, 1.5: 4.6576, 2.0: 6.4206}
)
RADIUS, YOUNGS_MODULUS, POISSON_RATIO, INDENTATION = 5e-3, 2e4, 0.45, 1e-5
ALLOWED_PERCENT = 0.1
SOURCE = "Hayes et al., J. Biomech. 5 (1972) 541, recomputed to five digits"


def cases() -> tuple[Case, ...]:
    """One for each ratio of tool radius to thickness."""
    return tuple(Case(f"hayes/ratio_{ratio:g}", SOURCE, partial(bonded_layer, ratio)) for ratio in KAPPA)


def kappa(force: float) -> float:
    """Dimensionless stiffness of a force in N at the indentation of this case."""
    return (1.0 - POISSON_RATIO**2) * force / (2.0 * RADIUS * YOUNGS_MODULUS * INDENTATION)


def bonded_layer(ratio: float) -> tuple[Quantity, ...]:
    """Stiffness of a layer of thickness a / ratio."""
    layer = Layer("cartilage", RADIUS / ratio, 1100.0, LinearElastic(YOUNGS_MODULUS, POISSON_RATIO))
    model = prepare(Problem((layer,), Tool(RADIUS, "rigid_frictionless"), Support("bonded"), "linear"))
    force = float(model.run(Load("depth", np.ones(1), np.array([INDENTATION]))).force[0])
    return (Quantity("", KAPPA[ratio], kappa(force), "", ALLOWED_PERCENT, model.unknowns),)
