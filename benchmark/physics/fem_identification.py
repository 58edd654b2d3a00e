"""Constants of the FEM's layers that give an effect the size that its equation says, identified by presses.

Stiffening: the effect multiplies the elastic force by a factor that grows with depth. The neo-Hookean law of every
layer is given one further term, with the same constants (relative to its shear modulus) in all layers, which leaves
the moduli at rest as they are: Yeoh's c20 and c30 (a factor that grows with depth squared), or an Ogden term whose
negative exponent stiffens in compression (a factor that grows with depth).

Relaxation: the effect lets the whole force fade, the layers' Prony series their shear alone. Its shares are made
larger by one factor, so that the force falls in a hold as far as the effect says.

Presses are on a coarse mesh: the ratio of two of them is what it is on a finer one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from benchmark.physics.effect import Array, NotInFemError

if TYPE_CHECKING:
    from fem import Layer, Material, Problem

Factor: TypeAlias = Callable[[Array], Array]
Control: TypeAlias = Literal["force", "depth"]
LOADS = 5
"""Load steps of a press, up to the peak."""
TRIES = 14
"""Most steps of an identification."""
CLOSE = 1e-3
"""Of the share of the force that fades: the identification ends here."""
MOST_SHARE = 0.98
"""Of the shear modulus that may fade."""
GOOD, ENOUGH = 0.003, 0.015
"""Largest misfit, relative, with which no second law is tried, and beyond which none is taken."""


@dataclass(frozen=True)
class StiffenedLaw:
    """The problem with the law that was identified, its name with its constants, and its largest relative misfit."""

    problem: Problem
    law: str
    misfit: float


@dataclass(frozen=True)
class _Family:
    """A law with two constants: its name, their starts and bounds, and the material of a layer."""

    name: str
    start: tuple[float, float]
    low: tuple[float, float]
    high: tuple[float, float]
    material: Callable[[float, float, float, float], Material]


def stiffened(problem: Problem, factor: Factor, control: Control, peak: float) -> StiffenedLaw:
    """Identify a stiffer law for all layers.

    Parameters
    ----------
    problem
        In finite strain, of neo-Hookean layers.
    factor
        (n,) depths in m to the factor (n,) on the force.
    control, peak
        The load up to which the press must stiffen so, N or m, above zero.

    Raises
    ------
    NotInFemError
        For other laws, or where no law stiffens the press so.
    """
    if problem.kinematics != "finite":
        raise NotInFemError("strain stiffening needs finite strain")
    coarse = _coarse(problem)
    loads = peak * np.arange(1, LOADS + 1) / LOADS
    wanted = _wanted(coarse, factor, control, loads)
    found: list[tuple[float, _Family, tuple[float, float]]] = []
    for family in (YEOH, OGDEN):
        constants, misfit = _identified(coarse, family, control, loads, wanted)
        found.append((misfit, family, constants))
        if misfit <= GOOD:
            break
    misfit, family, constants = min(found, key=lambda each: each[0])
    text = family.name.format(*constants)
    if misfit > ENOUGH:
        raise NotInFemError(
            f"no law of the layers stiffens the press as its equation says: the best, {text}, is "
            f"{100 * misfit:.2g} % off"
        )
    return StiffenedLaw(_with_law(problem, family, constants), text, misfit)


def relaxation_factor(problem: Problem, share: float, control: Control, peak: float) -> float:
    """Identify by how much the shares of the layers' relaxation are larger than the share of the force that fades.

    Parameters
    ----------
    problem
        Of elastic layers, neo-Hookean in finite strain.
    share
        Of the force that fades in all, above 0 and below 1.
    control, peak
        The load of the press, N or m, above zero.

    Raises
    ------
    NotInFemError
        For other laws, or where the layers' shear cannot let as much of the force fade.
    """
    coarse = _coarse(problem)
    depth = np.array([peak])
    if control == "force":
        depth = _pressed(coarse, control, peak * np.arange(1, LOADS + 1) / LOADS)[-1:]
    steps = depth * np.arange(1, LOADS + 1) / LOADS
    first = _pressed(coarse, "depth", steps)[-1]
    factor = 1.0
    for _ in range(TRIES):
        if factor * share >= MOST_SHARE:
            break
        fallen = 1.0 - _pressed(_relaxed(coarse, factor * share), "depth", steps)[-1] / first
        if np.isnan(fallen):
            break
        if abs(fallen - share) <= CLOSE * share:
            return factor
        factor *= share / float(fallen)
    raise NotInFemError(f"shear of the layers alone cannot let {100 * share:.3g} % of the force fade")


def _relaxed(problem: Problem, share: float) -> Problem:
    """The problem a long time after: the shear modulus smaller by a share, the bulk modulus as it was."""
    return replace(problem, layers=tuple(_relaxed_layer(layer, share) for layer in problem.layers))


def _relaxed_layer(layer: Layer, share: float) -> Layer:
    from fem import LinearElastic, NeoHookean

    law = layer.material
    if not isinstance(law, NeoHookean | LinearElastic):
        raise NotInFemError(
            f"the layer {layer.name} has the law {type(law).__name__}, whose relaxation is not identified"
        )
    nu = law.poisson_ratio
    shear, bulk = 0.5 * (1.0 - share) * law.youngs_modulus / (1.0 + nu), law.youngs_modulus / (3.0 * (1.0 - 2.0 * nu))
    later = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    return replace(layer, material=type(law)(2.0 * shear * (1.0 + later), later))


def _coarse(problem: Problem) -> Problem:
    return replace(problem, discretisation=replace(problem.discretisation, density="coarse"))


def _pressed(problem: Problem, control: Control, loads: Array) -> Array:
    """(n,) what the load leaves free, depth in m or force in N; NaN from where no equilibrium was found."""
    import fem

    free = np.full(loads.size, np.nan)
    try:
        solution = fem.prepare(problem).run(fem.Load(control, np.arange(1.0, loads.size + 1), loads))
    except fem.FemError:
        return free
    reached = solution.depth if control == "force" else solution.force
    free[: reached.size] = reached
    return free


def _wanted(problem: Problem, factor: Factor, control: Control, loads: Array) -> Array:
    """(n,) depth in m or force in N of the press with the factor."""
    from scipy.interpolate import PchipInterpolator

    plain = _pressed(problem, control, loads)
    if np.isnan(plain).any():
        raise NotInFemError("the press without it does not reach the peak load")
    depth, force = (plain, loads) if control == "force" else (loads, plain)
    curve = PchipInterpolator(np.append(0.0, depth), np.append(0.0, force))
    if control == "depth":
        return np.asarray(plain * factor(depth))
    fine = np.linspace(0.0, float(depth[-1]), 4001)
    return np.asarray(np.interp(loads, curve(fine) * factor(fine), fine))


def _identified(
    problem: Problem, family: _Family, control: Control, loads: Array, wanted: Array
) -> tuple[tuple[float, float], float]:
    """The two constants of a law, and the largest relative misfit with them."""
    from scipy.optimize import least_squares

    def apart(constants: Array) -> Array:
        free = _pressed(_with_law(problem, family, (constants[0], constants[1])), control, loads)
        return np.where(np.isnan(free), 1.0, free / wanted - 1.0)

    best = least_squares(
        apart, family.start, bounds=(family.low, family.high), diff_step=1e-2, xtol=1e-3, ftol=1e-4, max_nfev=TRIES
    )
    return (float(best.x[0]), float(best.x[1])), float(np.abs(best.fun).max())


def _with_law(problem: Problem, family: _Family, constants: tuple[float, float]) -> Problem:
    return replace(problem, layers=tuple(_with_term(layer, family, constants) for layer in problem.layers))


def _with_term(layer: Layer, family: _Family, constants: tuple[float, float]) -> Layer:
    from fem import NeoHookean

    law = layer.material
    if not isinstance(law, NeoHookean):
        name = type(law).__name__
        raise NotInFemError(f"the layer {layer.name} has a law of its own, {name}, which stiffens by itself")
    shear = law.youngs_modulus / (2.0 * (1.0 + law.poisson_ratio))
    return replace(layer, material=family.material(shear, law.poisson_ratio, *constants))


def _yeoh(shear: float, nu: float, second: float, third: float) -> Material:
    from fem import Yeoh

    return Yeoh(0.5 * shear, 0.5 * shear * second, 0.5 * shear * third, nu)


def _ogden(shear: float, nu: float, share: float, exponent: float) -> Material:
    from fem import Ogden

    return Ogden(((shear * (1.0 - share), 2.0), (2.0 * shear * share / exponent, exponent)), nu)


YEOH = _Family("Yeoh, c20 = {0:.4g} c10, c30 = {1:.4g} c10", (0.5, 0.2), (0.0, 0.0), (1e3, 1e4), _yeoh)
OGDEN = _Family(
    "Ogden, {0:.4g} of the shear modulus with exponent {1:.4g}", (0.9, -4.0), (0.0, -40.0), (1.0, -1.0), _ogden
)
