"""The sheet over a hole under one interactive tool, wherever the user presses: its patch moves along with it."""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.grid import Grid
from wavemodel.control.radial import RadialPatch, radii_of
from wavemodel.control.round import RoundBody
from wavemodel.errors import require_positive
from wavemodel.plate.model import PlateWave

LEVELS = 48
"""Depths at which the sheet's field is tabulated; linear between them."""


def sheet_body(wave: PlateWave, grid: Grid, deepest: float) -> RoundBody:
    """Tabulate a sheet up to a depth; the patch is as wide as the hole, and patches of several tools just add up.

    Parameters
    ----------
    wave
        The sheet.
    grid
        Vertices that the patch will move.
    deepest
        Largest depth, m.

    Raises
    ------
    WaveError
        If the sheet has no equilibrium so deep.
    """
    require_positive("deepest", deepest, "m")
    reach = wave.hole_radius
    radii = radii_of(reach)
    depths = np.linspace(0.0, deepest, LEVELS + 1)[1:]
    forces = wave.force_of_depth(depths)
    fields = np.stack([wave.field(depth, radii)[1, :-1] for depth in depths.tolist()])
    known, pressed = np.append(0.0, depths), np.append(0.0, forces)

    def depth_of(force: float) -> float:
        return float(np.interp(force, pressed, known))

    def weigh(elastic: float, out: FloatArray) -> None:
        place = depth_of(elastic) / deepest * LEVELS
        low = min(int(place), LEVELS - 1)
        out[:] = 0.0
        out[low] = place - low
        if low:
            out[low - 1] = 1.0 - (place - low)

    return RoundBody(
        patch=RadialPatch(fields, reach, grid.most_vertices(reach)),
        weigh=weigh,
        fields=LEVELS,
        layers=len(wave.layers),
        tool_radius=wave.tool.radius,
        reach=reach,
        deepest=deepest,
        force_of=lambda depth: float(np.interp(depth, known, pressed)),
        depth_of=depth_of,
    )
