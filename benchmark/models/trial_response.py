"""What a trial's force becomes with the effects of a model file: drive, body and observation around an elastic law."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.models.result import Array, UncoveredError
from benchmark.physics import Effect, Motion, Readings, TrialContext
from wavemodel import WaveError
from wavemodel.physics import Physics, QuasiStaticPress

Law = Callable[[Array], Array]
Added = tuple[Effect, Mapping[str, float]]
FIRST_STEP = 1e-3
"""A trial begins this long after rest, s."""


@dataclass(frozen=True, eq=False)
class _Body:
    """The body as an effect of the drive sees it."""

    law: Law
    physics: Physics
    time: Array

    def elastic(self, depth: Array) -> Array:
        """(n,) N without memory."""
        return np.where(depth > 0.0, self.law(np.maximum(depth, 0.0)), 0.0)

    def force(self, depth: Array) -> Array:
        """(n,) N."""
        return QuasiStaticPress(self.law, self.physics).force(self.time, depth)


def trial_force(law: Law, added: Sequence[Added], time: Array, depth: Array, around: TrialContext) -> Array:
    """Force that the sensor reports in a trial.

    Parameters
    ----------
    law
        Elastic force in N over depths of 0 and more, m.
    added
        Effects with their values, in the order in which they act.
    time, depth
        (n,) s and m below contact.
    around
        What the effects may know of the trial.

    Raises
    ------
    UncoveredError
        A depth or a value that the effects do not cover.
    """
    options: dict[str, Any] = {}
    for effect, values in added:
        if effect.body is not None:
            options |= dict(effect.body(values, around))
    clock = time - time[0] + FIRST_STEP
    body = _Body(law, Physics(**options), clock)
    speed = np.gradient(depth, time)
    motion = Motion(clock, depth, np.gradient(speed, time))
    given = depth
    try:
        for effect, values in added:
            if effect.drive is not None:
                given = effect.drive(values, Motion(clock, given, motion.acceleration), body)
        readings = Readings(body.force(given))
        for effect, values in added:
            if effect.observe is not None and not effect.needs_markers:
                readings = effect.observe(values, readings, motion, around)
    except WaveError as error:
        raise UncoveredError(str(error)) from None
    return readings.force
