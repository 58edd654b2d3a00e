"""Kirchhoff's and Carrier's wave on the sheet over a hole: bending under one tension that grows with the stretch.

    (M d2/dt2 + K + (T0 + N) G) x + N n = F e,    N = beta (I / 2 + n . x),    I = x' G x = int |grad w|^2 dA

(Berger's plate in the sheet's radial functions). K and M are the small-strain sheet's with its elastic edges, e picks
the depth of the tool. The edges add n . x: a turn about the corner of a support pushes the neutral plane, so a thick
sheet is first compressed. 1 / beta is the compliance of the membrane and its edges under a uniform tension.

It is simpler than the sheet's own tension, which varies with the radius, and its motion conserves energy.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.sheet.sheet import Sheet

DOUBLINGS, ROUNDING = 60, 1e-14
BUCKLED = 0.999
"""Of the compression at which the sheet would buckle: the least tension looked at."""


@dataclass(frozen=True)
class Carrier:
    """The wave in d modes of unit strain energy: K is one, M is diagonal.

    Attributes
    ----------
    inertia
        (d,) of the modes, 1 / w^2, s2.
    tension
        (d, d) G in the modes, m/N.
    push
        (d,) n in the modes.
    pressed
        (d,) e in the modes: amplitudes times it sum to the depth, m.
    shape
        (N, d) unknowns of the sheet (coefficients and loads on the edges) by mode, without those of the tension.
    pretension, stiffening
        T0 in N/m and beta in N/m3.
    """

    inertia: FloatArray
    tension: FloatArray
    push: FloatArray
    pressed: FloatArray
    shape: FloatArray
    pretension: float
    stiffening: float

    @property
    def first_frequency(self) -> float:
        """Lowest natural frequency without tension, Hz."""
        return float(1.0 / (2.0 * np.pi * np.sqrt(self.inertia.max())))

    def pull(self, x: FloatArray) -> float:
        """N in N/m at amplitudes (d,)."""
        return self.stiffening * float(0.5 * x @ self.tension @ x + self.push @ x)

    def energy(self, x: FloatArray, v: FloatArray) -> float:
        """Kinetic energy, strain energy, and that of the tension, J, at amplitudes and rates (d,)."""
        stretched = self.pull(x) ** 2 / self.stiffening + self.pretension * float(x @ self.tension @ x)
        return 0.5 * (float(x @ x) + float(v @ (self.inertia * v)) + stretched)

    @cached_property
    def _statics(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """G's eigenvalues and vectors, and e and n on those."""
        values, vectors = np.linalg.eigh(self.tension)
        return np.maximum(values, 0.0), vectors, vectors.T @ self.pressed, vectors.T @ self.push

    def at_rest(self, target: float, by_depth: bool = False, pull: float = 0.0) -> tuple[FloatArray, float, float]:
        """Equilibrium under a force (N), or at a depth (m), from a first guess of N on.

        Returns
        -------
        tuple
            Amplitudes (d,), the force in N, and N in N/m.

        Raises
        ------
        WaveError
            If no tension is found.
        """
        values, vectors, pressed, push = self._statics

        def answer(pull: float) -> tuple[FloatArray, float, float]:
            soft = 1.0 / (1.0 + (self.pretension + pull) * values)
            free, give = -pull * soft * push, soft * pressed
            force = (target - float(pressed @ free)) / float(pressed @ give) if by_depth else target
            y = free + force * give
            return y, force, self.stiffening * float(0.5 * y @ (values * y) + push @ y)

        def miss(pull: float) -> float:
            return answer(pull)[2] - pull

        low = -self.pretension - BUCKLED / float(values.max())
        high = max(pull, abs(low))
        for _ in range(DOUBLINGS):
            if miss(high) < 0.0 < miss(low):
                found = float(brentq(miss, low, high, xtol=ROUNDING * high, rtol=ROUNDING))
                y, force, _ = answer(found)
                return vectors @ y, force, found
            high *= 2.0
        unit = "m" if by_depth else "N"
        raise WaveError(f"{'depth' if by_depth else 'force'} = {target:g} {unit}: no uniform tension found at rest")


def carrier(sheet: Sheet, tool_mass: float = 0.0) -> Carrier:
    """Set up the wave of a sheet, whose pretension becomes T0, and of a rigid tool of some mass (kg)."""
    stiffness, push, shape, compliance = _elasticity(sheet)
    mass, tension, pressed = _inertia_and_tension(sheet, tool_mass)
    root = np.linalg.cholesky(stiffness)
    half = np.linalg.solve(root, mass)
    scaled = np.linalg.solve(root, half.T)
    inertia, vectors = np.linalg.eigh(0.5 * (scaled + scaled.T))
    order = np.argsort(-inertia)
    modes = np.linalg.solve(root.T, vectors[:, order])
    drawn = modes.T @ tension @ modes
    return Carrier(
        inertia=inertia[order],
        tension=0.5 * (drawn + drawn.T),
        push=modes.T @ push,
        pressed=modes.T @ pressed,
        shape=shape @ modes,
        pretension=sheet.pretension,
        stiffening=1.0 / compliance,
    )


def _elasticity(sheet: Sheet) -> tuple[FloatArray, FloatArray, FloatArray, float]:
    """K and n (m, ..), the table (N, m) of the sheet's unknowns, and 1 / beta, for the m unknowns (w, phi, tool).

    An edge under the loads (s N, M, Q) on its corner moves by its compliance C; s is its length, towards the axis at
    the clamp. M and Q are eliminated, which leaves (D - C s N)' C^-1 (D - C s N) / 2 of the turns and sinkings D.
    """
    n, first = sheet.functions.unknowns, sheet.functions.count
    slack = sheet.untensioned()
    whole = slack.residual(np.zeros(slack.unknowns), 0.0, 0.0)[1]
    size = n - first + (sheet.tool is not None)
    stiffness, push = np.zeros((size, size)), np.zeros(size)
    stiffness[: n - first, : n - first] = whole[first:n, first:n]
    shape = np.zeros((sheet.unknowns, size))
    shape[first:n, : n - first] = np.eye(n - first)
    area = np.pi * (sheet.functions.outer**2 - sheet.functions.inner**2)
    compliance = area / sheet.section.membrane
    for i, edge in enumerate(edge for edge in (sheet.clamp, sheet.tool) if edge is not None):
        length = 2.0 * np.pi * edge.radius * (-1.0 if i == 0 else 1.0)
        at = slice(n + 3 * i, n + 3 * i + 3)
        ends = np.zeros((3, size))
        ends[:, : n - first] = whole[at, first:n]
        ends[2, -1] -= float(i)
        give = -whole[at, at]
        stiff = np.linalg.inv(give[1:, 1:])
        stiffness += ends[1:].T @ stiff @ ends[1:]
        push += length * (ends[0] - give[0, 1:] @ stiff @ ends[1:])
        compliance += length**2 * float(give[0, 0] - give[0, 1:] @ stiff @ give[1:, 0])
        shape[n + 3 * i + 1 : n + 3 * i + 3] = stiff @ ends[1:]
    return stiffness, push, shape, compliance


def _inertia_and_tension(sheet: Sheet, tool_mass: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """M, G and e for the unknowns (w, phi, tool); what lies under a tool moves with it."""
    n, first = sheet.functions.unknowns, sheet.functions.count
    size = n - first + (sheet.tool is not None)
    table = sheet.functions.displacement(sheet.radius)[1:, :, first:]
    share = np.array([sheet.section.rotary_inertia, sheet.section.mass])
    mass, tension, pressed = np.zeros((size, size)), np.zeros((size, size)), np.zeros(size)
    mass[: n - first, : n - first] = np.einsum("cpi,c,p,cpj->ij", table, share, sheet.weight, table, optimize=True)
    slope = sheet.strains[2][:, first:]
    tension[: n - first, : n - first] = (slope.T * sheet.weight) @ slope
    if sheet.pressure is None:
        pressed[-1] = 1.0
        mass[-1, -1] = sheet.section.mass * np.pi * sheet.functions.inner**2 + tool_mass
    else:
        pressed[:] = sheet.pressure.mean_deflection(np.zeros(n))[0][first:]
    return mass, tension, pressed
