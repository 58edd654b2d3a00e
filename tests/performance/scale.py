"""How time and memory of a three-dimensional press grow with the mesh: `python -m tests.performance.scale`.

A quarter block of three layers (0.1, 1.5 and 8 mm of 1 MPa, 100 kPa and 10 kPa, Poisson's ratio 0.49) under a bonded
tool, on meshes that are finer in all directions alike, each in a process of its own: small strain, or with `--steps`
so many steps of finite strain. With `--out` the table is written as CSV.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import fem
from fem.assembly.solid import SOLID_ELEMENTS
from fem.mesh.grading import Feature, Sizing, graded_line
from fem.mesh.solid import DiscGrid, SolidMesh, build_block

ROOT = Path(__file__).parents[2]
DENSITIES = {"20k": 1.36, "60k": 2.05, "100k": 2.5, "200k": 3.2, "300k": 3.7, "1M": 5.2}
"""Number of elements along a length, over that of about 8 000 unknowns."""
LAYERS = ((1.0e-4, 1.0e6), (1.5e-3, 1.0e5), (8.0e-3, 1.0e4))  # thickness in m, Young's modulus in Pa
POISSON = 0.49
TOOL, BORDER = 5.0e-3, 30.0e-3
FORCE = 0.5  # N, of the last step in finite strain: about 1 mm
FIELDS = ("unknowns", "solver", "newton", "iterations", "wall_s", "cpu_s", "memory_GB", "depth_mm")


def problem(finite: bool) -> fem.Problem:
    """The press."""
    law: type = fem.NeoHookean if finite else fem.LinearElastic
    layers = tuple(fem.Layer(f"layer {n}", h, 1000.0, law(E, POISSON)) for n, (h, E) in enumerate(LAYERS))
    kinematics = "finite" if finite else "linear"
    space = fem.Discretisation(radius=BORDER)
    return fem.Problem(
        layers, fem.Tool(TOOL, "rigid_bonded"), fem.Support("bonded"), kinematics, space, geometry="block"
    )


def mesh(density: float) -> SolidMesh:
    """Quarter block of 27-node hexahedra, finer at the tool's edge."""
    depths = np.concatenate(([0.0], np.cumsum([thickness for thickness, _ in LAYERS])))
    size, inner = 0.04 * TOOL, 0.45 * TOOL
    line = graded_line((inner, TOOL, BORDER), Sizing((Feature(TOOL, size, 0.7),)), density)
    rings = line[(line == inner) | (line >= 1.4 * inner)]
    grid = DiscGrid(rings, max(2, round(2 * density)), 1, 0.0, TOOL, BORDER, TOOL)
    lines = graded_line(tuple(depths), Sizing((Feature(0.0, size, 0.7),)), density)
    return build_block(grid, lines, depths[:-1], SOLID_ELEMENTS["hex27"].node_places, "hex27")


def measure(density: float, solver: str, steps: int) -> dict[str, object]:
    """One press."""
    from fem.setup.building import solid_model

    start, iterations, newton = time.perf_counter(), [], []
    model = solid_model(problem(steps > 0), mesh(density), solver, ())
    share = np.arange(1, max(steps, 1) + 1) / max(steps, 1)

    def note(report: fem.StepReport) -> None:
        newton.append(report.newton_iterations)
        iterations.append(getattr(model.equilibrium.solver, "iterations", 0))

    found = model.run(fem.Load("force", share, FORCE * share), on_step=note)
    used = resource.getrusage(resource.RUSAGE_SELF)
    values = (
        *(model.unknowns, model.linear_solver, sum(newton), max(iterations), time.perf_counter() - start),
        *(used.ru_utime + used.ru_stime, used.ru_maxrss / 1e6, 1e3 * float(found.depth[-1])),
    )
    return dict(zip(FIELDS, values, strict=True))


def main() -> None:
    """Measure all sizes in turn and print a table with the exponent of growth."""
    parser = argparse.ArgumentParser(prog="python -m tests.performance.scale", description=__doc__)
    parser.add_argument("--sizes", nargs="*", choices=list(DENSITIES), default=list(DENSITIES))
    parser.add_argument("--solvers", nargs="*", default=["auto"])
    parser.add_argument("--steps", type=int, default=0, help="of finite strain; 0: small strain")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--out", type=Path, help="CSV file")
    parser.add_argument("--one", nargs=3, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        density, solver, steps = arguments.one
        print(json.dumps(measure(float(density), solver, int(steps))))
        return
    print(f"{arguments.threads} threads, load {os.getloadavg()[0]:.1f} at the start", "\t".join(FIELDS), sep="\n")
    rows = []
    for solver in arguments.solvers:
        for size in arguments.sizes:
            rows.append(_in_a_process(DENSITIES[size], solver, arguments.steps, arguments.threads))
            print("\t".join(f"{value:.4g}" if isinstance(value, float) else str(value) for value in rows[-1].values()))
        _print_growth(rows[-len(arguments.sizes) :])
    if arguments.out is not None:
        with arguments.out.open("w", newline="") as file:
            table = csv.DictWriter(file, FIELDS)
            table.writeheader()
            table.writerows(rows)


def _in_a_process(density: float, solver: str, steps: int, threads: int) -> dict[str, object]:
    environment = {**os.environ, **dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS"), str(threads))}
    command = [sys.executable, "-m", "tests.performance.scale", "--one", str(density), solver, str(steps)]
    done = subprocess.run(command, check=True, cwd=ROOT, env=environment, capture_output=True, text=True)
    row: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return row


def _print_growth(rows: list[dict[str, object]]) -> None:
    if len(rows) < 2:
        return
    sizes = np.log([float(str(row["unknowns"])) for row in rows])
    for name in ("wall_s", "cpu_s", "memory_GB"):
        values = np.log([float(str(row[name])) for row in rows])
        ends = (values[-1] - values[0]) / (sizes[-1] - sizes[0])
        print(f"growth of {name} from the smallest to the largest, exponent: {ends:.2f}")


if __name__ == "__main__":
    main()
