"""Presses of blind specimens, each by the solver of its family.

The first family is pressed by the package `fem` with a Mooney-Rivlin law, the second by `taylor_hood` with Gent's law
(sheets) or Yeoh's (skin).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from scipy.interpolate import CubicSpline

import fem
from benchmark.blind.body import taylor_hood
from benchmark.blind.body.specimens import HOLE_RADIUS, ToldLayer, ToldSpecimen
from benchmark.blind.motion import Array

Density = Literal["coarse", "default", "fine"]
DEEPEST = 5e-3
RADIUS_FACTORS = (0.9, 1.0, 1.1)
STEPS = 25
SHEET_MESH: Density = "fine"
SKIN_MESH: Density = "default"
SECOND_SHARE = 0.2
"""Share of the shear modulus in the second Mooney-Rivlin constant, which no session tells of."""
RIM = 1.0 + 1e-4
"""Width of a sheet that is held at its border, in radii of the hole."""
COARSE_STEPS = 12
CHAINS = 3.0
"""Gent's limit of the second family's sheets: at 3.5 mm 0.1 to 0.2 % in force and 0.4 % in field from neo-Hooke's."""
YEOH_SECOND, YEOH_THIRD = 0.02, 0.0005
"""Yeoh's further constants of the second family's skin, in shares of the first."""
ALL_THICKNESSES = "all.thickness"
CHANGE = 0.05
"""Relative change of a set-up parameter by which its influence is computed."""


@dataclass(frozen=True, eq=False)
class PressTable:
    """Presses with three tool radii by the FEM.

    Attributes
    ----------
    depth : (k,) m
        From 0.
    force : (3, k) N
        A row for each of `RADIUS_FACTORS`.
    radius : (m,) m
        On the lower face, from the axis.
    outward, sinking : (3, k, m) m
        Displacement of the lower face away from the axis, and along the press; zeros without a free lower face.
    """

    depth: Array
    force: Array
    radius: Array
    outward: Array
    sinking: Array


@lru_cache(maxsize=32)
def press_table(
    specimen: ToldSpecimen, family: str = "first", clamp: str = "plate", deepest: float = DEEPEST
) -> PressTable:
    """Press the specimen with the told tool radius, and with one 10 % smaller and larger; some seconds.

    Parameters
    ----------
    specimen : ToldSpecimen
    family : str
        "first" or "second": which solver and law.
    clamp : str
        Over a hole: "plate" (lower face held outside it) or "rim" (held at its border only).
    deepest : float
        m.
    """
    presses = [_press(specimen, factor * specimen.tool_radius, family, clamp, deepest) for factor in RADIUS_FACTORS]
    return PressTable(
        depth=_depths(deepest),
        force=np.stack([press.force for press in presses]),
        radius=_face_radii(),
        outward=np.stack([press.outward for press in presses]),
        sinking=np.stack([press.sinking for press in presses]),
    )


@dataclass(frozen=True, eq=False)
class Press:
    """One press at `_depths`: force (k,) N, and the lower face at `_face_radii`, (k, m) m."""

    force: Array
    outward: Array
    sinking: Array


@lru_cache(maxsize=64)
def changed_press(specimen: ToldSpecimen, family: str, clamp: str, key: str, deepest: float = DEEPEST) -> Press:
    """The press with the told tool on a specimen of which one key is `CHANGE` larger.

    Parameters
    ----------
    key : str
        LAYER.thickness, LAYER.youngs_modulus, or `ALL_THICKNESSES`.
    deepest : float
        m.
    """
    layers = tuple(_changed(layer, key) for layer in specimen.layers)
    return _press(replace(specimen, layers=layers), specimen.tool_radius, family, clamp, deepest)


def _changed(layer: ToldLayer, key: str) -> ToldLayer:
    name, _, quantity = key.partition(".")
    if name not in (layer.name, ALL_THICKNESSES.partition(".")[0]):
        return layer
    return replace(layer, **{quantity: getattr(layer, quantity) * (1.0 + CHANGE)})


def _depths(deepest: float) -> Array:
    return np.linspace(0.0, deepest, STEPS + 1)


def _face_radii() -> Array:
    return np.linspace(0.0, 0.9 * HOLE_RADIUS, 28)


def _press(specimen: ToldSpecimen, radius: float, family: str, clamp: str, deepest: float) -> Press:
    """One press by the solver of the family."""
    by_family = _press_by_triangles if family == "second" else _press_by_fem
    return by_family(specimen, radius, clamp, deepest)


def _press_by_fem(specimen: ToldSpecimen, radius: float, clamp: str, deepest: float) -> Press:
    layers = tuple(fem.Layer(each.name, each.thickness, each.density, _silicone(each)) for each in specimen.layers)
    problem = fem.Problem(
        layers=layers,
        tool=fem.Tool(radius, "rigid_bonded"),
        support=fem.Support(specimen.support, HOLE_RADIUS if specimen.support == "hole" else None),
        kinematics="finite",
        discretisation=fem.Discretisation(
            SHEET_MESH if specimen.has_markers else SKIN_MESH,
            radius=RIM * HOLE_RADIUS if clamp == "rim" and specimen.support == "hole" else None,
        ),
    )
    solution = fem.prepare(problem).run(fem.Load("depth", np.arange(1.0, STEPS + 1), _depths(deepest)[1:]))
    if not solution.complete:
        raise fem.FemError(f"blind specimen {specimen.name}: {solution.failure}")
    empty = np.zeros((STEPS + 1, _face_radii().size))
    outward, sinking = _lower_face(solution, _face_radii()) if specimen.has_markers else (empty, empty)
    return Press(np.append(0.0, solution.force), outward, sinking)


def _press_by_triangles(specimen: ToldSpecimen, radius: float, clamp: str, deepest: float) -> Press:
    strata = tuple(_stratum(each, sheet=specimen.has_markers) for each in specimen.layers)
    hole = HOLE_RADIUS if specimen.support == "hole" else None
    press = taylor_hood.press(strata, radius, hole, clamp, np.linspace(0.0, deepest, COARSE_STEPS + 1)[1:])
    force = CubicSpline(press.depth, press.force)(_depths(deepest))
    if hole is None:
        empty = np.zeros((STEPS + 1, _face_radii().size))
        return Press(force, empty, empty)
    outward, sinking = (
        CubicSpline(press.depth, CubicSpline(press.radius, face, axis=1)(_face_radii()))(_depths(deepest))
        for face in (press.outward, press.sinking)
    )
    return Press(force, outward, sinking)


def _stratum(layer: ToldLayer, *, sheet: bool) -> taylor_hood.Stratum:
    """Gent's law for a sheet, Yeoh's for skin, where the session tells of the moduli alone."""
    shear = 0.5 * layer.youngs_modulus / (1.0 + layer.poisson_ratio)
    bulk = layer.youngs_modulus / (3.0 * (1.0 - 2.0 * layer.poisson_ratio))
    law = taylor_hood.gent(shear, CHAINS) if sheet else taylor_hood.yeoh(shear, YEOH_SECOND, YEOH_THIRD)
    return taylor_hood.Stratum(layer.thickness, shear, bulk, law)


def _silicone(layer: ToldLayer) -> fem.Material:
    """A Mooney-Rivlin law of the layer's moduli, where the session tells of the moduli alone."""
    shear = 0.5 * layer.youngs_modulus / (1.0 + layer.poisson_ratio)
    return fem.MooneyRivlin(0.5 * (1.0 - SECOND_SHARE) * shear, 0.5 * SECOND_SHARE * shear, layer.poisson_ratio)


def _lower_face(press: fem.Solution, radius: Array) -> tuple[Array, Array]:
    """Outward motion and sinking (k, m) of the lower face at reference radii (m,)."""
    nodes = press.mesh.nodes
    face = np.flatnonzero(np.isclose(nodes[:, 1], nodes[:, 1].min()))
    face = face[np.argsort(nodes[face, 0])]
    moved = press.displacement[:, face, :]
    rest = np.zeros((1, radius.size))
    outward = CubicSpline(nodes[face, 0], moved[:, :, 0], axis=1)(radius)
    sinking = CubicSpline(nodes[face, 0], -moved[:, :, 1], axis=1)(radius)
    return np.concatenate([rest, outward]), np.concatenate([rest, sinking])
