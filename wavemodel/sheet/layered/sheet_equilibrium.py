"""Equilibrium of the layered sheet: Newton's method with a tangent that is kept as long as it serves.

What is minimised at a depth of a rigid tool, or under the force of a pressure, is the energy of the sheet and of the
springs that hold it, less the work of the pressure. Where the tangent is not positive it is shifted until it is, so
that a step always goes down.

The matrices are too small for more than one thread: on a busy machine the threads of a linear-algebra library, which
wait for each other, made a set-up twenty times as long.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from threadpoolctl import ThreadpoolController

from wavemodel.arrays import FloatArray
from wavemodel.integrators.equilibrium_path import EquilibriumState, straight_on
from wavemodel.layered.finite_strain.deformation_state import Deformed
from wavemodel.sheet.layered.layered_sheet import LayeredSheet

TOLERANCE = 1e-10
"""Energy that a step may still gain, over that of the sheet."""
MOST_STEPS, MOST_HALVINGS = 40, 12
KEPT = 0.02
"""The tangent is worked out anew when a step gains more than this share of the one before."""
DESCENT, ROUNDING = 1e-4, 1e-12
SHIFT, GROWTH = 1e-4, 4.0
"""First shift of a tangent whose diagonal is one, and how it grows."""
LOOKED_AHEAD = 0.3
"""Depth over the sheet's thickness at which the linear answer to a pressure is the first load."""


@dataclass(frozen=True)
class _Point:
    """Amplitudes (A,), the deformation, the tractions (J,) and the potential there."""

    amplitude: FloatArray
    state: Deformed
    traction: FloatArray
    potential: float


class SheetEquilibrium:
    """A layered sheet (a `SheetBody`), which keeps its last tangent.

    Parameters
    ----------
    body
        The sheet.
    """

    levels = 14

    def __init__(self, body: LayeredSheet) -> None:
        self.body, self.rigid, self.unknowns = body, body.tool.rigid, body.place.size
        self._threads = ThreadpoolController()
        with self._threads.limit(limits=1):
            self._start()

    def _start(self) -> None:
        """Tangent at rest, and the linear answer."""
        body = self.body
        rest = body.state(np.zeros(self.unknowns))
        assert rest is not None
        held = body.held
        self._springs = (held.push * held.spring) @ held.push.T
        diagonal = body.tangent(rest).diagonal() + self._springs.diagonal()
        self._scale = 1.0 / np.sqrt(diagonal)
        self._factor = self._factorised(rest)
        pushed = held.push @ (held.spring * held.with_tool) if held.load is None else held.load
        self._linear = self._solved(pushed)
        deflection = body.displacement(self._linear, 1.0, np.zeros(1))[1, 0, 0]
        self.first_load = LOOKED_AHEAD * float(body.thickness.weight.sum() / deflection)

    def force(self, state: FloatArray, load: float) -> float:
        """Press in N."""
        held = self.body.held
        return float(held.with_tool @ held.reaction(state, load)) if self.rigid else load

    def displacement(self, state: FloatArray, depth: float, radius: FloatArray, force: float) -> FloatArray:  # noqa: ARG002
        """See `LayeredSheet.displacement`."""
        return self.body.displacement(state, depth, radius)

    def equilibrium(self, path: Sequence[EquilibriumState], load: float) -> FloatArray | None:
        """Amplitudes (A,) at a load near the last one of a path; None where none are found."""
        with self._threads.limit(limits=1):
            return self._equilibrium(path, load)

    def _equilibrium(self, path: Sequence[EquilibriumState], load: float) -> FloatArray | None:
        start = self._linear * load if len(path) == 1 else straight_on(path, load)
        here = self._at(start, load)
        last = np.inf
        for _ in range(MOST_STEPS):
            if here is None:
                return None
            residual = self._residual(here, load)
            step = -self._solved(residual)
            gain = -float(residual @ step)
            if gain > KEPT * last or last == np.inf:
                self._factor = self._factorised(here.state)
                step = -self._solved(residual)
                gain = -float(residual @ step)
            if gain <= TOLERANCE * abs(here.potential):
                return here.amplitude
            last = gain
            here = self._shortened(here, step, gain, load)
        return None

    def _residual(self, here: _Point, load: float) -> FloatArray:
        held = self.body.held
        out = self.body.forces(here.state.stress) - held.push @ here.traction
        return out if held.load is None else out - load * held.load

    def _at(self, amplitude: FloatArray, load: float) -> _Point | None:
        held, state = self.body.held, self.body.state(amplitude)
        if state is None:
            return None
        traction = held.reaction(amplitude, load if self.rigid else 0.0)
        potential = self.body.energy(state) + 0.5 * float(traction @ (traction / held.spring))
        if held.load is not None:
            potential -= load * float(held.load @ amplitude)
        return _Point(amplitude, state, traction, potential)

    def _shortened(self, here: _Point, step: FloatArray, gain: float, load: float) -> _Point | None:
        """Go along a step as far as the potential falls enough."""
        share = 1.0
        for _ in range(MOST_HALVINGS):
            there = self._at(here.amplitude + share * step, load)
            if there is not None:
                fall = here.potential - there.potential
                if fall >= DESCENT * share * gain - ROUNDING * abs(here.potential):
                    return there
            share *= 0.5
        return None

    def _solved(self, right: FloatArray) -> FloatArray:
        return np.asarray(self._scale * cho_solve(self._factor, self._scale * right, check_finite=False))

    def _factorised(self, state: Deformed) -> tuple[FloatArray, bool]:
        """Cholesky's factor of the scaled tangent, shifted until it has one."""
        whole = (self.body.tangent(state) + self._springs) * np.outer(self._scale, self._scale)
        shift = 0.0
        while True:
            try:
                factor, lower = cho_factor(whole + shift * np.eye(whole.shape[0]), lower=True, check_finite=False)
                return np.asarray(factor), bool(lower)
            except LinAlgError:
                shift = max(GROWTH * shift, SHIFT)
