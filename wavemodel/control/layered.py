"""The layered wave under interactive tools: linear, or with its large-press correction."""

from dataclasses import replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.grid import Grid
from wavemodel.control.radial import RadialPatch, radii_of
from wavemodel.control.round import RoundBody
from wavemodel.layered import LayeredWave


def layered_body(wave: LayeredWave, grid: Grid) -> RoundBody:
    """Tabulate a wave round its tool; the patch is as wide as the wave's window.

    A linear wave answers several tools together: each is as deep as it is told under the forces of all. With the
    large-press correction the patches of several tools just add up. A linear press may be as deep as the stack is high.

    Parameters
    ----------
    wave
        Its window and tool.
    grid
        Vertices that the patch will move.
    """
    large, reach = wave.law.large, wave.press.field.domain.reach
    radii = radii_of(reach)
    unit = replace(wave.press.field, large=None).along_x(wave.static_state(1.0), radii)[None]
    fields = unit if large is None else np.concatenate([unit, large.at_radius(radii)])

    def weigh(elastic: float, out: FloatArray) -> None:
        out[0] = elastic
        if large is not None:
            out[1:] = large.weights_at(elastic)

    return RoundBody(
        patch=RadialPatch(fields, reach, grid.most_vertices(reach)),
        weigh=weigh,
        fields=fields.shape[0],
        layers=len(wave.layers),
        tool_radius=wave.tool.radius,
        reach=reach,
        deepest=wave.press.stack.height if large is None else large.deepest,
        force_of=lambda depth: float(wave.law(np.asarray(depth))),
        depth_of=lambda force: float(wave.law.depth_at(np.asarray(force))),
        surface=unit[0, 0] if large is None else None,
    )
