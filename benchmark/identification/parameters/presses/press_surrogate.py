"""The elastic force of one set-up near a point: a ramp of a model, and its sensitivity to the fit's coordinates.

The force goes with powers of the parameters, log F = log F_0 + sum of sensitivities times changes of coordinates, at
each depth for itself. A fit refreshes it where it has come to. The model's own derivatives serve, by the chain rule.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.errors import SolverError
from benchmark.files import Session, Setup
from benchmark.identification.parameters.free_parameters import (
    COMMON,
    MODULUS,
    POISSON,
    Parameter,
    Values,
    value_of,
    with_values,
)
from benchmark.identification.parameters.presses.marker_rings import MarkerRings
from benchmark.response.differentiated_ramp import DifferentiatedRamp, differentiated_ramp
from benchmark.response.force_curve import Array
from benchmark.response.setup_change import is_absolute

Forward: TypeAlias = Literal["fem", "wave"]
VOLUME = ".volume"
"""What a layer's name ends in where its bulk modulus alone is meant."""
LEAST_VOLUME = 1e-3
"""0.5 less Poisson's ratio, below which a layer keeps its volume whatever it fades by."""
STEPS = 12
"""Load steps of a press: force over depth is smooth, and a spline goes between them."""
GRID = 600
"""Depths between which forces are linear."""


class StopsError(SolverError):
    """The model does not follow a press to its depth; `reach` is how far it comes, m."""

    def __init__(self, depth: float, reach: float):
        super().__init__(f"the model follows the press to {1e3 * reach:.3g} of {1e3 * depth:.3g} mm")
        self.reach = reach


@dataclass(frozen=True, eq=False)
class PressSurrogate:
    """Elastic force of one set-up.

    Attributes
    ----------
    depth : (k,) array
        m, even, from 0.
    force : (k,) array
        N at `at`.
    by : (p, k) array
        Derivatives of the force's logarithm by the coordinates of the whole fit.
    layers : mapping of layer to (k,) array
        Derivatives of the force's logarithm by each relaxing layer's shear stiffness, and, as `LAYER.volume`, by its
        bulk modulus, which does not relax.
    at : (p,) array
        Coordinates.
    mesh_error : float or None
        Estimated error of the force at the press's depth, a share of it; None where it was not estimated.
    at_edge : float or (k,) array
        The part of that error that goes with the depth, shares of the force.
    rings : (s, k) array
        Motion of the markers' rings, m; without markers of no ring.
    rings_by : (p, s, k) array or None
        Its derivatives by the coordinates, m; None without markers.
    """

    depth: Array
    force: Array
    by: Array
    layers: Mapping[str, Array]
    at: Array
    mesh_error: float | None = None
    at_edge: float | Array = 0.0
    rings: Array = field(default_factory=lambda: np.zeros((0, GRID)))
    rings_by: Array | None = None

    def rings_at(self, vector: Array) -> Array:
        """(s, k) m of the markers' rings on the grid of depths, at other coordinates (p,): linear in them."""
        return self.rings if self.rings_by is None else self.rings + np.tensordot(vector - self.at, self.rings_by, 1)

    def rings_by_at(self, vector: Array) -> Array:
        """(p, s, k) derivatives of the rings' motion by the coordinates, m."""
        return np.zeros((vector.size, *self.rings.shape)) if self.rings_by is None else self.rings_by

    def force_at(self, vector: Array) -> Array:
        """(k,) N at the depths of the grid, at other coordinates (p,)."""
        return np.asarray(self.force * np.exp((vector - self.at) @ self.by))

    def by_at(self, vector: Array) -> Array:  # noqa: ARG002 - the same everywhere, as an atlas' is not
        """(p, k) derivatives of the force's logarithm by the coordinates."""
        return self.by

    def curve(self, grid: Array, depth: Array) -> Array:
        """(..., n) of quantities on the grid (..., k) at depths (n,), m; zero above the surface, straight on below."""
        at = np.maximum(depth, 0.0) / (self.depth[1] - self.depth[0])
        left = np.minimum(at.astype(np.int64), self.depth.size - 2)
        share = at - left
        between = grid[..., left] * (1.0 - share) + grid[..., left + 1] * share
        return np.asarray(np.where(depth > 0.0, between, 0.0))


@dataclass(frozen=True, eq=False)
class Press:
    """What is pressed with what: a specimen's number in the fit, its session, set-up as told, and how deep, m.

    `mesh_error` is by what share of the force at that depth the model is estimated to be wrong; None: not estimated.
    `rings` are the markers on its lower face, where they are fitted.
    """

    specimen: int
    session: Session
    setup: Setup
    depth: float
    mesh_error: float | None = None
    rings: MarkerRings | None = None

    def has(self, parameter: Parameter) -> bool:
        """Whether a parameter acts on this press."""
        specimen, tool = parameter.specimen, parameter.tool
        return specimen in (None, self.specimen) and tool in (None, self.setup[1])


def surrogate(
    press: Press,
    parameters: Sequence[Parameter],
    vector: Array,
    law: str | None,
    relaxing: Sequence[str],
    forward: Forward,
    *,
    judge_mesh: bool = False,
) -> PressSurrogate:
    """Press a set-up with the values that the coordinates (p,) give, and differentiate the press.

    With `judge_mesh` the model estimates the error of its mesh, which takes further solutions.

    Raises
    ------
    SolverError
        The model does not follow the press to its depth, or only with a force that no curve goes through: a law locks.
    InputError
        It does not cover the set-up.
    """
    acting = [k for k, one in enumerate(parameters) if press.has(one) and not one.fading]
    values = acting_values(press, parameters, vector)
    setup = with_values(press.setup, values, law)
    chains = {k: _chain(parameters[k], values, setup) for k in acting}
    fading = {key: chain for name in relaxing for key, chain in _fading_chains(name, setup).items()}
    wanted = {key for chain in (*chains.values(), *fading.values()) for key in chain}
    keys = sorted(wanted)
    ramp = differentiated_ramp(press.session, *setup, press.depth, keys, forward, STEPS, judge_mesh=judge_mesh)
    if ramp.failure is not None or ramp.depth[-1] < press.depth * (1.0 - 1e-9):
        raise StopsError(press.depth, float(ramp.depth[-1]))
    locked = SolverError(f"the force of {press.setup[0].name!r} does not go smoothly with the depth at these values")
    if not np.isfinite(ramp.force).all():
        raise locked
    by = np.zeros((len(parameters), GRID))
    for k, chain in chains.items():
        by[k] = 1.0 if parameters[k].key == COMMON else _logarithmic(ramp, chain)
    grid = np.linspace(0.0, press.depth, GRID)
    layers = {name: _logarithmic(ramp, chain) for name, chain in fading.items()}
    force = np.asarray(CubicSpline(ramp.depth, ramp.force)(grid))
    at_edge = 0.0 if ramp.at_edge is None else np.interp(grid, ramp.depth, ramp.at_edge)
    rings = _rings(press, ramp, chains, len(parameters))
    if not (np.isfinite(force).all() and np.isfinite(by).all() and force[1:].min() > 0.0):
        raise locked
    return PressSurrogate(grid, force, by, layers, vector.copy(), ramp.mesh_error, at_edge, *rings)


def _rings(
    press: Press, ramp: DifferentiatedRamp, chains: Mapping[int, Mapping[str, float]], count: int
) -> tuple[Array, Array | None]:
    """The motion (s, k) of the markers' rings over the grid, and its derivatives (p, s, k); none without markers."""
    rings, face = press.rings, ramp.face
    if rings is None or face is None:
        return np.zeros((0, GRID)), None
    grid = np.linspace(0.0, ramp.depth[-1], GRID)

    def over_grid(levels: Array) -> Array:
        return np.asarray(CubicSpline(ramp.depth, levels)(grid).T)

    seen = over_grid(rings.seen(face, ramp.depth))
    by = np.zeros((count, *seen.shape))
    for k, chain in chains.items():
        for key, weight in chain.items():
            outward, sunk = ramp.by[key].outward, ramp.by[key].sunk
            if outward is not None and sunk is not None:
                by[k] += weight * over_grid(rings.changes(face, outward, sunk, ramp.depth))
    return seen, by


def acting_values(press: Press, parameters: Sequence[Parameter], vector: Array) -> dict[str, float]:
    """Values of the elastic parameters that act on a press, SI, by key."""
    pairs = zip(parameters, vector, strict=True)
    return {one.key: one.value(float(x)) for one, x in pairs if press.has(one) and not one.fading}


def _logarithmic(ramp: DifferentiatedRamp, chain: Mapping[str, float]) -> Array:
    """(k,) derivative of the force's logarithm on the grid, by shares of keys, straight on to the surface."""
    total = sum(weight * ramp.by[key].force for key, weight in chain.items())
    share = np.asarray(total)[1:] / ramp.force[1:]
    grid = np.linspace(0.0, ramp.depth[-1], GRID)
    return np.asarray(CubicSpline(ramp.depth, np.append(2.0 * share[0] - share[1], share))(grid))


def _chain(parameter: Parameter, values: Values, setup: Setup) -> dict[str, float]:
    """Keys of the ramp and by how much each changes with the parameter's coordinate, in the ramp's own terms."""
    key, last = parameter.key, parameter.key.rpartition(".")[2]
    if key == COMMON:
        return {}
    if key.startswith("law."):
        shapes = [_shape_chain(name, values[key], setup) for name in setup[0].layer_names]
        share = parameter.share(values[key])
        return {name: share * weight for chain in shapes for name, weight in chain.items()}
    layer = key.rpartition(".")[0]
    if last == MODULUS and layer in setup[0].layer_names:
        own = [each for each in values if each.startswith(f"{layer}.hyperelastic.")]
        return {f"{layer}.stiffness": 1.0} | {each: -_size(each, values[each]) for each in own}
    if last == POISSON:
        poisson = values[key]
        way = -0.5 * (1.0 - 2.0 * poisson)
        follows = setup[0].layer(layer).hyperelastic.shear_modulus is None
        return {key: way} | ({} if follows else {f"{layer}.stiffness": -way / (1.0 + poisson)})
    return {key: _size(key, values[key])}


def _fading_chains(layer: str, setup: Setup) -> dict[str, dict[str, float]]:
    """Chains of a layer's shear stiffness and, as `LAYER.volume`, of its bulk modulus, each alone.

    At one shear modulus the bulk modulus 2 mu (1 + nu) / (3 (1 - 2 nu)) goes with Poisson's ratio; that of a layer
    without constants of a law is one at a fixed Young's modulus.
    """
    one = setup[0].layer(layer)
    poisson = float(one.poisson_ratio)
    if 0.5 - poisson < LEAST_VOLUME:
        return {layer: {f"{layer}.stiffness": 1.0}}
    way = 1.0 / (1.0 / (1.0 + poisson) + 2.0 / (1.0 - 2.0 * poisson))
    along = way / (1.0 + poisson) if one.hyperelastic.shear_modulus is None else 0.0
    volume = {f"{layer}.poisson_ratio": way, f"{layer}.stiffness": along}
    shape = {f"{layer}.poisson_ratio": -way, f"{layer}.stiffness": 1.0 - along}
    return {layer: shape, f"{layer}{VOLUME}": volume}


def _size(key: str, value: float) -> float:
    """The change of a key, in the ramp's terms, with the logarithm of its value."""
    return value if is_absolute(key) else 1.0


def _shape_chain(layer: str, shape: float, setup: Setup) -> dict[str, float]:
    """The chain of a law's constant of shape in one layer, at a fixed shear modulus."""
    own = f"{layer}.hyperelastic"
    match setup[0].layer(layer).hyperelastic.law:
        case "yeoh":
            return {f"{own}.c20": value_of(f"{own}.c20", setup)}
        case "gent":
            return {f"{own}.jm": 1.0}
        case "ogden":
            return {f"{own}.terms.0.mu": -1.0, f"{own}.terms.0.alpha": 1.0}
        case "mooney_rivlin":
            c01 = value_of(f"{own}.c01", setup)
            return {f"{own}.c10": -shape / (1.0 + shape), f"{own}.c01": c01 / (1.0 + shape)}
        case _:  # neo-Hookean has none: the constant is that of the fibres in it
            return {f"{layer}.fibre.k1": 1.0}
