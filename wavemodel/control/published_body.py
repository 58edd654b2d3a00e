"""The published membrane under an interactive tool (section 3.4 of the paper), as printed and corrected.

The collision depth gives a time by eq. (8), the time gives the patch of a by a by eq. (7), moved so that its middle is
at the contact. Going back to the original shape the time runs on to where all is at z = 0. As printed, the patch is
B_11 in mm times as deep as the collision. The paper snaps the patch to whole vertices; here its middle is the contact.
"""

from dataclasses import dataclass, field

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.published.membrane import PublishedWave


@dataclass(frozen=True)
class PublishedBody:
    """A `Body` of one mode. Its "elastic force" is the cosine of the membrane's time, lambda t: 0 at rest.

    Attributes
    ----------
    wave
        The membrane, one mode.
    depths, forces
        (m,) measured law of the bench, m and N, rising, which the haptic force is read off; empty: the force is NaN,
        for a membrane has none of its own.
    vertices
        Most vertices of the tissue along one side.

    Raises
    ------
    WaveError
        If the wave has more modes than one, or the law is not usable.
    """

    wave: PublishedWave
    depths: tuple[float, ...] = ()
    forces: tuple[float, ...] = ()
    vertices: int = 1024
    _sines: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.wave.modes != 1:
            raise WaveError(f"modes = {self.wave.modes} is not allowed: eq. (8) inverts one mode")
        rising = len(self.depths) == len(self.forces) and bool(np.all(np.diff(self.depths) > 0.0))
        if not rising or not np.isfinite([*self.depths, *self.forces]).all():
            raise WaveError("force law: as many finite forces as depths are needed, and depths that rise")
        object.__setattr__(self, "_sines", np.empty((3, self.vertices**2)))

    @property
    def layers(self) -> int:
        """One: the paper's layers move together."""
        return 1

    @property
    def tool_radius(self) -> float:
        """Nought: the collision is a point."""
        return 0.0

    @property
    def reach(self) -> float:
        """Half a side, m."""
        return 0.5 * self.wave.side

    @property
    def deepest(self) -> float:
        """What eq. (8) reaches: 1 mm as printed, |B_11| corrected."""
        return 1e-3 if self.wave.variant == "as_printed" else abs(float(self.wave.coefficient[0, 0]))

    def elastic(self, depth: float) -> float:
        """cos(lambda t) at the time of a depth, eq. (8)."""
        return float(np.cos(self._frequency * self._time(depth)))

    def depth(self, elastic: float) -> float:
        """The depth that eq. (8) is given for it."""
        return elastic * self.deepest

    def reaction(self, elastic: float) -> float:
        """Off the measured law, N; NaN without one."""
        return float(np.interp(self.depth(elastic), self.depths, self.forces)) if self.depths else float("nan")

    def between(self, distance: float) -> float:
        """Nought."""
        del distance
        return 0.0

    def returning(self, elastic: float, share: float) -> float:
        """The time of eq. (7) runs on evenly to where all is at z = 0."""
        angle = float(np.arccos(elastic))
        return float(np.cos(angle + share * (0.5 * np.pi - angle)))

    def return_time(self, elastic: float) -> float:
        """What is left of the first quarter of the oscillation, s."""
        return (0.5 * np.pi - float(np.arccos(elastic))) / self._frequency

    def add(self, elastic: float, dx: FloatArray, dy: FloatArray, out: FloatArray) -> None:
        """See `Body.add`."""
        size = dx.size * dy.size
        if max(dx.size, dy.size) > self.vertices:
            raise WaveError(f"patch: {max(dx.size, dy.size)} vertices a side are more than vertices = {self.vertices}")
        along_x, along_y = self._sines[0, : dx.size], self._sines[1, : dy.size]
        for table, position in ((along_x, dx), (along_y, dy)):
            np.multiply(position, np.pi / self.wave.side, out=table)
            np.cos(table, out=table)
        along_x *= float(self.wave.coefficient[0, 0]) * elastic
        patch = self._sines[2, :size].reshape(dx.size, dy.size)
        np.multiply(along_x[:, None], along_y, out=patch)
        out[0] += patch

    @property
    def _frequency(self) -> float:
        return float(self.wave.frequency[0, 0])

    def _time(self, depth: float) -> float:
        middle = 0.5 * self.wave.side
        return float(self.wave.time_of_depth(np.array([depth]), middle, middle)[0])
