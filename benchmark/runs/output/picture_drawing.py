"""The drawing itself: `python -P picture_drawing.py IN.vtu OUT.png X Y REACH` (m).

The body is shown deformed, without magnification, coloured by the deflection. An axisymmetric section is turned to
three quarters of a round body; plane layers are shown up to REACH from the tool's axis, a body from a surface file is
cut open at it. Lines part the layers.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

MM = 1e3
SIZE = (1100, 700)
TURN, STEPS = 270.0, 72
COLOURS = "YlGnBu"
LINE = "black"
SHADES = 12


def draw(source: str, target: str, axis: tuple[float, float], reach: float) -> None:
    """Draw a VTU file with `displacement_m` and `layer`."""
    import pyvista

    grid: Any = pyvista.read(source)
    flat = float(np.ptp(grid.points[:, 1])) == 0.0
    body = _cut(grid, axis, reach)
    body.point_data["deflection, mm"] = -MM * body.point_data["displacement_m"][:, 2]
    body.points = MM * (body.points + body.point_data["displacement_m"])
    parts = [body.threshold((k, k), scalars="layer") for k in np.unique(body.cell_data["layer"])]
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.set_background("white")
    values = body.point_data["deflection, mm"]
    for part in parts:
        face, lines = (_turned if flat else _outside)(part)
        plotter.add_mesh(
            face,
            scalars="deflection, mm",
            cmap=COLOURS,
            clim=(float(values.min()), float(values.max())),
            n_colors=SHADES,
            smooth_shading=False,
            ambient=0.35,
            scalar_bar_args={
                "color": LINE,
                "fmt": "%.2f",
                "width": 0.5,
                "position_x": 0.25,
                "position_y": 0.02,
                "n_labels": 4,
            },
        )
        plotter.add_mesh(lines, color=LINE, line_width=2.0, render_lines_as_tubes=True)
    plotter.camera_position = [(1.0, -1.35, 0.75), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    plotter.reset_camera()
    plotter.screenshot(target)
    plotter.close()


def _cut(grid: Any, axis: tuple[float, float], reach: float) -> Any:
    """What is shown of the body: near the tool, or behind it where the body is not made of plane layers."""
    import pyvista

    centre = grid.cell_centers().points - [*axis, 0.0]
    if pyvista.CellType.QUADRATIC_TETRA in grid.celltypes:
        return grid.extract_cells(centre[:, 1] >= 0.0)
    near = np.hypot(centre[:, 0], centre[:, 1]) <= reach
    deep = grid.points[:, 2].min() < -2.0 * reach
    return grid.extract_cells(near & (centre[:, 2] >= -reach) if deep else near)


def _outside(part: Any) -> tuple[Any, Any]:
    """The outside of a part and its edges."""
    face = part.extract_surface(algorithm="dataset_surface")
    return face, face.extract_feature_edges(50.0, manifold_edges=False)


def _turned(section: Any) -> tuple[Any, Any]:
    """The outside of the body that a part of a section describes when it is turned about the axis, and its edges."""
    face = section.extract_surface(algorithm="dataset_surface")
    border = face.extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    skin = border.extrude_rotate(angle=TURN, resolution=STEPS, capping=False)
    turns = (0.0, TURN)
    whole = skin.merge([face.rotate_z(angle) for angle in turns])
    return whole, border.rotate_z(turns[0]).merge(border.rotate_z(turns[1]))


def main(words: list[str]) -> None:
    """Draw what the command line asks for."""
    source, target, x, y, reach = words
    draw(source, target, (float(x), float(y)), float(reach))


if __name__ == "__main__":
    main(sys.argv[1:])
