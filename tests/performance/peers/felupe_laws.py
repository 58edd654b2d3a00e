"""FElupe as the judge of the wave's laws: `python -m tests.performance.peers.felupe_laws [SCALE ...]`.

The shipped skin with every layer by Yeoh's or Ogden's law, under a pressure or a bonded tool, by FElupe on a mesh of
its own (Q2 with one constant pressure) and with its own laws, differentiated by tensortrax; both are optional and no
dependency of the product. A scale of 1 has elements of 0.1 mm at the tool's edge; smaller ones show what the mesh is
still worth. The wave is run as the harness does.
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

import itertools  # noqa: E402
import sys  # noqa: E402
from collections.abc import Sequence  # noqa: E402
from dataclasses import dataclass  # noqa: E402

import felupe  # noqa: E402
import numpy as np  # noqa: E402
from felupe.constitution import tensortrax  # noqa: E402

from benchmark.files import Scenario  # noqa: E402
from benchmark.models import Drive  # noqa: E402
from benchmark.models.wave_layered import layered_wave  # noqa: E402
from tests.performance.peers.felupe import direct, line, quads  # noqa: E402
from tests.performance.wave.laws import presses  # noqa: E402

MM = 1e-3
BORDER, NEAR = 60.0 * MM, 12.0 * MM
STEPS, TOLERANCE, MOST = 5, 1e-8, 40
PRESSES = {"uniform_pressure": ("force", 5.0), "rigid_bonded": ("depth", 3.0 * MM)}
"""What is given at the last step, N or m."""


def theirs(law: str, shear: float) -> tuple[object, dict[str, object]]:
    """The law of `tests.performance.wave.laws` in FElupe's words; its Ogden has 2 mu / alpha^2 for our mu / alpha."""
    models = tensortrax.models.hyperelastic
    if law.startswith("yeoh"):
        return models.yeoh, {"C10": shear / 2, "C20": shear / 2, "C30": shear / 5}
    return models.ogden, {"mu": [shear], "alpha": [10.0]}


def grid(scenario: Scenario, scale: float) -> tuple[felupe.Mesh, np.ndarray]:
    """Nine-node cells (first axis z, second r) and the layer of each."""
    edge, size = scenario.tool.radius, scale * MM
    r = np.unique(
        np.concatenate(
            [
                line(0.0, edge, 0.1 * size, 0.25, size, at_end=True),
                line(edge, NEAR, 0.1 * size, 0.25, size),
                line(NEAR, BORDER, size, 0.25, 2.5 * size),
            ]
        )
    )
    faces = np.concatenate([[0.0], np.cumsum([layer.thickness for layer in scenario.tissue.layers])])
    spacing = ((0.1, 0.1), (0.3, 0.3), (0.2, 1.2))
    parts = [
        line(top, bottom, first * size, 0.25, largest * size)
        for (top, bottom), (first, largest) in zip(itertools.pairwise(faces), spacing, strict=True)
    ]
    return quads(r, np.concatenate(parts), faces)


@dataclass(frozen=True)
class Pressed:
    """Force and depth (n,) of the steps, and at the last one deflections of the layers' top faces on the axis, m."""

    force: np.ndarray
    depth: np.ndarray
    tops: np.ndarray


class Judge:
    """The press in FElupe: one body for each layer, on one mesh, by Newton's method."""

    def __init__(self, scenario: Scenario, law: str, scale: float) -> None:
        mesh, layer = grid(scenario, scale)
        self.points, self.scenario = mesh.points, scenario
        self.fields, self.bodies = [], []
        for number, one in enumerate(scenario.tissue.layers):
            region = felupe.RegionBiQuadraticQuad(felupe.Mesh(mesh.points, mesh.cells[layer == number], "quad9"))
            field = felupe.FieldContainer([felupe.FieldAxisymmetric(region, dim=2)])
            function, constants = theirs(law, one.shear_modulus)
            solid = tensortrax.Hyperelastic(function, **constants)
            bulk = one.youngs_modulus / (3.0 * (1.0 - 2.0 * one.poisson_ratio))
            self.fields.append(field)
            self.bodies.append(felupe.SolidBodyNearlyIncompressible(solid, field, bulk=bulk))
        z, r = self.points.T
        self.under = np.isclose(z, 0.0, atol=1e-9) & (r <= scenario.tool.radius + 1e-9)
        self.held = np.stack([(z <= z.min() + 1e-9) | (r >= BORDER - 1e-9)] * 2, axis=1)
        self.held[r < 1e-12, 1] = True
        self.u = np.zeros_like(self.points)

    def run(self, contact: str, last: float) -> Pressed:
        """Press in `STEPS` steps."""
        force, depth = [], []
        if contact == "rigid_bonded":
            self.held[self.under] = True
        for value in last * np.arange(1, STEPS + 1) / STEPS:
            inner = self._equilibrium(contact, float(value))
            force.append(-inner[self.under, 0].sum() if contact == "rigid_bonded" else value)
            depth.append(self._on_axis(0.0))
        faces = np.cumsum([0.0, *(layer.thickness for layer in self.scenario.tissue.layers)])[:-1]
        return Pressed(np.array(force), np.array(depth), np.array([self._on_axis(face) for face in faces]))

    def _equilibrium(self, contact: str, value: float) -> np.ndarray:
        """Internal forces (N, 2) of the equilibrium, N."""
        pushed, target = np.zeros_like(self.u), np.zeros_like(self.u)
        if contact == "rigid_bonded":
            target[self.under, 0] = -value
        else:
            pushed[:, 0] = -value * self._pressure()
        free, fixed = ~self.held.ravel(), self.held.ravel()
        for turn in range(MOST):
            inner, stiffness = self._assembled()
            left = (pushed - inner).ravel()[free]
            if turn and np.linalg.norm(left) <= TOLERANCE * np.linalg.norm(inner):
                return inner
            step = (target - self.u).ravel()
            step[free] = direct(stiffness[free][:, free].tocsr(), left - stiffness[free][:, fixed] @ step[fixed])
            self.u = self.u + step.reshape(self.u.shape)
        raise ArithmeticError(f"FElupe finds no equilibrium at {value:g}")

    def _assembled(self) -> tuple[np.ndarray, object]:
        inner, stiffness = np.zeros(self.u.size), None
        for field, body in zip(self.fields, self.bodies, strict=True):
            field[0].values[:] = self.u
            vector = np.asarray(body.assemble.vector(field).todense()).ravel()
            inner[: vector.size] += vector
            matrix = body.assemble.matrix(field)
            stiffness = matrix if stiffness is None else stiffness + matrix
        return inner.reshape(self.u.shape), stiffness.tocsr()

    def _pressure(self) -> np.ndarray:
        """(N,) consistent nodal forces of a unit force spread evenly over the disc."""
        out, found = np.zeros(len(self.points)), np.flatnonzero(self.under)
        found = found[np.argsort(self.points[found, 1])]
        at, weight = np.polynomial.legendre.leggauss(4)
        shapes = (0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0))
        for k in range(0, found.size - 2, 2):
            first, middle, last = self.points[found[k : k + 3], 1]
            half = 0.5 * (last - first)
            for node, shape in zip(found[k : k + 3], shapes, strict=True):
                out[node] += 2.0 * np.pi * float(weight @ (shape * (middle + half * at))) * half
        return out / (np.pi * self.scenario.tool.radius**2)

    def _on_axis(self, face: float) -> float:
        z, r = self.points.T
        return float(-self.u[np.argmin(np.abs(z + face) + r), 0])


def main(scales: Sequence[float]) -> None:
    """Judge and print, Markdown."""
    print("| press | FElupe, elements at the edge, mm | unknowns | force N | depth mm | wave: force % | wave: tops % |")
    print("|---|---|---|---|---|---|---|")
    for press in presses():
        place, law = press.name.split(": ")
        contact = place.removeprefix("skin-5N, ")
        if law not in ("yeoh, c20 = mu / 2, c30 = mu / 5", "ogden, alpha = 10") or contact not in PRESSES:
            continue
        control, last = PRESSES[contact]
        load = press.scenario.load.model_copy(update={"control": control, "peak": last})
        scenario = press.scenario.model_copy(update={"load": load})
        time = np.arange(1.0, STEPS + 1.0)
        wave = layered_wave(scenario).follow(Drive(control, time, last * time / STEPS))
        for scale in scales:
            judge = Judge(scenario, law, scale)
            found = judge.run(contact, last)
            force = 100.0 * np.abs(wave.force / found.force - 1.0).max()
            tops = ", ".join(f"{100.0 * one:+.2f}" for one in wave.top_deflection[-1] / found.tops - 1.0)
            cells = [press.name, f"{0.1 * scale:g}", f"{judge.u.size}", f"{found.force[-1]:.4f}"]
            print(f"| {' | '.join([*cells, f'{found.depth[-1] / MM:.4f}', f'{force:.2f}', tops])} |", flush=True)


if __name__ == "__main__":
    main([float(one) for one in sys.argv[1:]] or [1.0, 0.6])
