"""The layered sheet over a hole as an elastic body at finite strain, in modes over the radius (no plate theory).

Each layer has its own stiffness and its own strain through the thickness; the lower face is free over the hole. The
body is that of the large press on a base (`wavemodel.layered.finite_strain.modal_body`) but for its functions and what
holds it. Nothing is calibrated.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError
from wavemodel.layered.finite_strain.deformation_state import Deformed
from wavemodel.layered.finite_strain.modal_body import ModalBody
from wavemodel.sheet.layered.held_faces import STIFFNESS, Amplitudes, HeldFaces, bonded_tool, border, plate, pressure_on
from wavemodel.sheet.layered.stretched_modes import StretchedRadius, stretched_modes
from wavemodel.sheet.layered.through_thickness import Piece, SheetThickness, sheet_thickness
from wavemodel.specimen import DiscTool, WaveLayer

BEHIND = 6.0
"""Decay lengths of the sheet that lie on the plate round the hole: behind it nothing moves."""
FAR, AT_TOOL, AT_HOLE = 1.0, 0.03, 0.05
"""Resolved sizes: over the thickness (or the tool's radius, if less) away from the edges and at the tool's edge, and
over the thickness at the hole's."""
AT_TOOL_BY_LAW = 0.015
"""The second under a rigid tool on layers with laws of their own: where those stiffen, its edge weighs more."""
MOST_SIZES = 40.0
"""Of them over the hole's radius away from the edges: a thin sheet needs no more."""
MOST_UNKNOWNS = 10_000
"""Beyond them one tangent, which is a full matrix, has more than 0.8 GB."""
_Terms: TypeAlias = tuple[tuple[int, FloatArray, FloatArray], ...]
"""Component of the gradient, its radial table and its table through the thickness."""


@dataclass(frozen=True)
class LayeredSheet(ModalBody):
    """A sheet, held, in modes.

    Attributes
    ----------
    thickness
        Its functions through the thickness, in pieces.
    place
        Its amplitudes.
    held
        Tool and clamp.
    tool
        The tool.
    """

    thickness: SheetThickness
    place: Amplitudes
    held: HeldFaces
    tool: DiscTool

    def split(self, amplitude: FloatArray) -> tuple[FloatArray, FloatArray]:
        """U (N, n) and W (N + 1, n) of amplitudes (A,)."""
        u, w = np.split(amplitude, [self.place.outward])
        return u.reshape(-1, self.place.nodes), w.reshape(-1, self.place.nodes)

    def packed(self, outward: FloatArray, down: FloatArray) -> FloatArray:
        """(A,) of U (N, n) and W (N + 1, n)."""
        return np.concatenate([outward.ravel(), down.ravel()])

    def tangent(self, state: Deformed) -> FloatArray:
        """(A, A) derivative of the internal forces, N/m."""
        units = np.eye(5).reshape(5, 5, 1, 1)
        moduli = np.stack([state.stress_change(np.broadcast_to(one, state.F.shape)) for one in units], axis=1)
        moduli *= self.volume
        r, t, nodes = self.radial, self.thickness, self.place.nodes
        out_terms: _Terms = ((0, r.stretch, t.shape), (4, r.hoop, t.shape), (1, r.outward, t.slope))
        up_terms: _Terms = ((2, r.slope, t.shape), (3, r.level, t.slope))
        whole, first = np.empty((self.place.size, self.place.size)), self.place.outward
        for rows, columns, left, right in (
            (slice(0, first), slice(0, first), out_terms, out_terms),
            (slice(0, first), slice(first, None), out_terms, up_terms),
            (slice(first, None), slice(first, None), up_terms, up_terms),
        ):
            block = np.zeros((left[0][1].shape[1], nodes, right[0][1].shape[1], nodes))
            for piece in t.pieces:
                block[:, piece.nodes, :, piece.nodes] += _piece_tangent(moduli, left, right, piece)
            whole[rows, columns] = block.reshape(block.shape[0] * nodes, -1)
        whole[first:, :first] = whole[:first, first:].T
        return whole

    def displacement(self, amplitude: FloatArray, depth: float, radius: FloatArray) -> FloatArray:
        """(2, L + 1, R) outwards and downwards of the layers' faces at radii (R,), m, the tool at a depth, m."""
        (u, w), faces = self.split(amplitude), self.thickness.faces
        modes = self.place.modes
        out = np.stack([(modes.outward(radius)[0] @ u[:, faces]).T, (modes.level(radius)[0] @ w[:, faces]).T])
        if self.tool.rigid:
            under = radius <= self.tool.radius
            out[0, 0, under], out[1, 0, under] = 0.0, depth
        return out


def _piece_tangent(moduli: FloatArray, left: _Terms, right: _Terms, piece: Piece) -> FloatArray:
    """(N, p + 1, M, p + 1) of one polynomial."""
    total: FloatArray | None = None
    for (row, across, tall), (column, beside, high) in product(left, right):
        weight = moduli[row, column][:, piece.points].T
        radial = across.T @ (weight[:, :, None] * beside)
        deep = tall[piece.points, piece.nodes, None] * high[piece.points, None, piece.nodes]
        part = np.tensordot(radial, deep, axes=(0, 0))
        total = part if total is None else total + part
    assert total is not None
    return np.asarray(total.transpose(0, 2, 1, 3))


def layered_sheet(layers: Sequence[WaveLayer], tool: DiscTool, hole: float, clamp: str) -> LayeredSheet:
    """Set up a sheet.

    Parameters
    ----------
    layers
        From the surface down.
    tool
        Uniform pressure, or rigid and bonded.
    hole
        Radius, m.
    clamp
        "plate": the lower face is held outside the hole; "rim": the whole border, at the hole.

    Raises
    ------
    NotCoveredError
        If the sheet takes more unknowns than `MOST_UNKNOWNS`: it is very thick, or its pull goes far, beside the tool.
    """
    total = sum(layer.thickness for layer in layers)
    size = min(total, tool.radius)
    at_tool = AT_TOOL_BY_LAW if tool.rigid and any(layer.law for layer in layers) else AT_TOOL
    around = StretchedRadius(
        hole + BEHIND * decay_length(layers) if clamp == "plate" else hole,
        max(FAR * size, hole / MOST_SIZES),
        ((tool.radius, at_tool * size), (hole, AT_HOLE * total)),
    )
    thickness = sheet_thickness(layers)
    _refuse_many(2.0 * around.resolved * thickness.shape.shape[1], layers, tool)
    modes = stretched_modes(around)
    place = Amplitudes(modes, int(thickness.shape.shape[1]))
    return LayeredSheet(modes.tables(), thickness, place, _held(place, layers, tool, hole, clamp), tool)


def _refuse_many(unknowns: float, layers: Sequence[WaveLayer], tool: DiscTool) -> None:
    """Refuse a sheet that takes too many unknowns, before any of its matrices is made."""
    if unknowns > MOST_UNKNOWNS:
        total, far = sum(layer.thickness for layer in layers), decay_length(layers)
        raise NotCoveredError(
            f"the layered sheet over a hole does not cover layers with a thickness of {total * 1e3:.4g} mm, in which a "
            f"pull decays over {far * 1e3:.4g} mm, under a tool with a radius of {tool.radius * 1e3:.4g} mm: they take "
            f"{unknowns / MOST_UNKNOWNS:.2g} times the {MOST_UNKNOWNS} unknowns that are allowed; a wider tool, "
            "thinner layers or layers of less different stiffness take fewer"
        )


def decay_length(layers: Sequence[WaveLayer]) -> float:
    """Length in m over which a sheet stuck to a plate takes up a pull, sqrt(H sum(G_i h_i) / G): shear lag.

    H is the whole thickness and G the modulus of the softest layer; of one layer it is its thickness.
    """
    total = sum(layer.thickness for layer in layers)
    pull = sum(layer.shear_modulus * layer.thickness for layer in layers)
    return math.sqrt(total * pull / min(layer.shear_modulus for layer in layers))


def _held(place: Amplitudes, layers: Sequence[WaveLayer], tool: DiscTool, hole: float, clamp: str) -> HeldFaces:
    total = sum(layer.thickness for layer in layers)
    below = plate(place, hole, AT_HOLE * total) if clamp == "plate" else border(place)
    stiff = np.full(below.shape[1], STIFFNESS * 2.0 * np.pi * hole * layers[-1].shear_modulus)
    if not tool.rigid:
        return HeldFaces(below, stiff, np.zeros(stiff.size), pressure_on(place, tool.radius))
    above = bonded_tool(place, tool.radius)
    with_tool = np.zeros(above.shape[1] + stiff.size)
    with_tool[0] = 1.0
    spring = np.full(above.shape[1], STIFFNESS * tool.radius * layers[0].shear_modulus)
    return HeldFaces(np.hstack([above, below]), np.concatenate([spring, stiff]), with_tool, None)
