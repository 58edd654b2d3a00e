"""Runs under one uniform tension: at rest at each instant, or in motion by the mid-point rule."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.damping import Damping
from wavemodel.integrators.load import Load
from wavemodel.plate.carrier import Carrier
from wavemodel.plate.faces import Faces
from wavemodel.plate.history import PlateHistory
from wavemodel.plate.indentation import Indentation
from wavemodel.plate.mid_point import Motion, integrate


@dataclass(frozen=True)
class UniformTension:
    """Kirchhoff's and Carrier's wave with the synthesis of its faces.

    Attributes
    ----------
    wave
        The modes.
    faces
        Of the sheet.
    dent
        What a pressure adds at the surface, or None.
    """

    wave: Carrier
    faces: Faces
    dent: Indentation | None

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force (n,) in N and depth (n,) in m at rest where one of them is given.

        Raises
        ------
        WaveError
            For a depth under a pressure, or if no tension is found.
        """
        history = self._history(self._resting(value, control == "depth"))
        return history.force, history.depth

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """(2, L + 1, m): outward and downward displacement of the faces at radii (m,), m."""
        return np.asarray(self._faces(self._resting(np.array([depth]), True), radii)[0])

    def run(self, load: Load) -> PlateHistory:
        """Equilibria at the instants of a load history."""
        return self._history(self._resting(load.value, load.control == "depth"))

    def move(self, load: Load, damping: Damping) -> PlateHistory:
        """Go through a load history with inertia, from rest.

        Raises
        ------
        WaveError
            For a depth under a pressure, or if no tension is found.
        """
        by_depth = load.control == "depth"
        self._refuse(by_depth)
        start = np.zeros(self.wave.inertia.size)
        if load.time[0] <= 0.0 and load.value[0] != 0.0:
            start = self.wave.at_rest(float(load.value[0]), by_depth)[0]
        return self._history(integrate(load, self.wave, damping, start))

    def _resting(self, value: FloatArray, by_depth: bool) -> Motion:
        self._refuse(by_depth)
        states, force = np.empty((value.size, self.wave.inertia.size)), np.empty(value.size)
        pull, still = 0.0, np.zeros(self.wave.inertia.size)
        for i, target in enumerate(value.tolist()):
            states[i], force[i], pull = self.wave.at_rest(target, by_depth, pull)
        energy = np.array([self.wave.energy(x, still) for x in states])
        return Motion(force, states @ self.wave.pressed, energy, states)

    def _refuse(self, by_depth: bool) -> None:
        if by_depth and self.dent is not None:
            raise WaveError(
                "control = 'depth' is not allowed with a uniform tension under a uniform pressure: use 'force', or a "
                "rigid tool"
            )

    def _history(self, motion: Motion) -> PlateHistory:
        axis = self._faces(motion, np.zeros(1))[:, 1, :-1, 0]
        return PlateHistory(
            force=motion.force,
            depth=motion.depth if self.dent is None else axis[:, 0],
            axis=axis,
            energy=motion.energy,
            faces=lambda step, radii: self._faces(motion.at(step), radii)[0],
        )

    def _faces(self, motion: Motion, radius: FloatArray) -> FloatArray:
        """(n, 2, L + 1, R): outward and downward displacement, m; the stretch of the neutral plane is left out."""
        table = self.faces.linear(radius)
        modes = table[..., :-1] @ self.wave.shape
        if self.dent is None:
            modes = modes + table[..., -1:] * self.wave.pressed
        out = np.einsum("cfrd,nd->ncfr", modes, motion.amplitude, optimize=True)
        if self.dent is not None:
            out[:, 1] += motion.force[:, None, None] * self.dent.deflection(radius)
        return np.asarray(out)
