"""The force-depth law of one tool on one sheet over a hole, and the fields that belong to it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.plate.curve import Curve
from wavemodel.plate.faces import Faces
from wavemodel.plate.indentation import Indentation, indentation
from wavemodel.plate.path import Equilibrium, follow
from wavemodel.plate.sheet import Sheet
from wavemodel.specimen import DiscTool, WaveLayer

STEPS = 20
CROWDING = 1.5
"""Equilibria over the depth or force that is asked for; the splines between them are right to 1e-4.
They crowd at small loads, where the tension sets in."""


@dataclass(frozen=True)
class PlateLaw:
    """Statics of a sheet.

    Attributes
    ----------
    sheet
        The sheet and its tool.
    faces
        Synthesis of the faces' displacement.
    dent
        What a pressure adds at the surface; None under a rigid tool.
    path
        The equilibria found, from rest on.
    """

    sheet: Sheet
    faces: Faces
    dent: Indentation | None
    path: tuple[Equilibrium, ...]

    def extended(self, load: float) -> "PlateLaw":
        """The same with equilibria up to a load: depth of a rigid tool (m), or force of a pressure (N).

        Raises
        ------
        WaveError
            If the sheet has no equilibrium up to there.
        """
        last = self.path[-1].load
        if load <= last:
            return self
        count = max(2, int(np.ceil(STEPS * (load - last) / load)))
        share = np.linspace(last / load, 1.0, count + 1)[1:]
        if last == 0.0:
            share = share**CROWDING
        found = follow(self.sheet, self.path, share * load)
        if found[-1].load < load:
            unit, scale = ("mm", 1e3) if self.sheet.tool is not None else ("N", 1.0)
            raise WaveError(
                f"load = {load * scale:.4g} {unit} is not allowed: this sheet's equilibrium was followed up to "
                f"{found[-1].load * scale:.4g} {unit}"
            )
        return replace(self, path=found)

    def curve(self) -> Curve:
        """Splines through the equilibria."""
        state = np.stack([point.state for point in self.path])
        load = np.array([point.load for point in self.path])
        rigid = self.sheet.tool is not None
        prescribed = [(point.load, 0.0) if rigid else (0.0, point.load) for point in self.path]
        axis = np.stack(
            [
                self.displacement(point.state, *given, np.zeros(1))[1, :, 0]
                for point, given in zip(self.path, prescribed, strict=True)
            ]
        )
        depth, force = (load, -state[:, -1]) if rigid else (axis[:, 0], load)
        return Curve(depth, force, state, axis[:, :-1])

    def displacement(self, state: FloatArray, depth: float, force: float, radius: FloatArray) -> FloatArray:
        """(2, L + 1, R): outwards and downwards, m, of the faces at radii up to the hole's edge."""
        out = self.faces.displacement(state, depth, radius)
        if self.dent is not None:
            out[1] += force * (self._axis_dent if not radius.any() else self.dent.deflection(radius))
        return out

    @cached_property
    def _axis_dent(self) -> FloatArray:
        return np.zeros((1, 1)) if self.dent is None else self.dent.deflection(np.zeros(1))


def plate_law(layers: Sequence[WaveLayer], tool: DiscTool, sheet: Sheet) -> PlateLaw:
    """The law at rest; `extended` finds equilibria."""
    faces = Faces(sheet)
    dent = None if tool.rigid else indentation(layers, sheet.section, faces.bulge, tool.radius)
    return PlateLaw(sheet, faces, dent, (Equilibrium(0.0, np.zeros(sheet.unknowns)),))
