"""A synthetic liver-shaped body from its STL file to a pressed VTU: `python -m tests.performance.liver FOLDER`.

The shape is made here from a sphere (it is nobody's liver): a thick right lobe, a thin left one, a hollow
underside. Three layers count inwards from its surface: capsule, outer and inner tissue.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import numpy as np
import pyvista

import fem
from fem.analysis.prepared import Model

LAYERS = (("capsule", 2.5e-3, 20e3), ("outer", 10e-3, 6e3), ("inner", 50e-3, 4e3))
TOOL = fem.Tool(10e-3, "uniform_pressure", position=(-0.03, 0.0))
FORCE = 1.0


def write_shape(path: Path) -> None:
    """Write the synthetic surface, in mm."""
    sphere = pyvista.Icosphere(radius=1.0, nsub=4)
    x, y, z = np.asarray(sphere.points, dtype=np.float64).T
    lobe = 0.5 * (1.0 - np.tanh(1.5 * x))  # 1 in the right lobe, 0 in the left one
    height = 24.0 + 26.0 * lobe
    hollow = 9.0 * np.exp(-(x**2 + y**2) / 0.3) * (z < 0) * np.abs(z)
    sphere.points = np.stack((95.0 * x, (45.0 + 20.0 * lobe) * y, height * z + hollow), axis=1)
    sphere.save(path)


def prepare(path: Path) -> Model:
    """Mesh the body in the file."""
    layers = tuple(fem.Layer(name, h, 1060.0, fem.NeoHookean(E, 0.48)) for name, h, E in LAYERS)
    return fem.prepare(
        fem.Problem(layers, TOOL, fem.Support("bonded"), geometry="surface", surface=fem.read_surface(path, "mm"))
    )


def press(model: Model) -> fem.Solution:
    """Press it in two steps."""
    return model.run(fem.Load("force", np.array([0.5, 1.0]), np.array([0.5, 1.0]) * FORCE))


def write_fields(path: Path, solution: fem.Solution) -> None:
    """Write the last step as VTU."""
    fields = solution.fields(-1)
    cells = np.insert(fields.cells, 0, fields.cells.shape[1], axis=1)
    grid = pyvista.UnstructuredGrid(cells.ravel(), np.full(len(cells), fields.cell_type), fields.points)
    grid.point_data["displacement_m"] = fields.displacement
    grid.cell_data["layer"] = fields.layer
    grid.cell_data["det_F"] = fields.det_F
    grid.cell_data["cauchy_stress_Pa"] = fields.cauchy_stress.reshape(-1, 9)
    grid.save(path)


def main(folder: Path) -> None:
    """From the surface to the fields, with times."""
    watch = [_now()]
    folder.mkdir(parents=True, exist_ok=True)
    write_shape(folder / "liver_synthetic.stl")
    model = prepare(folder / "liver_synthetic.stl")
    watch.append(_now())
    solution = press(model)
    watch.append(_now())
    if not solution.complete:
        raise SystemExit(str(solution.failure))
    write_fields(folder / "liver_synthetic.vtu", solution)
    watch.append(_now())
    print(model.mesh.quality)
    print(f"{model.unknowns} unknowns, depth {1e3 * solution.depth[-1]:.3f} mm at {solution.force[-1]:g} N")
    print(*solution.warnings, sep="\n", end="\n" if solution.warnings else "")
    for name, before, after in zip(("mesh", "press", "write"), watch, watch[1:], strict=False):
        print(f"{name}: {_between(before, after)}")
    print(f"from STL to VTU: {_between(watch[0], watch[-1])}")


def _now() -> tuple[float, float]:
    """Time by the clock and of the processor in s, the mesher's process included."""
    return time.perf_counter(), sum(os.times()[:4])


def _between(start: tuple[float, float], end: tuple[float, float]) -> str:
    return f"{end[0] - start[0]:.1f} s, of which the processor worked {end[1] - start[1]:.1f} s"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
