"""The elastic law of a tool on a stack, and runs without inertia on it: at finite strain, and with options of the body.

What relaxes is the elastic force (quasi-linear viscoelasticity); the field is that of the elastic body at the depth
where the tissue stands.
"""

from dataclasses import dataclass, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.load_history import History, Load
from wavemodel.integrators.quasi_static import StaticBody, quasi_static
from wavemodel.layered.finite_strain.correction import FiniteStrainLaw
from wavemodel.layered.press import Press
from wavemodel.physics.quasi_static_press import Physics, driven


@dataclass(frozen=True)
class ElasticLaw:
    """Depth and force of the elastic body, each from the other.

    Attributes
    ----------
    compliance
        Initial depth per force, m/N.
    large
        What finite strain adds, or None.
    """

    compliance: float
    large: FiniteStrainLaw | None = None

    def __call__(self, depth: FloatArray) -> FloatArray:
        """(...) force at depths (...), N.

        Raises
        ------
        WaveError
            If a depth is beyond the range of the correction.
        """
        depth = np.asarray(depth, dtype=np.float64)
        return depth / self.compliance if self.large is None else self.large.force_at(depth)

    def depth_at(self, force: FloatArray) -> FloatArray:
        """(...) depth under forces (...), m."""
        force = np.asarray(force, dtype=np.float64)
        return force * self.compliance if self.large is None else self.large.depth_at(force)


def finite_strain_run(load: Load, body: StaticBody, law: ElasticLaw) -> History:
    """Run a history at finite strain; the elastic force is taken as linear in each step, the depth is the surface's.

    Raises
    ------
    WaveError
        If the press goes beyond the range of the correction.
    """
    linear = load if load.control == "force" else replace(load, value=law.compliance * law(load.value))
    history = quasi_static(linear, body)
    elastic = history.depth / law.compliance
    added, deeper = _added(law, elastic)
    return replace(
        history, depth=history.depth + deeper, top_deflection=history.top_deflection + added, elastic=elastic
    )


def options_run(load: Load, press: Press, law: ElasticLaw, physics: Physics) -> History:
    """Run a history on a body with options; the depth is the surface's.

    Raises
    ------
    WaveError
        If the press goes beyond the law's range, or pulls more than the tissue holds.
    """
    trace = driven(load, law, physics, 0.1 * press.stack.height)
    elastic = law(trace.surface)

    def amplitude(step: int) -> FloatArray:
        return np.asarray(press.unit * elastic[step])

    added, _ = _added(law, elastic)
    top = np.outer(elastic, press.unit_axis) + added
    return History(trace.force, trace.surface, top, elastic[:, None], amplitude, elastic)


def _added(law: ElasticLaw, elastic: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n, L) and (n,) what finite strain adds to the deflection on the axis and to the depth."""
    if law.large is None:
        return np.zeros((elastic.size, 1)), np.zeros_like(elastic)
    weights = law.large.weights(elastic)
    return weights @ law.large.axis, weights @ law.large.depths
