"""The wave models under interactive tools, tabulated round the tool: the layered wave, and the sheet over a hole.

The layered wave is linear or at finite strain; the sheet's patch is as wide as its hole and moves along with the tool.
"""

from dataclasses import replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.interactive_tissue import Grid
from wavemodel.control.pressed_body import RadialPatch, RoundBody, radii_of
from wavemodel.errors import require_positive
from wavemodel.layered.layered_wave import LayeredWave
from wavemodel.sheet.plate_wave import PlateWave

EVEN = 4096
"""Steps of depth of a law that is only read off."""
LEVELS = 48
"""Depths at which the sheet's field is tabulated; linear between them."""


def layered_body(wave: LayeredWave, grid: Grid) -> RoundBody:
    """Tabulate a wave round its tool; the patch is as wide as the wave's window.

    A linear wave answers several tools together: each is as deep as it is told under the forces of all. At finite
    strain the patches of several tools just add up. A linear press may be as deep as the stack is high.

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


def with_quick_law(body: RoundBody) -> RoundBody:
    """The same body with its force read off a table of even depths, in a microsecond, for a haptic loop.

    Between the depths it is linear: of a law whose slope changes by its own size over the range, 1e-8 of the largest
    force is lost.
    """
    deepest, force = body.deepest, [body.force_of(depth) for depth in np.linspace(0.0, body.deepest, EVEN + 1).tolist()]

    def force_of(depth: float) -> float:
        place = depth / deepest * EVEN
        low = min(int(place), EVEN - 1)
        return force[low] + (place - low) * (force[low + 1] - force[low])

    return replace(body, force_of=force_of)


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
    reach, depths = wave.hole_radius, np.linspace(0.0, deepest, LEVELS + 1)
    forces, radii = np.append(0.0, wave.force_of_depth(depths[1:])), radii_of(reach)
    fields = np.stack([wave.field(depth, radii)[1, :-1] for depth in depths[1:].tolist()])

    def depth_of(force: float) -> float:
        return float(np.interp(force, forces, depths))

    return RoundBody(
        patch=RadialPatch(fields, reach, grid.most_vertices(reach)),
        weigh=lambda elastic, out: _weigh_levels(depth_of(elastic) / deepest * LEVELS, out),
        fields=LEVELS,
        layers=len(wave.layers),
        tool_radius=wave.tool.radius,
        reach=reach,
        deepest=deepest,
        force_of=lambda depth: float(np.interp(depth, depths, forces)),
        depth_of=depth_of,
    )


def _weigh_levels(place: float, out: FloatArray) -> None:
    """Weights (LEVELS,) of the two levels that a place lies between; the level of no depth is not kept."""
    low = min(int(place), LEVELS - 1)
    out[:] = 0.0
    out[low] = place - low
    if low:
        out[low - 1] = 1.0 - (place - low)
