"""A confined cylinder that relaxes: strained along its axis only, where the answer is known in closed form.

With M(t) = K + 4/3 G0 (1 - sum g (1 - exp(-t / tau))) the axial stress of a ramp to the strain e in t0 and a hold is

    sigma(t >= t0) = K e + 4/3 G0 e (1 - sum g + sum g tau / t0 exp(-t / tau) (exp(t0 / tau) - 1))

and a sudden stress s creeps, with one term, to e(t) = s / M(0) (1 + m / (1 - m) (1 - exp(-(1 - m) t / tau))),
m = 4/3 G0 g / M(0) (R. M. Christensen, Theory of Viscoelasticity, 2nd ed., 1982, chapter 1). After a sudden finite
stretch the isochoric stress relaxes with the series. Relaxation is exact in any steps; creep follows no straight lines,
so it is extrapolated from three step sizes (the error is of second order in the step).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fem.analysis.equilibrium import Equilibrium
from fem.analysis.linear import RelaxingBody
from fem.analysis.newton import NewtonSettings
from fem.analysis.stepping import Stepper
from fem.materials import LinearElastic, Material, NeoHookean
from fem.materials.prony import PronyTerm
from fem.verification.body import Body, distorted_square
from fem.verification.case import Case, Quantity

YOUNGS_MODULUS, POISSON_RATIO = 2e4, 0.45
TERMS, ONE_TERM = (PronyTerm(0.3, 0.5), PronyTerm(0.25, 7.0)), (PronyTerm(0.6, 2.0),)
RAMP, HOLDS, STRAIN = 2.0, (2.0, 2.5, 6.0, 30.0), 1e-3
CREEP_TIME, CREEP_STEPS, STRESS = 3.0, (30, 60, 120), 10.0
STRETCH, TIMES = 0.8, (0.0, 0.7, 5.0)
ALLOWED_PERCENT = 1e-6
SOURCE = "Christensen, Theory of Viscoelasticity (1982), chapter 1, closed form"
COUNT, SEED = 2, 7


def cases() -> tuple[Case, ...]:
    """Ramp and hold, creep, and a sudden finite stretch nearly incompressible too."""
    sudden = [Case(f"prony_sudden_stretch/nu_{nu:g}", SOURCE, partial(sudden_stretch, nu)) for nu in (0.45, 0.4999)]
    return (Case("prony_ramp_hold", SOURCE, ramp_hold), Case("prony_creep", SOURCE, creep), *sudden)


def ramp_hold() -> tuple[Quantity, ...]:
    """Axial stress of a strain that is brought up and held, in steps of many lengths."""
    material = LinearElastic(YOUNGS_MODULUS, POISSON_RATIO)
    problem = _confined(material, TERMS)
    body, before, found = RelaxingBody(problem), 0.0, []
    for time in (0.3, 1.1, *HOLDS):
        state, _ = body.step(time - before, "depth", STRAIN * min(time, RAMP) / RAMP)
        before = time
        found.append(state.force / np.pi)
    count = problem.system.numbering.count
    return tuple(
        Quantity(f"stress_{time:g}s", _ramp_stress(material, time), ours, "Pa", ALLOWED_PERCENT, count)
        for time, ours in zip(HOLDS, found[2:], strict=True)
    )


def _ramp_stress(material: LinearElastic, time: float) -> float:
    left = 1.0 - sum(term.g for term in TERMS)
    for term in TERMS:
        left += term.g * term.tau / RAMP * np.exp(-time / term.tau) * np.expm1(RAMP / term.tau)
    return STRAIN * (material.bulk_modulus + 4.0 / 3.0 * material.shear_modulus * left)


def creep() -> tuple[Quantity, ...]:
    """Axial strain under a sudden stress that stays."""
    material, (term,) = LinearElastic(YOUNGS_MODULUS, POISSON_RATIO), ONE_TERM
    problem = _confined(material, ONE_TERM)
    coarse, middle, fine = (_crept(problem, steps) for steps in CREEP_STEPS)
    first, second = (4.0 * middle - coarse) / 3.0, (4.0 * fine - middle) / 3.0
    ours = (16.0 * second - first) / 15.0
    stiffness = material.bulk_modulus + 4.0 / 3.0 * material.shear_modulus
    m = 4.0 / 3.0 * material.shear_modulus * term.g / stiffness
    strain = STRESS / stiffness * (1.0 - m / (1.0 - m) * np.expm1(-(1.0 - m) * CREEP_TIME / term.tau))
    return (Quantity("", 1e3 * float(strain), 1e3 * ours, "mm/m", ALLOWED_PERCENT, problem.system.numbering.count),)


def _crept(problem: Equilibrium, steps: int) -> float:
    body = RelaxingBody(problem)
    state, _ = body.step(0.0, "force", STRESS * np.pi)
    for _ in range(steps):
        state, _ = body.step(CREEP_TIME / steps, "force", STRESS * np.pi)
    return problem.depth(state.y)


def sudden_stretch(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Axial nominal stress at times after a sudden confined stretch of a neo-Hookean body."""
    material = NeoHookean(YOUNGS_MODULUS, poisson_ratio)
    problem = _confined(material, TERMS)
    stepper = Stepper(problem, "depth", 1e-3 * YOUNGS_MODULUS, NewtonSettings())
    found = [-stepper.advance(1.0 - STRETCH, time).state.force / np.pi for time in TIMES]
    mu, invariant = material.shear_modulus, 2.0 + STRETCH**2
    isochoric = mu * STRETCH ** (-2.0 / 3.0) * (STRETCH - invariant / (3.0 * STRETCH))
    volumetric = material.bulk_modulus * (STRETCH - 1.0)
    count = problem.system.numbering.count
    return tuple(
        Quantity(f"stress_{time:g}s", volumetric + _left(time) * isochoric, ours, "Pa", ALLOWED_PERCENT, count)
        for time, ours in zip(TIMES, found, strict=True)
    )


def _left(time: float) -> float:
    return 1.0 + sum(term.g * float(np.expm1(-time / term.tau)) for term in TERMS)


def _confined(material: Material, relaxation: tuple[PronyTerm, ...]) -> Equilibrium:
    """Cylinder of radius and height 1 that cannot widen, pressed by 1 N on its top face, which moves as one."""
    mesh = distorted_square(COUNT, SEED)
    everywhere = mesh.top | ~mesh.top
    body = Body(mesh, material, np.stack((everywhere, mesh.base)), mesh.top, 1.0, relaxation)
    probe = int(body.numbering.unknown[1, mesh.interfaces[0][0]])
    load = np.zeros(body.numbering.count)
    load[probe] = -1.0
    return body.equilibrium(load, probe)
