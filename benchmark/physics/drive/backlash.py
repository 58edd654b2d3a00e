"""Backlash: motion is lost at each reversal."""

from __future__ import annotations

import numpy as np

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Array, BodyResponse, Effect, Motion, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="backlash",
    acts_on="drive",
    sentence="The drive has play: at each reversal the tool stands still until the play is taken up.",
    equation="d -> p + side width, p follows d by the play operator, d - width <= p <= d",
    needs=(("unloading",),),
    source="M. Brokate and J. Sprekels, Hysteresis and Phase Transitions, section 2.1 (play)",
    parameters=(
        linear("width", "m", 0.0, 5e-3, "lost motion at a reversal"),
        linear("side", "", 0.0, 1.0, "1: the depth shown is right while pressing; 0: while retracting", 0.5),
    ),
)


def play(depth: Array, width: float) -> Array:
    """(n,) of what lags behind depths (n,) by at most `width`, taken up before the first sample."""
    from wavemodel.integrators.scan import bounded_sum

    half = 0.5 * width
    elastic = bounded_sum(np.diff(depth, prepend=depth[0]), np.full_like(depth, half), half)
    return np.asarray(depth - elastic - half)


def _drive(values: Values, motion: Motion, response: BodyResponse) -> Array:
    return play(motion.depth, values["width"]) + values["side"] * values["width"]


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return tuple({"width": 0.02 * context.peak_depth, "side": side} for side in (1.0, 0.0, 0.5))


EFFECT = Effect(DESCRIPTION, "width", drive=_drive, starts=_starts, in_depth="width")
