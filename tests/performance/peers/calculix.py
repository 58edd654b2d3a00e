"""Input files for CalculiX, and what it prints: C3D20R for the linear case, CAX8R for the hyperelastic one."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from tests.performance.peers.case import LAYERS, POISSON, Case

# CalculiX wants an axisymmetric model's axis along y, and forces of the whole circumference.
QUAD8 = [0, 1, 2, 3, 4, 5, 6, 7]


def write_input(case: Case, path: Path) -> None:
    """Input file of a case."""
    linear = case.kind == "linear"
    order = case.vtk_order if linear else np.array(QUAD8)
    elements = case.elements[order].T + 1
    used = np.unique(elements) - 1
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{n + 1}," + ",".join(f"{x:.12g}" for x in case.nodes[n]) for n in used]
    for layer in range(len(LAYERS)):
        lines.append(f"*ELEMENT, TYPE={'C3D20R' if linear else 'CAX8R'}, ELSET=L{layer}")
        for e in np.flatnonzero(case.layer == layer):
            nodes = [str(n) for n in elements[e]]
            lines += (
                [str(e + 1) + "," + ",".join(nodes[:10]) + ",", ",".join(nodes[10:])]
                if linear
                else [str(e + 1) + "," + ",".join(nodes)]
            )
        lines += _material(layer, linear)
    lines.append("*BOUNDARY")
    is_used = np.isin(np.arange(len(case.nodes)), used)
    for axis, mask in enumerate(case.fixed):
        lines += [f"{n + 1},{axis + 1},{axis + 1}" for n in np.flatnonzero(mask & is_used)]
    lines += _step(case, linear)
    path.write_text("\n".join(lines) + "\n")


def _material(layer: int, linear: bool) -> list[str]:
    E = LAYERS[layer][1]
    shear, bulk = E / (2 * (1 + POISSON)), E / (3 * (1 - 2 * POISSON))
    law = (
        ["*ELASTIC", f"{E:.12g},{POISSON}"]
        if linear
        else ["*HYPERELASTIC, NEO HOOKE", f"{0.5 * shear:.12g},{2.0 / bulk:.12g}"]
    )
    return [f"*MATERIAL, NAME=M{layer}", *law, f"*SOLID SECTION, ELSET=L{layer}, MATERIAL=M{layer}"]


def _step(case: Case, linear: bool) -> list[str]:
    axis = len(case.fixed)
    static = ["*STEP", "*STATIC, SOLVER=SPOOLES"]
    if not linear:
        static = [f"*STEP, NLGEOM, INC={case.steps + 10}", "*STATIC, DIRECT", f"{1.0 / case.steps:.12g},1."]
    loads = [f"{n + 1},{axis},{case.load[n]:.12g}" for n in np.flatnonzero(case.load)]
    frequency = "" if linear else f", FREQUENCY={case.steps}"
    return [*static, "*CLOAD", *loads, f"*NODE PRINT, NSET=ALL{frequency}", "U", "*END STEP"]


def run(path: Path, environment: Mapping[str, str]) -> str:
    """Run CalculiX on an input file (given without suffix) in an environment; what it printed."""
    done = subprocess.run(
        ["ccx", path.name],
        cwd=path.parent,
        capture_output=True,
        text=True,
        check=True,
        env=dict(environment),
    )
    return done.stdout


def total_seconds(output: str) -> float:
    """The time CalculiX tells, without the start of its process; NaN if it tells none."""
    for line in output.splitlines():
        if line.startswith("Total CalculiX Time:"):
            return float(line.split(":")[1])
    return math.nan


def read_displacements(path: Path, count: int) -> np.ndarray:
    """Last printed displacements (N, 3) in m of a .dat file; NaN at nodes that are not there."""
    out = np.full((count, 3), np.nan)
    for line in path.read_text().splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            out[int(words[0]) - 1] = [float(word) for word in words[1:]]
    return out
