"""What else a user would pick for a frame: a dense FEM compliance, a mass-spring grid, regularised Kelvinlets.

Each is made for (P, P) vertices, returns a frame (layers, P, P) in m under a force in N, and works in memory made
beforehand. The last two are fitted to the peak of the finite elements, for they have no layers of their own.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import diags_array, eye_array, kron
from scipy.sparse.linalg import spsolve

from tests.performance.wave.job import DENSITY, LAYERS, POISSON_RATIO, RADIUS, Reference, reference

Frame = Callable[[float], np.ndarray]
MOST_BYTES = 1e9


def dense_compliance(x: np.ndarray, whole: bool) -> Frame:
    """Deflection of every vertex per load on every vertex, from finite elements of a disc as large as a cell.

    `whole`: the load may be on any vertex; else only on those under the tool, which then cannot move.
    """
    cell = float(np.diff(x[:2])[0])
    small = reference(cell / np.sqrt(np.pi))
    near = np.hypot(x[:, None], x) <= RADIUS
    place = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    loaded = np.ones(near.size, dtype=bool) if whole else near.ravel()
    distance = np.hypot(*(place[:, None] - place[loaded]).transpose(2, 0, 1))
    table = small.at(distance).reshape(-1, int(loaded.sum()))
    share = (near.ravel() / near.sum())[loaded]
    load, out = np.empty(share.size), np.empty(table.shape[0])

    def frame(force: float) -> np.ndarray:
        np.multiply(share, force, out=load)
        np.dot(table, load, out=out)
        return out.reshape(-1, x.size, x.size)

    return frame


def fits_in_memory(count: int, whole: bool) -> bool:
    """Whether the dense compliance of a square of vertices does."""
    loads = count**2 if whole else np.pi / 64.0 * count**2
    return 8.0 * len(LAYERS) * count**2 * loads < MOST_BYTES


class MassSpring:
    """One mass a vertex, springs to its four neighbours and to the base, one semi-implicit Euler step a frame.

    Surface tension G h summed over the layers, base spring M / h of the layers in a row, scaled together to the FEM's
    peak. The step is half of the longest stable one; the error is that of the grid at rest.
    """

    def __init__(self, x: np.ndarray, exact: Reference) -> None:
        cell = float(np.diff(x[:2])[0])
        shear = [e / (2.0 * (1.0 + POISSON_RATIO)) for _, _, e in LAYERS]
        tension = sum(g * h for g, (_, h, _) in zip(shear, LAYERS, strict=True))
        confined = [g * (2.0 - 2.0 * POISSON_RATIO) / (1.0 - 2.0 * POISSON_RATIO) for g in shear]
        base = 1.0 / sum(h / m for m, (_, h, _) in zip(confined, LAYERS, strict=True))
        near = np.hypot(x[:, None], x) <= RADIUS
        self._load = near / near.sum() / cell**2
        self._link, self._base = tension / cell**2, base
        self._at_rest = self._rest()
        scale = float(exact.deflection[0, 0]) / float(self._at_rest.max())
        self._at_rest *= scale
        self._load *= scale
        mass = DENSITY * sum(h for _, h, _ in LAYERS)
        self._dt = 1.0 / np.sqrt((8.0 * self._link + base) / mass)
        self._drag, self._kick = 2.0 * np.sqrt(base * mass), self._dt / mass
        self._w, self._v, self._pull, self._part = (np.zeros((x.size, x.size)) for _ in range(4))

    def _rest(self) -> np.ndarray:
        """(P, P) per newton, border held."""
        count = len(self._load)
        line = diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(count - 2, count - 2))
        one = eye_array(count - 2)
        matrix = self._link * (kron(line, one) + kron(one, line)) + self._base * kron(one, one)
        out = np.zeros((count, count))
        out[1:-1, 1:-1] = spsolve(matrix.tocsc(), self._load[1:-1, 1:-1].ravel()).reshape(count - 2, -1)
        return out

    def at_rest(self, force: float) -> np.ndarray:
        """(1, P, P) in the end."""
        return force * self._at_rest[None]

    def frame(self, force: float) -> np.ndarray:
        """(1, P, P) after one step."""
        w, v, pull, part = self._w, self._v, self._pull, self._part
        np.multiply(self._load, force, out=pull)
        np.multiply(w, self._base + 4.0 * self._link, out=part)
        pull -= part
        np.multiply(w, self._link, out=part)
        pull[1:] += part[:-1]
        pull[:-1] += part[1:]
        pull[:, 1:] += part[:, :-1]
        pull[:, :-1] += part[:, 1:]
        np.multiply(v, self._drag, out=part)
        pull -= part
        pull *= self._kick
        v += pull
        v[0] = v[-1] = v[:, 0] = v[:, -1] = 0.0
        np.multiply(v, self._dt, out=part)
        w += part
        return w[None]


def kelvinlet(x: np.ndarray, exact: Reference) -> Frame:
    """Regularised Kelvinlet of a push downwards at the surface, at the depth of each layer's top face.

    u = F [(a - b) / s + b z^2 / s^3 + a e^2 / (2 s^3)], s^2 = r^2 + z^2 + e^2, a = 1 / (4 pi mu), b = a / (4 - 4 nu)
    (de Goes and James 2017, ACM Transactions on Graphics 36:40, eq. 6); e is the tool's radius, mu fitted to the peak.
    """
    square = x[:, None] ** 2 + x**2
    depth = np.cumsum([0.0, *(h for _, h, _ in LAYERS[:-1])])[:, None, None]
    b = 1.0 / (4.0 - 4.0 * POISSON_RATIO)
    s, out = np.empty((len(LAYERS), x.size, x.size)), np.empty((len(LAYERS), x.size, x.size))
    modulus = [1.0]

    def frame(force: float) -> np.ndarray:
        np.add(square, depth**2 + RADIUS**2, out=s)
        np.sqrt(s, out=s)
        np.power(s, -3.0, out=out)
        np.multiply(out, b * depth**2 + 0.5 * RADIUS**2, out=out)
        np.divide(1.0 - b, s, out=s)
        np.add(out, s, out=out)
        np.multiply(out, force / (4.0 * np.pi * modulus[0]), out=out)
        return out

    modulus[0] = float(frame(1.0)[0].max()) / float(exact.deflection[0, 0])
    return frame
