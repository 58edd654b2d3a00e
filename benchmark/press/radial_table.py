"""A tool's answer as a table that a page can read: a few fields over the radius, weights and force over the depth.

The wave's body and the finite elements' ramp have the same form, so that one reader draws both and their difference.
"""

from __future__ import annotations

import base64
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.models.model_result import Array
from wavemodel.control.pressed_body import RoundBody

NODES = 1025
"""Depths at which weights and force are tabulated; linear between them."""
NEGLECTED = 1e-8
"""Fields that add less than this share of the largest are left out."""


@dataclass(frozen=True, eq=False)
class RadialTable:
    """B fields over R even radii for L layers' top faces.

    Attributes
    ----------
    field
        (B, L, R) deflection per weight, m.
    weight
        (N, B) of the fields at N even depths from nought to `deepest`.
    force
        (N,) elastic force at those depths, N; rising.
    reach, deepest, tool_radius
        In m; nothing moves beyond the reach.
    surface
        (R,) the surface's deflection per newton, where several tools feel each other; else None.
    """

    field: Array
    weight: Array
    force: Array
    reach: float
    deepest: float
    tool_radius: float
    surface: Array | None = None

    @property
    def depth(self) -> Array:
        """(N,) m."""
        return np.linspace(0.0, self.deepest, self.force.size)

    def profile(self, depth: float) -> Array:
        """(L, R) deflection under a tool this deep, m."""
        weight = [np.interp(depth, self.depth, column) for column in self.weight.T]
        return np.asarray(np.tensordot(weight, self.field, axes=1))

    def with_force(self, force: Array) -> RadialTable:
        """The same faces under another law of force (N,), under which several tools just add up."""
        return replace(self, force=force, surface=None)

    def to_dict(self) -> dict[str, Any]:
        """The table as JSON holds it: numbers little-endian in base64, fields single, all else double precision."""
        fields, layers, radii = self.field.shape
        return {
            "fields": fields,
            "layers": layers,
            "radii": radii,
            "reach_m": self.reach,
            "deepest_m": self.deepest,
            "tool_radius_m": self.tool_radius,
            "field": _text(self.field, "<f4"),
            "weight": _text(self.weight, "<f8"),
            "force_N": _text(self.force, "<f8"),
            "surface": None if self.surface is None else _text(self.surface, "<f8"),
        }


def _text(values: Array, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def table_of_body(body: RoundBody, deepest: float) -> RadialTable:
    """Tabulate a round body of the wave down to a depth, m, that it answers."""
    force = np.array([body.elastic(depth) for depth in np.linspace(0.0, deepest, NODES).tolist()])
    weight = np.zeros((NODES, body.fields))
    for row, one in zip(weight, force.tolist(), strict=True):
        body.weigh(one, row)
    field, fewest = _fewest(body.patch.fields, weight)
    return RadialTable(field, fewest, force, body.reach, deepest, body.tool_radius, body.surface)


def table_of_levels(depth: Array, profile: Array, force: Array, reach: float, tool_radius: float) -> RadialTable:
    """Tabulate a ramp that is known at a few levels, smooth between them.

    Parameters
    ----------
    depth
        (k,) levels in m, rising from above nought.
    profile
        (k, L, R) deflection at even radii up to the reach, m.
    force
        (k,) N.
    reach, tool_radius
        In m.
    """
    levels, fine = np.append(0.0, depth), np.linspace(0.0, float(depth[-1]), NODES)
    field, history = _fewest(profile, np.eye(depth.size))
    history = np.vstack([np.zeros(history.shape[1]), history])
    law = CubicSpline(levels, np.append(0.0, force))
    return RadialTable(field, CubicSpline(levels, history)(fine), law(fine), reach, float(depth[-1]), tool_radius)


def _fewest(field: Array, weight: Array) -> tuple[Array, Array]:
    """The same sums of fields (B, L, R) with weights (N, B), with as few fields as they need."""
    basis, mixed = np.linalg.qr(field.reshape(field.shape[0], -1).T)
    left, sizes, right = np.linalg.svd(weight @ mixed.T, full_matrices=False)
    kept = max(1, int(np.count_nonzero(sizes > NEGLECTED * sizes[0])))
    return (right[:kept] @ basis.T).reshape(kept, *field.shape[1:]), left[:, :kept] * sizes[:kept]
