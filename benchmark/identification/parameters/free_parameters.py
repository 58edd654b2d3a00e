"""The parameters of a fit: their keys, values and bounds, the coordinate each is fitted in, and a set-up with them.

Coordinates are logarithms of values, so that steps are shares; Poisson's ratio has log(1 - 2 nu), in which a nearly
incompressible layer answers evenly, and Ogden's power, which may be negative, arsinh(alpha). A layer's `youngs_modulus`
takes all stresses of its law along, except constants that have a value of their own in the same fit.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TypeAlias

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Setup, Tissue, Tool, units
from benchmark.files.overrides import layer_path
from benchmark.files.tissue import Layer, scaled_layer
from benchmark.files.units import Dimension, shown
from benchmark.identification.parameters.law_shapes import LAW_SHAPES, POWER, shear_modulus, with_law
from benchmark.response.force_curve import Array
from benchmark.response.setup_change import RADIUS, THICKNESS, changed_setup

Values: TypeAlias = Mapping[str, float]

STRESS = ("youngs_modulus", "c10", "c01", "c20", "c30", "mu", "k1")
EDGE_RADIUS = "tool.edge_radius"
SETUP_KEYS = (RADIUS, EDGE_RADIUS, "support.hole_radius", "support.specimen_radius")
"""What a fit may vary of tool and support."""
LENGTHS = ("radius", "hole_radius", "edge_radius", "specimen_radius")

COMMON = "stiffness_factor"
"""Key of one factor on all stresses of all layers."""
MODULUS, POISSON, RELAXATION = "youngs_modulus", "poisson_ratio", "relaxation"
SHARE, TIME = ".relaxation.g", ".relaxation.tau"
FAR = 30.0
"""A parameter without bounds of its own may go this many times up or down."""
POISSON_BOUNDS = (0.05, 0.4995)
LEAST_POWER = 0.01
"""Ogden's power is no nearer to none, where his law tends to Hencky's."""
SHARE_BOUNDS, TIME_BOUNDS = (1e-3, 0.95), (1e-2, 1e4)


def dimension_of_key(key: str) -> Dimension:
    """The dimension of a key's value, by its last part; `thickness` of all layers is a factor."""
    last = key.rpartition(".")[2]
    if last in STRESS:
        return units.PRESSURE
    if last in LENGTHS or (last == "thickness" and key != THICKNESS):
        return units.LENGTH
    return units.DURATION if last == "tau" else units.dimension_of("")


AT_END = 1e-6
"""Of a coordinate: a value so near a bound stands at it."""


@dataclass(frozen=True)
class Prior:
    """What is known of a parameter beforehand: value, standard uncertainty of its coordinate, and who says so."""

    value: float
    deviation: float
    source: str


@dataclass(frozen=True)
class Parameter:
    """A parameter of a fit.

    Attributes
    ----------
    key : str
        As in `--set`, or `thickness`, `stiffness_factor`, `law.NAME`.
    start, low, high : float
        SI.
    prior : Prior or None
    told : bool
        Whether it is a value of the set-up that was told with an uncertainty, and no free parameter.
    specimen : int or None
        The specimen that alone has it; None for all.
    tool : Tool or None
        The tool that alone has it.
    """

    key: str
    start: float
    low: float
    high: float
    prior: Prior | None = None
    told: bool = False
    specimen: int | None = None
    tool: Tool | None = None

    @property
    def unit(self) -> str:
        """Of the value at the border."""
        return shown(1.0, dimension_of_key(self.key).si)[1]

    @property
    def scale(self) -> float:
        """The number of the border's unit for 1 in SI."""
        return shown(1.0, dimension_of_key(self.key).si)[0]

    def shown(self, value: float) -> str:
        """A value (SI) with the border's unit."""
        return f"{self.scale * value:.4g} {self.unit}".strip()

    @property
    def fading(self) -> bool:
        """Whether it belongs to the relaxation, and not to the elastic answer."""
        return self.key.endswith((SHARE.lstrip("."), TIME.lstrip(".")))

    def coordinate(self, value: float) -> float:
        """The coordinate of a value."""
        if self.signed:
            return math.asinh(value)
        return math.log(1.0 - 2.0 * value) if self._bulk else math.log(value)

    def value(self, coordinate: float) -> float:
        """The value at a coordinate."""
        if self.signed:
            return math.copysign(max(abs(math.sinh(coordinate)), LEAST_POWER), coordinate)
        return 0.5 * (1.0 - math.exp(coordinate)) if self._bulk else math.exp(coordinate)

    def share(self, value: float) -> float:
        """By what share of itself a value that is no Poisson's ratio changes with its coordinate."""
        return math.hypot(1.0, value) / value if self.signed else 1.0

    @property
    def signed(self) -> bool:
        """Whether it may be negative."""
        return self.key == POWER

    @property
    def limits(self) -> tuple[float, float]:
        """Bounds of the coordinate, the lower first."""
        ends = (self.coordinate(self.low), self.coordinate(self.high))
        return min(ends), max(ends)

    def at_end(self, coordinate: float) -> bool:
        """Whether a coordinate stands at one of its bounds."""
        return any(abs(coordinate - end) <= AT_END for end in self.limits)

    @property
    def _bulk(self) -> bool:
        return self.key.endswith(POISSON)


def parameters_of(key: str, setup: Setup, law: str | None) -> tuple[Parameter, ...]:
    """The parameters that a key of `--free` stands for, as a set-up has them.

    Raises
    ------
    InputError
        The key points to no positive number of this specimen and set-up.
    """
    if key.partition(".")[2] == RELAXATION or key == RELAXATION:
        return _relaxation(key, setup[0])
    if key.startswith("law."):
        return (_shape(key, law),)
    if key in (COMMON, THICKNESS):
        return (Parameter(key, 1.0, 1.0 / FAR, FAR),)
    value = value_of(key, setup)
    if not value > 0.0 or math.isinf(value):
        raise InputError(f"--free {key}: {value:g} is nothing to vary by shares; allowed: values above 0")
    if key.endswith(POISSON):
        return (Parameter(key, value, min(POISSON_BOUNDS[0], value), max(POISSON_BOUNDS[1], value)),)
    return (Parameter(key, value, value / FAR, value * FAR),)


def refuse_without_effect(key: str, setups: Iterable[Setup], given: str = "--free") -> None:
    """Refuse a key that changes no force in any of the set-ups; raises InputError, which says why."""
    whys = [_without_effect(key, setup) for setup in setups]
    if all(whys):
        raise InputError(f"{given} {key}: no force depends on it ({whys[0]}); leave it out")


def _without_effect(key: str, setup: Setup) -> str:
    """Why a key changes no force of a press of this set-up; empty where it does."""
    tissue, _, support = setup
    last = tissue.layers[-1].name
    endless = (f"{last}.{THICKNESS}", *((THICKNESS,) if len(tissue.layers) == 1 else ()))
    if key in {f"{name}.density" for name in tissue.layer_names}:
        return "presses are quasi-static, without inertia"
    if support.kind == "half_space" and key in endless:
        return f"the last layer of a half_space, {last}, is endless"
    return "a plate covers the cylinder's face" if support.cylinder and key == RADIUS else ""


def _relaxation(key: str, tissue: Tissue) -> tuple[Parameter, ...]:
    layers = tissue.layers
    if key != RELAXATION:
        path = layer_path(key, tissue.layer_names)
        if path is None:
            raise _no_key(key, tissue)
        layers = (layers[int(path[1])],)
    told = layers[0].relaxation
    share, time = (told[0].g, told[0].tau) if told else (0.2, 2.0)
    return (Parameter(f"{key}.g", share, *SHARE_BOUNDS), Parameter(f"{key}.tau", time, *TIME_BOUNDS))


def _shape(key: str, law: str | None) -> Parameter:
    shape = None if law is None else LAW_SHAPES[law]
    if shape is None or shape.key != key:
        known = ", ".join(f"{one.key} with --law {name}" for name, one in LAW_SHAPES.items() if one.key)
        raise InputError(f"--free {key}: the fit has no such law; allowed: {known}")
    return Parameter(key, shape.start, shape.low, shape.high)


def value_of(key: str, setup: Setup, given: str = "--free") -> float:
    """The value of a key in a set-up, SI; raises InputError, which says that the key came from `given`."""
    tissue, tool, support = setup
    head, _, name = key.partition(".")
    parts = {"tool": tool, "support": support}
    if head in parts and head not in tissue.layer_names:
        found = getattr(parts[head], name, None) if key in SETUP_KEYS else None
    else:
        path = layer_path(key, tissue.layer_names)
        if path is None:
            raise _no_key(key, tissue, given)
        found = _layer_value(tissue.layers[int(path[1])], [str(part) for part in path[2:]])
    if not isinstance(found, float | int) or isinstance(found, bool):
        raise _no_key(key, tissue, given)
    return float(found)


def _layer_value(layer: Layer, path: list[str]) -> object:
    if path == [MODULUS]:
        return 2.0 * (1.0 + layer.poisson_ratio) * shear_modulus(layer)
    node: object = layer
    for part in path:
        node = getattr(node, part, None)
    return node


def _no_key(key: str, tissue: Tissue, given: str = "--free") -> InputError:
    layers = ", ".join(tissue.layer_names)
    names = (MODULUS, POISSON, RELAXATION, THICKNESS)
    of_layers = [f"{layer}.{name}" for layer in tissue.layer_names for name in names]
    near = get_close_matches(key, [*of_layers, *SETUP_KEYS, *names, COMMON], n=1)
    meant = f"did you mean {near[0]}? " if near else ""
    return InputError(
        f"{given} {key}: this specimen and set-up have no such number; {meant}allowed: LAYER.youngs_modulus, "
        f"LAYER.thickness, LAYER.poisson_ratio, LAYER.relaxation, LAYER.hyperelastic.NAME for the layers {layers}; "
        f"thickness, relaxation, {', '.join(SETUP_KEYS)}, and a law's constant of shape"
    )


def with_values(setup: Setup, values: Values, law: str | None = None) -> Setup:
    """A set-up with values (SI) put in by their keys; values of relaxation are left out, a fit has them by itself."""
    tissue, tool, support = setup
    layers = [_changed_layer(layer, values) for layer in tissue.layers]
    tissue = tissue.model_copy(update={"layers": tuple(layers)})
    if law is not None:
        tissue = with_law(tissue, law, values.get(LAW_SHAPES[law].key, LAW_SHAPES[law].start))
    constants = [_own_constants(layer, values) for layer in tissue.layers]
    changed: Setup = (tissue.model_copy(update={"layers": tuple(constants)}), tool, support)
    for key in (THICKNESS, *SETUP_KEYS):
        if key in values:
            told = 1.0 if key == THICKNESS else value_of(key, changed)
            changed = changed_setup(*changed, key, values[key] / told - 1.0)
    return changed


def _changed_layer(layer: Layer, values: Values) -> Layer:
    """A layer with thickness, Poisson's ratio and modulus put in, the law's stresses taken along."""
    poisson = values.get(f"{layer.name}.{POISSON}", layer.poisson_ratio)
    told = 2.0 * (1.0 + layer.poisson_ratio) * shear_modulus(layer)
    modulus = values.get(f"{layer.name}.{MODULUS}", told) * values.get(COMMON, 1.0)
    factor = modulus / told * (1.0 + layer.poisson_ratio) / (1.0 + poisson)
    thickness = values.get(f"{layer.name}.thickness", layer.thickness)
    changes = {POISSON: poisson, "thickness": thickness, MODULUS: modulus}
    return scaled_layer(layer, factor).model_copy(update=changes)


def _own_constants(layer: Layer, values: Values) -> Layer:
    """A layer with constants of its law put in."""
    for part in ("hyperelastic", "fibre"):
        start = f"{layer.name}.{part}."
        own = {key.removeprefix(start): value for key, value in values.items() if key.startswith(start)}
        if own:
            layer = layer.model_copy(update={part: getattr(layer, part).model_copy(update=own)})
    return layer


def elastic(tissue: Tissue) -> Tissue:
    """A tissue without its relaxation."""
    return tissue.model_copy(
        update={"layers": tuple(one.model_copy(update={"relaxation": ()}) for one in tissue.layers)}
    )


def values_at(parameters: tuple[Parameter, ...], vector: Array) -> dict[str, float]:
    """Values (SI) by key at coordinates (p,)."""
    return {one.key: one.value(float(x)) for one, x in zip(parameters, vector, strict=True)}


def start_vector(parameters: tuple[Parameter, ...]) -> Array:
    """(p,) coordinates of the parameters' starts."""
    return np.array([one.coordinate(one.start) for one in parameters])
