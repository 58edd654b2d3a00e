"""A set-up with one parameter changed, or with another choice, by the key that `--set` has for it.

Most parameters change by a share of their value. Those that may be zero or of either sign, and Poisson's ratio, whose
distance from one half counts, change by an amount; see `is_absolute`.
"""

from __future__ import annotations

import math
from typing import Any, TypeVar

from pydantic import BaseModel

from benchmark.errors import InputError
from benchmark.files import Setup, Support, Tissue, Tool
from benchmark.files.overrides import layer_path
from benchmark.files.sessions.description import ASSUMED_EDGE
from benchmark.files.tissue import Layer, scaled_layer

Part = TypeVar("Part", bound=BaseModel)

OTHER_CONTACT = {
    "rigid_bonded": "rigid_frictionless",
    "rigid_frictional": "rigid_frictionless",
    "rigid_frictionless": "rigid_bonded",
}

RADIUS, HOLE_RADIUS = "tool.radius", "support.hole_radius"
THICKNESS = "thickness"
"""Key of the thickness of all layers together."""
STIFFNESS = "stiffness"
"""`LAYER.stiffness`: all stresses of a layer together, its moduli, law and fibres; of a neo-Hookean layer without
constants of its own that is its modulus."""
ABSOLUTE = ("poisson_ratio", "c01", "c20", "c30")
"""Last parts of the keys of layers whose changes are amounts in SI units."""
CLAMP, CONTACT = "support.clamp", "tool.contact"
PRETENSION = "physics.pretension"
"""Key of the in-plane stress of all layers before the press, Pa."""
CHOICES = (CLAMP, CONTACT)
"""Keys that have no number: a set-up is as told, or the other way."""


def choices(tool: Tool, support: Support) -> tuple[str, ...]:
    """Keys of the choices that a set-up could have made otherwise.

    A thick specimen on a base folds at the edge of a touching tool long before the depth of its trials, so that the
    other contact is asked of sheets alone.
    """
    if support.kind != "hole":
        return ()
    return (CLAMP, CONTACT) if tool.contact in OTHER_CONTACT else (CLAMP,)


def other_choice(tool: Tool, support: Support, key: str) -> tuple[Tool, Support]:
    """Tool and support with the other clamp, or the other contact, whose edge is the assumed one."""
    if key == CLAMP:
        return tool, support.model_copy(update={"clamp": "plate" if support.clamp == "rim" else "rim"})
    contact = OTHER_CONTACT[tool.contact]
    edge = ASSUMED_EDGE * tool.radius if contact == "rigid_frictionless" else None
    return tool.model_copy(update={"contact": contact, "edge_radius": edge}), support


def is_absolute(key: str) -> bool:
    """Whether a change of `key` is an amount in SI units, or the share of the way to a choice, not of its value."""
    return key in CHOICES or key.rpartition(".")[2] in ABSOLUTE


def way_of(key: str, change: float) -> float:
    """How far a change goes: the logarithm of the ratio that a share makes; an amount as it is."""
    return change if is_absolute(key) else math.log1p(change)


def natural_change(tissue: Tissue, key: str) -> float:
    """A change of the parameter that matters, of which steps of differences are parts.

    1 for a share; for Poisson's ratio the way to 0.5, for a constant of a law the layer's shear modulus at rest.

    Raises
    ------
    InputError
        The key is of a layer that the tissue does not have.
    """
    if not is_absolute(key):
        return 1.0
    path = layer_path(key, tissue.layer_names)
    if path is None:
        raise InputError(f"{key}: this tissue has no such layer")
    layer = tissue.layers[int(path[1])]
    if path[-1] == "poisson_ratio":
        return 0.5 - layer.poisson_ratio
    return layer.hyperelastic.shear_modulus or layer.shear_modulus


def changed_setup(tissue: Tissue, tool: Tool, support: Support, key: str, change: float) -> Setup:
    """The set-up with `key` times 1 + `change`, or plus `change` where `is_absolute`.

    Of the tool, the support, a layer (`dermis.thickness`), its law (`dermis.hyperelastic.c20`), or the thickness of all
    layers. A hyperelastic law with constants of its own does not follow its layer's `youngs_modulus`, but its
    `stiffness`.

    Raises
    ------
    InputError
        The key points to no number of this set-up.
    """
    if key == THICKNESS:
        layers = tuple(_changed(layer, "thickness", change, key) for layer in tissue.layers)
        return tissue.model_copy(update={"layers": layers}), tool, support
    part, _, name = key.partition(".")
    if part == "tool":
        return tissue, _rounded(_changed(tool, name, change, key), tool), support
    if part == "support":
        return tissue, tool, _changed(support, name, change, key)
    path = layer_path(key, tissue.layer_names)
    if path is None:
        raise InputError(f"{key}: a set-up has tool.NAME, support.NAME, LAYER.NAME and {THICKNESS} to change")
    layers = tuple(
        _layer(layer, [str(name) for name in path[2:]], change, key) if number == path[1] else layer
        for number, layer in enumerate(tissue.layers)
    )
    return tissue.model_copy(update={"layers": layers}), tool, support


def _rounded(changed: Tool, told: Tool) -> Tool:
    """A changed tool whose edge fits its radius: a sphere stays one."""
    edge = told.edge_radius
    if edge is None or changed.edge_radius != edge:
        return changed
    return changed.model_copy(
        update={"edge_radius": changed.radius if edge == told.radius else min(edge, changed.radius)}
    )


def _layer(layer: Layer, path: list[str], change: float, key: str) -> Layer:
    if path == [STIFFNESS]:
        return scaled_layer(layer, 1.0 + change)
    return _within(layer, path, change, key)


def _within(part: Part, path: list[str], change: float, key: str) -> Part:
    """A part with a number in it or in one of its parts changed; terms of a law go by their number from 0."""
    if len(path) == 1:
        return _changed(part, path[0], change, key)
    inner = getattr(part, path[0], None)
    if isinstance(inner, tuple) and len(path) > 2 and path[1].isdecimal() and int(path[1]) < len(inner):
        number = int(path[1])
        changed: Any = (*inner[:number], _within(inner[number], path[2:], change, key), *inner[number + 1 :])
    elif isinstance(inner, BaseModel):
        changed = _within(inner, path[1:], change, key)
    else:
        raise InputError(f"{key}: this set-up has no such number to change")
    return part.model_copy(update={path[0]: changed})


def _changed(part: Part, name: str, change: float, key: str) -> Part:
    value = getattr(part, name, None)
    if not isinstance(value, float | int) or not math.isfinite(value):
        raise InputError(f"{key}: this set-up has no such number to change")
    return part.model_copy(update={name: value + change if is_absolute(key) else value * (1.0 + change)})
