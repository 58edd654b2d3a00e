"""Runs without inertia of a layered wave that is more than linear: a large press, and the options of a body.

What fades is the elastic force (quasi-linear viscoelasticity); the field is that of the elastic body at the depth
where the tissue stands.
"""

from dataclasses import replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.elastic_law import ElasticLaw
from wavemodel.integrators.history import History
from wavemodel.integrators.load import Load
from wavemodel.integrators.quasi_static import StaticBody, quasi_static
from wavemodel.physics.body import Physics
from wavemodel.physics.force_driven import driven
from wavemodel.press import Press


def large_press_run(load: Load, body: StaticBody, law: ElasticLaw) -> History:
    """Run a history with a large-press correction; the elastic force is taken as linear in each step.

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
    """Run a history on a body with options.

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
    return History(trace.force, trace.depth, top, elastic[:, None], amplitude, elastic)


def _added(law: ElasticLaw, elastic: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n, L) and (n,) what a large press adds to the deflection on the axis and to the depth."""
    if law.large is None:
        return np.zeros((elastic.size, 1)), np.zeros_like(elastic)
    weights = law.large.weights(elastic)
    return weights @ law.large.axis, weights @ law.large.depths
