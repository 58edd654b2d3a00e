"""One ramp of depth: the elastic answer of a prepared model, whichever it is, as points.

An elastic force depends on the depth alone, so a ramp serves every history of depth, and every unloading.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.files import Load, Scenario, Session, Setup
from benchmark.models import Drive, PreparedModel, RunFailure, silent
from benchmark.models.model_result import LowerFace, OnStep, lower_face
from benchmark.response.force_curve import Array, straight_on

PLACE_HOLDER = 0.5e-3
"""Peak of the load in a set-up's scenario, m; a ramp brings its own."""


@dataclass(frozen=True, eq=False)
class Ramp:
    """A press as far as the model followed it; linear between its points, straight on beyond the last.

    Attributes
    ----------
    depth, force : (k,) array
        m and N, from 0 up.
    layers : (k, L) array
        Deflection of each layer's top face on the tool axis, m.
    face : LowerFace or None
        Where it was asked for and the model kept every field.
    failure : RunFailure or None
        Where the model stopped before the depth asked for.
    """

    depth: Array
    force: Array
    layers: Array
    face: LowerFace | None = None
    failure: RunFailure | None = None

    @property
    def steps(self) -> int:
        """Load steps that were followed."""
        return self.depth.size - 1

    def force_at(self, depth: Array) -> Array:
        """(n,) N at depths (n,) of 0 and more, m."""
        return straight_on(np.asarray(depth, dtype=np.float64), self.depth, self.force)

    def layers_at(self, surface: Array) -> Array:
        """(n, L) m where the tissue under the tool stands at `surface` (n,), m; mirrored above the surface."""
        size, sign = np.abs(surface), np.sign(surface)
        return np.column_stack([sign * straight_on(size, self.depth, column) for column in self.layers.T])


def depth_ramp(model: PreparedModel, depth: float, steps: int, on_step: OnStep = silent, *, face: bool = False) -> Ramp:
    """Press a prepared model (finite elements, wave, or a user's own) in equal steps to a depth.

    Parameters
    ----------
    model : PreparedModel
        For the lower face prepared with `every_field`.
    depth : float
        m.
    steps : int
    on_step : callable
        Told of each step.
    face : bool
        Whether the lower face is wanted.

    Raises
    ------
    UncoveredError
        The model does not go so deep. A solver that stops on the way gives a ramp with its `failure`.
    """
    fractions = np.arange(1, steps + 1) / steps
    result = model.run(Drive("depth", fractions, depth * fractions), on_step)
    layers = np.vstack([np.zeros((1, result.top_deflection.shape[1])), result.top_deflection])
    below = lower_face(result) if face else None
    return Ramp(np.append(0.0, result.depth), np.append(0.0, result.force), layers, below, result.failure)


def setup_scenario(session: Session, setup: Setup) -> Scenario:
    """A scenario of a set-up with the session's settings; its load is a place holder."""
    load = Load(control="depth", peak=PLACE_HOLDER, shape="ramp", duration=1.0, observations=1)
    return session.scenario(*setup, load)
