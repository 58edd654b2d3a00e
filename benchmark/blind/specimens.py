"""The specimens that blind sessions press: what is told of them, the press by the FEM, and the true body."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline

import fem
from benchmark.blind.motion import Array

HOLE_RADIUS = 30e-3
DEEPEST = 5e-3
RADIUS_FACTORS = (0.9, 1.0, 1.1)
STEPS = 25
SECOND_SHARE = 0.2
"""Share of the shear modulus in the second Mooney-Rivlin constant, which no session tells of."""
REFERENCE_DEPTH = 2e-3
MODULUS_ERROR, THICKNESS_ERROR = 0.25, 0.04
"""Standard deviations of what a laboratory knows of a layer, as shares; the modulus by its logarithm."""


@dataclass(frozen=True)
class ToldLayer:
    """A layer: m, kg/m3, Pa."""

    name: str
    thickness: float
    density: float
    youngs_modulus: float
    poisson_ratio: float


@dataclass(frozen=True)
class ToldSpecimen:
    """What the session file says of specimen and tool.

    Attributes
    ----------
    name : str
    layers : tuple of ToldLayer
        From the surface down.
    support : str
        "hole" (of `HOLE_RADIUS`; its lower face carries markers) or "bonded" (no markers).
    tool_radius : float
        m.
    """

    name: str
    layers: tuple[ToldLayer, ...]
    support: str
    tool_radius: float

    @property
    def has_markers(self) -> bool:
        """Whether a camera sees its lower face."""
        return self.support == "hole"


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


def _sheet(name: str, thickness: float, youngs_modulus: float, tool_radius: float) -> ToldSpecimen:
    return ToldSpecimen(name, (ToldLayer("silicone", thickness, 1100.0, youngs_modulus, 0.49),), "hole", tool_radius)


def _skin(name: str, dermis: float, fat: float, tool_radius: float) -> ToldSpecimen:
    layers = (
        ToldLayer("epidermis", 0.1e-3, 1150.0, 1.5e6, 0.48),
        ToldLayer("dermis", 1.5e-3, 1116.0, dermis, 0.48),
        ToldLayer("fat", 10e-3, 971.0, fat, 0.48),
    )
    return ToldSpecimen(name, layers, "bonded", tool_radius)


SHEETS = (
    _sheet("sheet_soft", 4.0e-3, 180e3, 5.0e-3),
    _sheet("sheet_thick", 5.0e-3, 250e3, 6.0e-3),
    _sheet("sheet_thin", 3.5e-3, 400e3, 4.5e-3),
)
SKINS = (_skin("skin_stiff", 0.8e6, 50e3, 5.0e-3), _skin("skin_soft", 0.3e6, 25e3, 4.0e-3))


def misjudged(specimen: ToldSpecimen, rng: np.random.Generator) -> ToldSpecimen:
    """The specimen as a laboratory tells it: each layer's modulus and thickness off by the usual errors."""
    layers = tuple(
        replace(
            layer,
            youngs_modulus=layer.youngs_modulus * float(np.exp(MODULUS_ERROR * rng.normal())),
            thickness=layer.thickness * float(1.0 + THICKNESS_ERROR * rng.normal()),
        )
        for layer in specimen.layers
    )
    return replace(specimen, layers=layers)


@lru_cache(maxsize=8)
def press_table(specimen: ToldSpecimen) -> PressTable:
    """Press the specimen with the told tool radius, and with one 10 % smaller and larger; some seconds."""
    presses = [_press(specimen, factor * specimen.tool_radius) for factor in RADIUS_FACTORS]
    depth, radius = _depths(), np.linspace(0.0, 0.9 * HOLE_RADIUS, 28)
    faces = [_lower_face(press, radius) for press in presses] if specimen.has_markers else None
    empty = np.zeros((len(RADIUS_FACTORS), depth.size, radius.size))
    return PressTable(
        depth=depth,
        force=np.stack([np.append(0.0, press.force) for press in presses]),
        radius=radius,
        outward=empty if faces is None else np.stack([face[0] for face in faces]),
        sinking=empty if faces is None else np.stack([face[1] for face in faces]),
    )


def _depths() -> Array:
    return np.linspace(0.0, DEEPEST, STEPS + 1)


def _press(specimen: ToldSpecimen, radius: float) -> fem.Solution:
    layers = tuple(fem.Layer(each.name, each.thickness, each.density, _silicone(each)) for each in specimen.layers)
    problem = fem.Problem(
        layers=layers,
        tool=fem.Tool(radius, "rigid_bonded"),
        support=fem.Support(specimen.support, HOLE_RADIUS if specimen.support == "hole" else None),
        kinematics="finite",
        discretisation=fem.Discretisation("fine" if specimen.has_markers else "default"),
    )
    solution = fem.prepare(problem).run(fem.Load("depth", np.arange(1.0, STEPS + 1), _depths()[1:]))
    if not solution.complete:
        raise fem.FemError(f"blind specimen {specimen.name}: {solution.failure}")
    return solution


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


@dataclass(frozen=True)
class TrueShape:
    """How the true body differs from the one that the session tells of.

    Attributes
    ----------
    modulus : float
        Factor on all moduli.
    radius : float
        Factor on the tool's radius, 0.9 to 1.1.
    exponent : float
        Added to the exponent of force over depth.
    width : float
        Factor on the width of the lower face's displacement field.
    """

    modulus: float = 1.0
    radius: float = 1.0
    exponent: float = 0.0
    width: float = 1.0


@dataclass(frozen=True)
class TrueBody:
    """A specimen with its true shape."""

    specimen: ToldSpecimen
    shape: TrueShape = TrueShape()

    def force(self, depth: Array) -> Array:
        """Elastic force (n,) N at depth (n,) m; zero in air."""
        table = press_table(self.specimen)
        pressed = np.clip(depth, 0.0, table.depth[-1])
        curve = CubicSpline(table.depth, self._at_radius(table.force))
        bend = (np.clip(pressed, 1e-3 * REFERENCE_DEPTH, None) / REFERENCE_DEPTH) ** self.shape.exponent
        out: Array = self.shape.modulus * curve(pressed) * bend
        return out

    def lower_face(self, depth: Array, radius: Array) -> tuple[Array, Array]:
        """Outward motion and sinking (n, m) m of lower-face points at radius (m,) m from the axis."""
        table = press_table(self.specimen)
        pressed = np.clip(depth, 0.0, table.depth[-1])
        points = radius / self.shape.width
        outward = _curves(table, self._at_radius(table.outward), points)(pressed)
        sinking = _curves(table, self._at_radius(table.sinking), points)(pressed)
        return outward, sinking

    def _at_radius(self, rows: Array) -> Array:
        """A table's value at the true tool radius, quadratic through the three that were computed."""
        a, b, c = RADIUS_FACTORS
        x = self.shape.radius
        weights = (
            (x - b) * (x - c) / ((a - b) * (a - c)),
            (x - a) * (x - c) / ((b - a) * (b - c)),
            (x - a) * (x - b) / ((c - a) * (c - b)),
        )
        out: Array = np.tensordot(weights, rows, axes=1)
        return out


def _curves(table: PressTable, rows: Array, points: Array) -> CubicSpline:
    """Curves over depth at points (m,) of the lower face."""
    return CubicSpline(table.depth, CubicSpline(table.radius, rows, axis=1)(points))
