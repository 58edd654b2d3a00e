"""A set-up with one parameter changed by a share of it, by the key that `--set` has for it."""

from __future__ import annotations

from typing import TypeVar

from pydantic import BaseModel

from benchmark.errors import InputError
from benchmark.files import Support, Tissue, Tool
from benchmark.files.overrides import layer_path

Part = TypeVar("Part", bound=BaseModel)

RADIUS = "tool.radius"
THICKNESS = "thickness"
"""Key of the thickness of all layers together."""


def changed_setup(tissue: Tissue, tool: Tool, support: Support, key: str, share: float) -> tuple[Tissue, Tool, Support]:
    """The set-up with `key` times 1 + `share`: of the tool, the support, a layer, or the thickness of all layers.

    A hyperelastic law with constants of its own does not follow its layer's `youngs_modulus`.

    Raises
    ------
    InputError
        The key points to no number of this set-up.
    """
    if key == THICKNESS:
        layers = tuple(_changed(layer, "thickness", share, key) for layer in tissue.layers)
        return tissue.model_copy(update={"layers": layers}), tool, support
    part, _, name = key.partition(".")
    if part == "tool":
        return tissue, _rounded(_changed(tool, name, share, key), tool), support
    if part == "support":
        return tissue, tool, _changed(support, name, share, key)
    path = layer_path(key, tissue.layer_names)
    if path is None:
        raise InputError(f"{key}: a set-up has tool.NAME, support.NAME, LAYER.NAME and {THICKNESS} to change")
    layers = tuple(
        _changed(layer, str(path[2]), share, key) if number == path[1] else layer
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


def _changed(part: Part, name: str, share: float, key: str) -> Part:
    value = getattr(part, name, None)
    if not isinstance(value, float | int):
        raise InputError(f"{key}: this set-up has no such number to change")
    return part.model_copy(update={name: value * (1.0 + share)})
