"""What derivatives of a press cost beside differences, and CalculiX as their judge.

`python -m tests.performance.derivatives`. CalculiX (Debian's `calculix-ccx`) solves the same mesh with a modulus or a
thickness 3 % smaller and larger; its difference stands beside the direct derivative of the depth. Without it this part
is left out, and said so.
"""

from __future__ import annotations

import os
import shutil
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

import fem
from fem.sensitivity.changed_equations import moved_mesh
from tests.performance.peers import calculix
from tests.performance.peers.case import LAYERS, POISSON, Case
from tests.performance.peers.cases import BORDER, TOOL_RADIUS, axisymmetric_case

STEPS, REPEATS, SMALL, LARGE = 24, 3, 3e-5, 0.03
KEYS = ("modulus of layer 2", "modulus of layer 3", "thickness of layer 2", "thickness of layer 3", "tool.radius")
Problem = fem.Problem


def skin(tool: fem.Tool, support: fem.Support) -> Problem:
    """Three layers of skin."""
    layers = tuple(
        fem.Layer(f"layer {n + 1}", h, 1100.0, fem.NeoHookean(E, POISSON)) for n, (h, E) in enumerate(LAYERS)
    )
    return Problem(layers, tool, support)


def changed(problem: Problem, key: str, share: float) -> Problem:
    """The problem with one number times 1 + share."""
    if key == "tool.radius":
        return replace(problem, tool=replace(problem.tool, radius=problem.tool.radius * (1.0 + share)))
    layers, number = list(problem.layers), int(key[-1]) - 1
    layer = layers[number]
    stiffer = replace(layer.material, youngs_modulus=layer.material.youngs_modulus * (1.0 + share))
    thicker = replace(layer, thickness=layer.thickness * (1.0 + share))
    layers[number] = replace(layer, material=stiffer) if key.startswith("modulus") else thicker
    return replace(problem, layers=tuple(layers))


def changes(problem: Problem, keys: tuple[str, ...]) -> dict[str, fem.ProblemChange]:
    """Small changes by each key."""
    return {
        key: fem.ProblemChange(changed(problem, key, -SMALL), changed(problem, key, SMALL), SMALL, SMALL)
        for key in keys
    }


def cpu(work: Callable[[], object]) -> float:
    """Median of the processor time in s."""
    times = []
    for _ in range(REPEATS):
        began = time.process_time()
        work()
        times.append(time.process_time() - began)
    return statistics.median(times)


def costs() -> None:
    """Print the processor time of one press, with derivatives, and of the presses of central differences."""
    presses = {
        "bonded tool, base": skin(fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")),
        "bonded tool, hole": skin(fem.Tool(5e-3, "rigid_bonded"), fem.Support("hole", 20e-3)),
        "touching tool, base": skin(fem.Tool(5e-3, "rigid_frictionless", 1e-3), fem.Support("bonded")),
    }
    depth = np.arange(1, STEPS + 1) / STEPS
    load = fem.Load("depth", depth, 2e-3 * depth)
    print(f"CPU s, {STEPS} steps to 2 mm, {len(KEYS)} parameters, median of {REPEATS}; load {os.getloadavg()[0]:.1f}")
    for name, problem in presses.items():
        model, small = fem.prepare(problem), changes(problem, KEYS)

        def differences(told: Problem = problem) -> None:
            for key in KEYS:
                for sign in (-1.0, 1.0):
                    fem.prepare(changed(told, key, sign * LARGE)).run(load)

        press = cpu(lambda model=model: model.run(load))
        first = cpu(lambda model=model, small=small: fem.differentiate(model, load, small))
        both = cpu(lambda model=model, small=small: fem.differentiate(model, load, small, second=True))
        apart = cpu(differences)
        print(f"{name:22} {model.unknowns} unknowns: press {press:.2f}, with first {first:.2f}, second too {both:.2f},")
        times = (press + apart) / first
        print(
            f"{'':22} press and {2 * len(KEYS)} more for differences {press + apart:.2f}: {times:.1f} times the first"
        )


def calculix_depth(case: Case, stiffer: dict[int, float], folder: Path) -> float:
    """Depth in m on the axis by CalculiX, with the moduli of some layers times a factor."""
    path = folder / "case.inp"
    calculix.write_input(case, path)
    lines = path.read_text().splitlines()
    for layer, factor in stiffer.items():
        at = lines.index(f"*MATERIAL, NAME=M{layer}") + 2
        c10, compliance = (float(word) for word in lines[at].split(","))
        lines[at] = f"{c10 * factor:.15g},{compliance / factor:.15g}"
    path.write_text("\n".join(lines) + "\n")
    calculix.run(folder / "case", {**os.environ, "OMP_NUM_THREADS": "1"})
    moved = calculix.read_displacements(folder / "case.dat", len(case.nodes))
    return float(-moved[np.argmin(np.abs(case.nodes).sum(axis=1)), 1])


def judged() -> None:
    """Print direct derivatives of the depth beside CalculiX's differences on the same mesh."""
    if shutil.which("ccx") is None:
        print("calculix is not installed and left out (apt-get install calculix-ccx)")
        return
    case = axisymmetric_case(steps=10, force=1.0)
    problem = replace(
        skin(fem.Tool(TOOL_RADIUS, "uniform_pressure"), fem.Support("bonded")),
        discretisation=fem.Discretisation(radius=BORDER),
    )
    model = fem.prepare(problem)
    load = fem.Load("force", np.arange(1, 11) / 10, np.arange(1, 11) / 10)
    keys = KEYS[:4]
    found = fem.differentiate(model, load, changes(problem, keys))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        told = calculix_depth(case, {}, folder)
        print(f"depth at 1 N: ours {1e3 * found.solution.depth[-1]:.4f} mm, CalculiX {1e3 * told:.4f} mm")
        for key in keys:
            sides = []
            for sign in (-1.0, 1.0):
                layer, share = int(key[-1]) - 1, sign * LARGE
                if key.startswith("modulus"):
                    sides.append(calculix_depth(case, {layer: 1.0 + share}, folder))
                else:
                    moved = moved_mesh(model.mesh, problem, changed(problem, key, share))
                    sides.append(calculix_depth(replace(case, nodes=moved.nodes), {}, folder))
            theirs, ours = (sides[1] - sides[0]) / (2.0 * LARGE), float(found.by[key].depth[-1])
            apart = 100.0 * (ours / theirs - 1.0)
            print(f"{key:22} ours {1e3 * ours:+.5f} mm, CalculiX {1e3 * theirs:+.5f} mm, {apart:+.2f} %")


if __name__ == "__main__":
    costs()
    judged()
