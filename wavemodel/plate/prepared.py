"""A sheet's force-depth law that is ready up to a depth and goes on by itself where more is wanted."""

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.load import Load
from wavemodel.plate.curve import Curve
from wavemodel.plate.history import PlateHistory
from wavemodel.plate.law import PlateLaw

MARGIN, LARGEST_GROWTH = 1.05, 6.0
"""Of what is prescribed, where it is not what is wanted."""
ROUNDING = 1e-9
"""So little beyond the last equilibrium the curve goes on by itself."""


class PreparedLaw:
    """Statics of a sheet under a press.

    Parameters
    ----------
    law
        At rest.
    reach
        Depth up to which equilibria are found now, m.

    Raises
    ------
    WaveError
        If the sheet has no equilibrium up to there.
    """

    def __init__(self, law: PlateLaw, reach: float) -> None:
        across, self._rigid = law.sheet.section, law.sheet.tool is not None
        # Under a pressure the force is prescribed: begin with about one thickness of depth, by the plate's theory.
        linear = 16.0 * np.pi * across.bending * across.thickness / law.sheet.functions.outer**2
        self._law = law.extended(reach if self._rigid else linear)
        self._curve: Curve = self._law.curve()
        self._extend("depth", reach)

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force (n,) in N and depth (n,) in m where one of them, "force" or "depth", is given."""
        self._extend(control, float(np.abs(value).max(initial=0.0)))
        if control == "depth":
            return self._curve.force_at(value), value
        return value, self._curve.depth_at(value)

    def run(self, load: Load) -> PlateHistory:
        """Equilibria at the instants of a load history."""
        force, depth = self.rest(load.control, load.value)
        return PlateHistory(
            force, depth, self._curve.axis_at(depth), None, lambda step, radii: self.field(float(depth[step]), radii)
        )

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """(2, L + 1, m): outward and downward displacement of the faces at radii (m,), m."""
        deep = abs(depth)
        self._extend("depth", deep)
        force = float(self._curve.force_at(np.array([deep]))[0])
        moved = self._law.displacement(self._curve.state_at(deep), deep, force, radii)
        return np.asarray(np.sign(depth) * moved)

    def _extend(self, control: str, wanted: float) -> None:
        """Find equilibria up to a depth (m) or force (N) that is wanted."""
        while self._curve.reach[control == "force"] < (1.0 - ROUNDING) * wanted:
            given = self._rigid == (control == "depth")
            self._law = self._law.extended(wanted if given else self._beyond(control, wanted))
            self._curve = self._law.curve()

    def _beyond(self, control: str, wanted: float) -> float:
        """What to prescribe so that the other quantity gets to what is wanted: on by the last power law."""
        depth, force = np.diff(np.log(self._curve.depth[-2:])), np.diff(np.log(self._curve.force[-2:]))
        power = float((depth / force if control == "force" else force / depth)[0])
        growth = (MARGIN * wanted / self._curve.reach[control == "force"]) ** power
        return self._law.path[-1].load * min(float(growth), LARGEST_GROWTH)
