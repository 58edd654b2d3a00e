"""What a run of the layered wave gives back."""

from dataclasses import dataclass, field, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError
from wavemodel.integrators.load_history import History
from wavemodel.layered.field import Snapshot
from wavemodel.layered.in_plane import InPlane, away
from wavemodel.layered.press import Press


@dataclass(frozen=True)
class WaveSolution:
    """History of a press (n steps, L layers; deflections downwards, SI).

    Attributes
    ----------
    time, force
        (n,) in s and N.
    depth
        (n,) in m: the top face on the axis, or the tool if it is rigid.
    layer_names
        L names from the surface down.
    top_deflection
        (n, L) in m: each layer's top face on the tool axis.
    integrator
        "quasi_static" or "exact": how time was gone through.
    warnings
        What a reader of the results must know.
    """

    time: FloatArray
    force: FloatArray
    depth: FloatArray
    layer_names: tuple[str, ...]
    top_deflection: FloatArray
    integrator: str
    warnings: tuple[str, ...]
    _press: Press = field(repr=False)
    _history: History = field(repr=False)

    def warned(self, warning: str) -> "WaveSolution":
        """The same with one more warning, the first."""
        return replace(self, warnings=(warning, *self.warnings))

    def snapshot(self, step: int) -> Snapshot:
        """State of the modes after a step (0..n-1), for `Field` and `Surface`."""
        force = self._history.static_force[step]
        elastic = 0.0 if self._history.elastic is None else float(self._history.elastic[step])
        return Snapshot(self._history.amplitude(step), float(force[0]) if force.size == 1 else force, elastic)

    def profile(self, step: int, radii: FloatArray) -> FloatArray:
        """Deflection of each layer's top face along +x after a step.

        Parameters
        ----------
        step
            0..n-1; negative counts from the end.
        radii
            (m,) distances from the tool axis, m.

        Returns
        -------
        ndarray (L, m)
            In m; NaN outside the window.

        Raises
        ------
        WaveError
            If a radius is negative or not a number.
        """
        return self._press.field.along_x(self.snapshot(step), np.asarray(radii, dtype=np.float64))

    def in_plane(self, step: int, points: FloatArray, face: int) -> FloatArray:
        """(P, 2) displacement along x and y at points (P, 2) of a face, m; see `marker_motion`.

        Raises
        ------
        NotCoveredError
            See `marker_motion`.
        """
        domain = self._press.field.domain
        inside = domain.holds(points)
        out = np.where(inside[:, None], 0.0, np.nan) * np.ones(2)
        if face == len(self.layer_names) and self._press.stack.base == "bonded":
            return out
        force = self._history.static_force[step]
        if force.size > 1:
            raise NotCoveredError(
                "marker motion of the layered wave does not cover layers that relax each in its own way"
            )
        plane, places = InPlane(self._press, face), points[inside]
        moving = self._history.outward
        amplitude = force[0] * plane.amplitude() if moving is None else moving(step)[face]
        out[inside] = plane.smooth(amplitude, places) + force[0] * plane.sharp(places)
        if self._press.field.large is not None and self._history.elastic is not None:
            elastic = float(self._history.elastic[step])
            distance = np.hypot(places[:, 0], places[:, 1])
            out[inside] += away(self._press.field.large.outward(elastic, face, distance), places)
        return out
