"""A thin sheet under tension over a hole, pressed by a rigid disc: a clamped plate with tension.

With the bending stiffness D = E h^3 / (12 (1 - nu^2)), the tension T = S h and k^2 = T / D, the deflection of the plate
from the disc's rim r = a, where it has no slope, to the clamp r = R is

    w = A + B ln(r / R) + C I_0(k r) + G K_0(k r),    F = -2 pi T B

(S. Timoshenko and S. Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed., 1959, chapter 12). Without bending it is
the membrane's F = 2 pi T w / ln(R / a). Presses are so small that large strain has the same answer.
"""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np
from scipy.special import ive, kve

from fem.load import Load
from fem.materials import LinearElastic, NeoHookean
from fem.problem.parts import Discretisation, Layer, Support, Tool
from fem.problem.problem import Problem
from fem.setup.prepare import prepare
from fem.verification.case import Case, Quantity

YOUNGS_MODULUS, POISSON_RATIO = 1e6, 0.3
HOLE, RADIUS = 20e-3, 5e-3
THICKNESS, BLOCK_THICKNESS = 25e-6, 1e-4
TENSIONS = (1e3, 2e4)  # Pa: where bending counts, and almost a membrane
INDENTATION = 1e-3  # over the thickness
BORDER = 1.0001  # radius of the mesh over that of the hole, so that the whole edge is held
ALLOWED_PERCENT = {"axisymmetric": 0.2, "block": 0.5}
SOURCE = "Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells (1959), chapter 12, closed form"


def cases() -> tuple[Case, ...]:
    """A low and a high tension in small and in large strain, and one on a block."""
    kinds: tuple[Literal["linear", "finite"], ...] = ("linear", "finite")
    axial = [
        Case(f"pretension_sheet/{kinematics}/{tension:g}Pa", SOURCE, partial(sheet, tension, kinematics))
        for kinematics in kinds
        for tension in TENSIONS
    ]
    return (*axial, Case("pretension_sheet/block", SOURCE, partial(sheet, TENSIONS[1], "linear", "block")))


def closed_form(tension: float, thickness: float) -> float:
    """Force over depth in N/m of a tensile stress in Pa and a thickness in m."""
    stiffness = YOUNGS_MODULUS * thickness**3 / (12.0 * (1.0 - POISSON_RATIO**2))
    pull = tension * thickness
    k = np.sqrt(pull / stiffness)
    rows = []
    for r in (RADIUS, HOLE):
        growing, falling = np.exp(k * (r - HOLE)), np.exp(k * (RADIUS - r))  # scales that keep the columns near 1
        rows += [
            [1.0, np.log(r / HOLE), growing * ive(0, k * r), falling * kve(0, k * r)],
            [0.0, 1.0 / r, k * growing * ive(1, k * r), -k * falling * kve(1, k * r)],
        ]
    logarithm = np.linalg.solve(np.array(rows), np.array([1.0, 0.0, 0.0, 0.0]))[1]
    return float(-2.0 * np.pi * pull * logarithm)


def sheet(
    tension: float, kinematics: Literal["linear", "finite"], geometry: Literal["axisymmetric", "block"] = "axisymmetric"
) -> tuple[Quantity, ...]:
    """Force over depth under a disc that is stuck to the sheet."""
    block = geometry == "block"
    thickness = BLOCK_THICKNESS if block else THICKNESS
    law = LinearElastic if kinematics == "linear" else NeoHookean
    problem = Problem(
        (Layer("sheet", thickness, 1000.0, law(YOUNGS_MODULUS, POISSON_RATIO)),),
        Tool(RADIUS, "rigid_bonded"),
        Support("hole", HOLE),
        kinematics,
        Discretisation("coarse" if block else "default", BORDER * HOLE),
        geometry,
        pretension=tension,
    )
    model, depth = prepare(problem), INDENTATION * thickness
    force = float(model.run(Load("depth", np.ones(1), np.array([depth]))).force[0])
    exact = closed_form(tension, thickness)
    return (Quantity("", exact, force / depth, "N/m", ALLOWED_PERCENT[geometry], model.unknowns),)
