"""A press by quadratic triangles with a linear pressure in each stratum, for the second family of blind worlds.

Shares nothing with the package `fem`: other elements (Taylor and Hood, Computers and Fluids 1 (1973) 73: six nodes for
the displacement, three for the pressure), other laws (Gent, Yeoh), Newton's method by itself on displacement and
pressure together. Energy of an axisymmetric body, f = (F_rr, F_rz, F_zr, F_zz, F_tt), x = J^(-2/3) tr C - 3:
W = psi(x) + p (J - 1) - p^2 / (2 K).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import skfem
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from benchmark.blind.motion import Array, Flags, Integers
from benchmark.errors import SolverError

Energy = Callable[[Array, int], Array]
"""psi and its derivatives: (x, order 1 or 2) to Pa."""

TOLERANCE, MOST_TURNS, SHORTEST = 1e-8, 25, 1 / 64
PLATE_REACH = 6.0
"""The sheet goes on beyond its hole for so many thicknesses: at 3, its border held, it is 0.1 to 0.3 % too stiff."""
BASE_REACH = 12.0
"""A body on a rigid base is so many tool radii wide: 7 are 0.6 % stiffer at small depths."""
EDGE, GROWTH, LONGEST = 0.04, 1.5, 10.0
"""Elements at the edges of tool and hole and at the faces of strata, in tool radii; how they grow, and to how many
times as much."""


@dataclass(frozen=True)
class Stratum:
    """A layer: thickness in m, shear modulus in Pa, bulk modulus in Pa, and its law."""

    thickness: float
    shear: float
    bulk: float
    energy: Energy


@dataclass(frozen=True, eq=False)
class Pressed:
    """A press, from rest: (k,) m and N, and the lower face at radius (m,) m: outward motion and sinking (k, m) m."""

    depth: Array
    force: Array
    radius: Array
    outward: Array
    sinking: Array


def gent(shear: float, limit: float) -> Energy:
    """Gent's law, psi = -mu jm / 2 ln(1 - x / jm) (Rubber Chemistry and Technology 69 (1996) 59)."""

    def energy(x: Array, order: int) -> Array:
        left = np.clip(1.0 - x / limit, 1e-3, None)
        return 0.5 * shear / left if order == 1 else 0.5 * shear / limit / left**2

    return energy


def yeoh(shear: float, second: float, third: float) -> Energy:
    """Yeoh's law with c20 and c30 in shares of c10 (Rubber Chemistry and Technology 66 (1993) 754)."""

    def energy(x: Array, order: int) -> Array:
        c10 = 0.5 * shear
        slope = 1.0 + 2.0 * second * x + 3.0 * third * x**2
        return c10 * slope if order == 1 else c10 * (2.0 * second + 6.0 * third * x)

    return energy


def press(strata: tuple[Stratum, ...], tool: float, hole: float | None, clamp: str, depths: Array) -> Pressed:
    """Press a flat tool that sticks into a body, step by step.

    Parameters
    ----------
    strata : tuple of Stratum
        From the surface down.
    tool : float
        Its radius, m.
    hole : float or None
        Radius of the hole under the body, m; None on a rigid base.
    clamp : str
        Over a hole: "plate" (lower face held outside it) or "rim" (a disc as wide as the hole, held at its border).
    depths : (k,) m
        Rising, without the rest.

    Raises
    ------
    SolverError
        The press finds no balance.
    """
    body = _Body.of(strata, tool, hole, clamp)
    state, force = np.zeros(body.unknowns), [0.0]
    faces = [np.zeros((2, body.face.size))]
    for depth in depths.tolist():
        state = body.balanced(state, depth)
        force.append(body.reaction(state))
        faces.append(np.stack([state[body.face], -state[body.face + 1]]))
    along = np.stack(faces)
    return Pressed(np.append(0.0, depths), np.array(force), body.face_radius, along[:, 0], along[:, 1])


@dataclass(frozen=True, eq=False)
class _Body:
    """Elements with their laws, and what is held.

    Attributes
    ----------
    gradient : (elements, points, 5, 12)
        From nodal displacements to f less rest.
    shape : (points, 3)
        Of the pressure.
    weight : (elements, points) m3
    rows : (elements, 15)
        Unknowns of each element: displacements (r and z by turns), then pressures.
    tool, fixed : unknowns that the tool moves along the press, and those that stay.
    face : unknowns (r) of the free lower face in the order of their radius.
    """

    gradient: Array
    shape: Array
    weight: Array
    rows: Integers
    strata: tuple[Stratum, ...]
    stratum: Integers
    tool: Integers
    fixed: Integers
    face: Integers
    face_radius: Array
    unknowns: int

    @classmethod
    def of(cls, strata: tuple[Stratum, ...], tool: float, hole: float | None, clamp: str) -> _Body:
        """Mesh the body and hold it."""
        total = sum(each.thickness for each in strata)
        wide = BASE_REACH * tool if hole is None else hole + (PLATE_REACH * total if clamp == "plate" else 0.0)
        mesh = skfem.MeshTri.init_tensor(_across(tool, hole, wide), _down(strata, tool))
        basis = skfem.Basis(mesh, skfem.ElementTriP2(), intorder=4)
        linear = skfem.Basis(mesh, skfem.ElementTriP1(), intorder=4)
        place = basis.doflocs
        r, z = place[0], place[1]
        top, low, border = np.isclose(z, 0.0), np.isclose(z, -total), np.isclose(r, wide)
        inside = r <= tool * (1 + 1e-9)
        outside = np.full(r.shape, True) if hole is None else r >= hole * (1 - 1e-9)
        held = border if clamp == "rim" and hole is not None else (low & outside) | border
        free = np.flatnonzero(low & ~held) if hole is not None else np.array([], dtype=np.intp)
        free = free[np.argsort(r[free])]
        axis = np.isclose(r, 0.0)
        fixed = np.concatenate([_of(held, 0), _of(held, 1), _of(axis, 0), _of(top & inside, 0)])
        depth = -mesh.p[1][mesh.t].mean(axis=0)
        stratum = np.searchsorted(np.cumsum([each.thickness for each in strata]), depth)
        pressures = _apart(linear.element_dofs.T, stratum)
        return cls(
            gradient=_gradients(basis),
            shape=np.stack([np.array(linear.basis[i][0])[0] for i in range(3)], axis=1),
            weight=2 * np.pi * basis.dx * np.array(basis.global_coordinates())[0],
            rows=np.concatenate([_pairs(basis.element_dofs.T), 2 * place.shape[1] + pressures], axis=1),
            strata=strata,
            stratum=stratum,
            tool=_of(top & inside, 1),
            fixed=np.unique(fixed),
            face=2 * free,
            face_radius=r[free],
            unknowns=2 * place.shape[1] + int(pressures.max()) + 1,
        )

    def balanced(self, state: Array, depth: float) -> Array:
        """The state in balance at a depth of the tool, from the last one, in smaller steps where it must be."""
        now, share = -float(state[self.tool[0]]), depth + float(state[self.tool[0]])
        least = SHORTEST * share
        while now < depth - 1e-12:
            tried = self._newton(state, now + min(share, depth - now))
            if tried is None:
                share *= 0.5
                if share < least:
                    raise SolverError(f"blind world: the press by triangles finds no balance at {1e3 * depth:.2f} mm")
                continue
            state, now = tried, -float(tried[self.tool[0]])
        return state

    def _newton(self, start: Array, depth: float) -> Array | None:
        """Newton's method from another depth of the tool; None where it does not settle."""
        state = start.copy()
        free = np.setdiff1d(np.arange(self.unknowns), np.concatenate([self.tool, self.fixed]))
        for turn in range(MOST_TURNS):
            force, matrix = self._assemble(state)
            if not np.isfinite(force).all():
                return None
            if turn and np.abs(force[free]).max() < TOLERANCE * np.abs(force[self.tool]).sum():
                return state
            moved = np.zeros(self.unknowns)
            moved[self.tool] = -depth - state[self.tool]
            moved[free] = -splu(matrix[free][:, free]).solve((force + matrix @ moved)[free])
            state += moved
        return None

    def reaction(self, state: Array) -> float:
        """Force on the tool, N."""
        return -float(self._assemble(state)[0][self.tool].sum())

    def _assemble(self, state: Array) -> tuple[Array, Any]:
        """Residual (unknowns,) N and its derivative."""
        local = state[self.rows]
        scale = max(each.shear for each in self.strata)
        f = np.einsum("eqci,ei->eqc", self.gradient, local[:, :12]) + REST
        pressure = scale * local[:, 12:] @ self.shape.T
        first, second, volume, cofactor = self._derivatives(f, pressure)
        bulk = np.array([each.bulk for each in self.strata])[self.stratum][:, None]
        w = self.weight
        shape = scale * self.shape
        upper = np.einsum("eqci,eqc->ei", self.gradient, w[..., None] * first)
        lower = (w * (volume - 1.0 - pressure / bulk)) @ shape
        weighted = np.einsum("eqcd,eqdj->eqcj", w[..., None, None] * second, self.gradient)
        stiff = np.einsum("eqci,eqcj->eij", self.gradient, weighted, optimize=True)
        turned = np.einsum("eqci,eqc->eqi", self.gradient, w[..., None] * cofactor)
        mixed = np.einsum("eqi,qk->eik", turned, shape)
        spring = -np.einsum("eq,qk,ql->ekl", w / bulk, shape, shape, optimize=True)
        whole = np.concatenate(
            [np.concatenate([stiff, mixed], axis=2), np.concatenate([mixed.transpose(0, 2, 1), spring], axis=2)], axis=1
        )
        parts: Array = np.concatenate([upper, lower], axis=1)
        force = np.asarray(np.bincount(self.rows.ravel(), parts.ravel(), self.unknowns), dtype=np.float64)
        rows = np.broadcast_to(self.rows[:, :, None], whole.shape)
        columns = np.broadcast_to(self.rows[:, None, :], whole.shape)
        size = (self.unknowns, self.unknowns)
        return force, coo_matrix((whole.ravel(), (rows.ravel(), columns.ravel())), size).tocsc()

    def _derivatives(self, f: Array, pressure: Array) -> tuple[Array, Array, Array, Array]:
        """First and second derivatives of the energy by f, the volume and its derivative; NaN where it folds."""
        volume, cofactor, bend = _volume(f)
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.where(volume > 0.0, volume, np.nan) ** (-2.0 / 3.0)
        invariant = (f**2).sum(axis=2)
        each = cofactor / volume[..., None]
        slope = root[..., None] * (2.0 * f - 2.0 / 3.0 * invariant[..., None] * each)
        crossed = f[..., :, None] * each[..., None, :]
        curve = root[..., None, None] * (
            2.0 * np.eye(5)
            - 4.0 / 3.0 * (crossed + crossed.swapaxes(2, 3))
            + 10.0 / 9.0 * invariant[..., None, None] * each[..., :, None] * each[..., None, :]
            - 2.0 / 3.0 * (invariant / volume)[..., None, None] * bend
        )
        x = root * invariant - 3.0
        rise, growth = self._energies(x)
        first = rise[..., None] * slope + pressure[..., None] * cofactor
        second = growth[..., None, None] * slope[..., :, None] * slope[..., None, :]
        second += rise[..., None, None] * curve + pressure[..., None, None] * bend
        return first, second, volume, cofactor

    def _energies(self, x: Array) -> tuple[Array, Array]:
        rise, growth = np.empty_like(x), np.empty_like(x)
        for number, each in enumerate(self.strata):
            own = self.stratum == number
            rise[own], growth[own] = each.energy(x[own], 1), each.energy(x[own], 2)
        return rise, growth


REST = np.array([1.0, 0.0, 0.0, 1.0, 1.0])


def _volume(f: Array) -> tuple[Array, Array, Array]:
    """J, dJ/df and d2J/df2."""
    rr, rz, zr, zz, tt = np.moveaxis(f, 2, 0)
    plane = rr * zz - rz * zr
    first = np.stack([zz * tt, -zr * tt, -rz * tt, rr * tt, plane], axis=2)
    second = np.zeros((*f.shape, 5))
    for a, b, value in ((0, 3, tt), (0, 4, zz), (1, 2, -tt), (1, 4, -zr), (2, 4, -rz), (3, 4, rr)):
        second[..., a, b] = second[..., b, a] = value
    return plane * tt, first, second


def _gradients(basis: skfem.Basis) -> Array:
    """From the displacements of an element's nodes (r and z by turns) to f less rest."""
    radius = np.array(basis.global_coordinates())[0]
    out = np.zeros((*radius.shape, 5, 12))
    for node in range(6):
        shape = basis.basis[node][0]
        out[..., 0, 2 * node], out[..., 1, 2 * node] = shape.grad[0], shape.grad[1]
        out[..., 2, 2 * node + 1], out[..., 3, 2 * node + 1] = shape.grad[0], shape.grad[1]
        out[..., 4, 2 * node] = np.array(shape) / radius
    return out


def _pairs(nodes: Integers) -> Integers:
    out: Integers = np.stack([2 * nodes, 2 * nodes + 1], axis=2).reshape(len(nodes), -1)
    return out


def _apart(vertices: Integers, stratum: Integers) -> Integers:
    """Numbers of the pressures (elements, 3): a vertex between strata has one in each, for the pressure jumps there."""
    each = vertices * (int(stratum.max()) + 1) + stratum[:, None]
    out: Integers = np.unique(each, return_inverse=True)[1].reshape(each.shape)
    return out


def _of(nodes: Flags, component: int) -> Integers:
    return 2 * np.flatnonzero(nodes) + component


def _across(tool: float, hole: float | None, wide: float) -> Array:
    """Radii of the mesh, fine at the tool's edge and at the hole's."""
    edge = EDGE * tool
    under = tool - _finer_at_start(tool, edge)[::-1]
    if hole is None:
        return np.concatenate([under, tool + _finer_at_start(wide - tool, edge)[1:]])
    beyond = tool + _finer_at_ends(hole - tool, edge)[1:]
    inside = np.concatenate([under, beyond])
    return inside if wide <= hole else np.append(inside, hole + _finer_at_start(wide - hole, edge)[1:])


def _down(strata: tuple[Stratum, ...], tool: float) -> Array:
    """Heights of the mesh, rising to 0 at the surface, fine at every face of a stratum."""
    marks = [np.zeros(1)]
    for each in strata:
        marks.append(marks[-1][-1] + _finer_at_ends(each.thickness, EDGE * tool)[1:])
    return -np.concatenate(marks)[::-1]


def _finer_at_ends(length: float, edge: float) -> Array:
    """Marks from 0 to a length, fine at both ends."""
    half = _finer_at_start(0.5 * length, edge)
    return np.concatenate([half, length - half[-2::-1]])


def _finer_at_start(length: float, edge: float) -> Array:
    """Marks from 0 to a length: the first part about as long as `edge`, each `GROWTH` times the one before."""
    parts = edge * np.minimum(GROWTH ** np.arange(2 + int(length / edge)), LONGEST)
    marks = np.append(0.0, np.cumsum(parts))
    marks = marks[: 1 + int(np.searchsorted(marks, length * (1.0 - 1e-9)))]
    out: Array = marks * (length / marks[-1])
    return out
