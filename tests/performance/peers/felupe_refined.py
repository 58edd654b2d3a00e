"""FElupe as the judge of our mesh: `python -m tests.performance.peers.felupe_refined [--presses NAME ...]`.

Neo-Hookean layers by nine-node quadrilaterals on a mesh of its own, graded to the edge of the tool and of the hole. By
displacement alone the force is too large and comes down as elements get smaller; with one pressure an element it comes
up in small presses (in deep ones under a sharp edge that element folds and says nothing). A tool that slides is a
profile which a penalty keeps out of the nodes of the upper face. Scale 2 has elements half as large as scale 1.
"""

from __future__ import annotations

import argparse
import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import felupe
import numpy as np
from scipy.sparse import csr_matrix

import fem
from tests.performance.peers.felupe import direct, line, quads

MM = 1e-3
REACH = 6.0  # decay lengths of the stack that the mesh goes on outside the tool or the hole
SMALL = 0.1  # depth over the tool's radius up to which elements with one pressure are asked
PENALTY = 2e6  # of the first layer's modulus, per m
STEPS, SHORTEST, TURNS, TOLERANCE = 8, 1.0 / 1024.0, 25, 1e-7


@dataclass(frozen=True)
class Press:
    """Layers (thickness in m, modulus in Pa), ratio, tool and hole in m; no edge: it sticks; no hole: a rigid base.

    The clamp of a hole is the plate outside it, or its rim, at which the sheet ends.
    """

    layers: tuple[tuple[float, float], ...]
    poisson_ratio: float
    radius: float
    depth: float
    edge: float | None = None
    hole: float | None = None
    clamp: str = "plate"

    @property
    def decay(self) -> float:
        """Length in m over which a pull in the stack goes back to nothing (shear lag)."""
        total, pull = sum(h for h, _ in self.layers), sum(h * modulus for h, modulus in self.layers)
        return math.sqrt(total * pull / min(modulus for _, modulus in self.layers))

    def ours(self, mesh: str) -> float:
        """Force in N by the finite elements of this repository on a mesh of theirs."""
        layers = tuple(
            fem.Layer(f"layer {number}", h, 1000.0, fem.NeoHookean(modulus, self.poisson_ratio))
            for number, (h, modulus) in enumerate(self.layers)
        )
        tool = fem.Tool(self.radius, "rigid_bonded" if self.edge is None else "rigid_frictionless", self.edge)
        support = fem.Support("bonded") if self.hole is None else fem.Support("hole", self.hole, clamp=self.clamp)
        problem = fem.Problem(layers, tool, support, discretisation=fem.Discretisation(mesh))
        share = np.arange(1, 21) / 20.0
        return float(fem.prepare(problem).run(fem.Load("depth", share, self.depth * share)).force[-1])


SHEET, STIFF_ON_SOFT = ((4.5 * MM, 180e3),), ((1.0 * MM, 1e6), (5.0 * MM, 1e4))
SKIN = ((1.5 * MM, 150e3), (3.0 * MM, 60e3), (10.0 * MM, 25e3))
PRESSES = {
    "sheet, small": Press(SHEET, 0.49, 6 * MM, 0.3 * MM, hole=25 * MM),
    "sheet": Press(SHEET, 0.49, 6 * MM, 2.5 * MM, hole=25 * MM),
    "sheet, slides": Press(SHEET, 0.49, 6 * MM, 3.0 * MM, 1 * MM, 25 * MM),
    "sheet, sphere": Press(SHEET, 0.49, 6 * MM, 3.0 * MM, 6 * MM, 25 * MM),
    "rim, small": Press(SHEET, 0.49, 6 * MM, 0.3 * MM, hole=25 * MM, clamp="rim"),
    "rim": Press(SHEET, 0.49, 6 * MM, 2.5 * MM, hole=25 * MM, clamp="rim"),
    "rim, slides": Press(SHEET, 0.49, 6 * MM, 3.0 * MM, 1 * MM, 25 * MM, "rim"),
    "rim, three layers, sphere": Press((*SKIN[:2], (2 * MM, 25e3)), 0.48, 6 * MM, 3.0 * MM, 6 * MM, 20 * MM, "rim"),
    "base, sphere": Press(((12 * MM, 40e3),), 0.48, 6 * MM, 3.0 * MM, 6 * MM),
    "skin": Press(SKIN, 0.48, 5 * MM, 2.5 * MM),
    "stiff on soft": Press(STIFF_ON_SOFT, 0.48, 5 * MM, 3.0 * MM, hole=15 * MM),
}


def lines(press: Press, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Places of grid lines over the radius and the depth, m."""
    size, edge = MM / scale, press.radius
    near = edge if press.edge is None else 1.1 * edge
    r = [line(0.0, edge, 0.15 * size, 0.2, 0.5 * size, at_end=True)]
    if near > edge:
        r.append(line(edge, near, 0.15 * size, 0.2, 0.5 * size))
    if press.hole is None:
        r.append(line(near, near + REACH * press.decay, 0.15 * size, 0.2, 2.0 * size))
    else:
        middle, hole = 0.5 * (near + press.hole), press.hole
        r.append(line(near, middle, 0.15 * size, 0.22, 0.9 * size))
        r.append(line(middle, hole, 0.1 * size, 0.25, 0.9 * size, at_end=True))
        if press.clamp == "plate":
            r.append(line(hole, hole + REACH * press.decay, 0.1 * size, 0.3, 1.5 * size))
    faces = np.concatenate([[0.0], np.cumsum([h for h, _ in press.layers])])
    ends = [0.15, *[0.3] * (len(press.layers) - 1), 0.4 if press.hole is None else 0.15]
    z = []
    for (top, bottom), (above, below) in zip(itertools.pairwise(faces), itertools.pairwise(ends), strict=True):
        z.append(line(top, 0.5 * (top + bottom), above * size, 0.25, 0.5 * size))
        z.append(line(0.5 * (top + bottom), bottom, below * size, 0.25, 0.5 * size, at_end=True))
    return np.unique(np.round(np.concatenate(r), 12)), np.concatenate(z)


def _body(press: Press, mesh: felupe.Mesh, number: int, cells: np.ndarray, *, pressure: bool) -> felupe.SolidBody:
    """The cells (E,) of one layer, by displacement alone or with one pressure each."""
    modulus, ratio = press.layers[number][1], press.poisson_ratio
    shear, bulk = modulus / (2.0 * (1.0 + ratio)), modulus / (3.0 * (1.0 - 2.0 * ratio))
    region = felupe.RegionBiQuadraticQuad(felupe.Mesh(mesh.points, cells, "quad9"))
    field = felupe.FieldContainer([felupe.FieldAxisymmetric(region, dim=2)])
    if pressure:
        return felupe.SolidBodyNearlyIncompressible(felupe.NeoHooke(mu=shear), field, bulk=bulk)
    return felupe.SolidBody(felupe.NeoHooke(mu=shear, bulk=bulk), field)


class Judge:
    """A press in FElupe, by displacement alone or with one pressure an element, by Newton's method."""

    def __init__(self, press: Press, scale: float, *, pressure: bool = False) -> None:
        r, z = lines(press, scale)
        mesh, layer = quads(r, z, np.concatenate([[0.0], np.cumsum([h for h, _ in press.layers])]))
        self.bodies = [
            _body(press, mesh, number, mesh.cells[layer == number], pressure=pressure)
            for number in range(len(press.layers))
        ]
        self.press, self.points, self.lines = press, mesh.points, r

    @cached_property
    def under(self) -> np.ndarray:
        """Nodes (N,) of the upper face under the tool."""
        z, r = self.points.T
        return np.isclose(z, 0.0, atol=1e-12) & (r <= self.press.radius + 1e-9)

    @cached_property
    def held(self) -> np.ndarray:
        """Components (N, 2) that are given."""
        z, r = self.points.T
        low, end = z <= z.min() + 1e-9, r >= r.max() - 1e-9
        if self.press.clamp == "rim":
            fixed = end
        else:
            fixed = low | end if self.press.hole is None else low & (r >= self.press.hole - 1e-9)
        held = np.stack([fixed] * 2, axis=1)
        held[r < 1e-12, 1] = True
        if self.press.edge is None:
            held[self.under] = True
        return held

    def force(self) -> float:
        """Force in N at the press's depth.

        Raises
        ------
        ArithmeticError
            If no equilibrium is found on the way.
        """
        u, before, depth, earlier = np.zeros_like(self.points), None, 0.0, 0.0
        step, found = self.press.depth / STEPS, 0.0
        while depth < self.press.depth * (1.0 - 1e-9):
            ahead = min(depth + step, self.press.depth)
            guess = u if before is None else u + (u - before) * (ahead - depth) / (depth - earlier)
            solved = self._equilibrium(guess, ahead) or self._equilibrium(u, ahead)
            if solved is None:
                step *= 0.5
                if step < SHORTEST * self.press.depth / STEPS:
                    raise ArithmeticError(f"FElupe finds no equilibrium beyond {depth / MM:.3g} mm")
                continue
            before, earlier, depth, (u, found) = u, depth, ahead, solved
        return found

    def _equilibrium(self, start: np.ndarray, depth: float) -> tuple[np.ndarray, float] | None:
        """Displacements (N, 2) in m and force in N; None where Newton's method fails."""
        u, sticks, free = start.copy(), self.press.edge is None, ~self.held.ravel()
        for turn in range(TURNS):
            inner, stiffness = self._assembled(u)
            push, contact, force = (np.zeros(u.size), 0.0, 0.0) if sticks else self._touch(u, depth)
            left = -(inner + push)[free]
            if not np.isfinite(left).all():
                return None
            if turn and np.linalg.norm(left) <= TOLERANCE * np.linalg.norm(inner if sticks else push):
                return u, float(-inner.reshape(u.shape)[self.under, 0].sum() if sticks else force)
            target = u.copy()
            if sticks:
                target[self.under, 0] = -depth
            step, whole = (target - u).ravel(), (stiffness if sticks else stiffness + contact)[free]
            step[free] = direct(whole[:, free].tocsr(), left - whole[:, ~free] @ step[~free])
            u = u + step.reshape(u.shape)
        return None

    def _assembled(self, u: np.ndarray) -> tuple[np.ndarray, csr_matrix]:
        """Internal forces (2 N,) and their derivative."""
        inner, stiffness = np.zeros(u.size), csr_matrix((u.size, u.size))
        with np.errstate(all="ignore"):
            for body in self.bodies:
                body.field[0].values[:] = u
                inner += np.asarray(body.assemble.vector(body.field).todense()).ravel()
                stiffness = stiffness + body.assemble.matrix(body.field)
        return inner, stiffness.tocsr()

    def _touch(self, u: np.ndarray, depth: float) -> tuple[np.ndarray, csr_matrix, float]:
        """Forces (2 N,) in N of the profile on the nodes, their derivative, and the force on the tool.

        A node at radius r may not be above p(r) - depth; the potential is k g^2 / 2 of what it is, and k goes with the
        node's share of the face (Simpson's rule).
        """
        edge, radius, width = float(self.press.edge or 0.0), self.press.radius, np.diff(self.lines)
        top = np.flatnonzero(np.isclose(self.points[:, 0], 0.0, atol=1e-12))
        share = np.zeros(top.size)
        share[:-1:2] += width / 6.0
        share[2::2] += width / 6.0
        share[1::2] += 4.0 * width / 6.0
        r = self.points[top, 1] + u[top, 1]
        beyond = np.clip(r - (radius - edge), 0.0, edge * (1.0 - 1e-6))
        root = np.sqrt(edge**2 - beyond**2)
        slope, bend = beyond / root, np.where(beyond > 0.0, edge**2 / root**3, 0.0)
        gap = u[top, 0] - (edge - root - depth)
        k = PENALTY * self.press.layers[0][1] * share * 2.0 * np.pi * self.points[top, 1] * ((gap > 0.0) & (r < radius))
        force = np.zeros(u.size)
        force[2 * top], force[2 * top + 1] = k * gap, -k * gap * slope
        down, out = 2 * top, 2 * top + 1
        places = np.concatenate([down, down, out, out]), np.concatenate([down, out, down, out])
        entries = np.concatenate([k, -k * slope, -k * slope, k * (slope**2 - gap * bend)])
        derivative = csr_matrix((entries, places), shape=(u.size, u.size))
        return force, derivative, float((k * gap).sum())


def main() -> None:
    """Judge and print, Markdown."""
    parser = argparse.ArgumentParser(prog="python -m tests.performance.peers.felupe_refined", description=__doc__)
    parser.add_argument("--presses", nargs="*", choices=list(PRESSES), default=list(PRESSES))
    parser.add_argument("--scales", nargs="*", type=float, default=[1.0, 2.0])
    arguments = parser.parse_args()
    print("| press | depth mm | FElupe: unknowns, N | with one pressure an element, N | ours: default, fine, N |")
    print("|---|---|---|---|---|")
    for name in arguments.presses:
        press, above, below = PRESSES[name], [], []
        for scale in arguments.scales:
            judge = Judge(press, scale)
            above.append(f"{judge.points.size} {judge.force():.5g}")
            if press.edge is None and press.depth < SMALL * press.radius:
                below.append(f"{Judge(press, scale, pressure=True).force():.5g}")
        ours = ", ".join(f"{press.ours(mesh):.5g}" for mesh in ("default", "fine"))
        print(f"| {name} | {press.depth / MM:g} | {', '.join(above)} | {', '.join(below)} | {ours} |", flush=True)


if __name__ == "__main__":
    main()
