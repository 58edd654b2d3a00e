"""An effect of your own for `python -m benchmark discover SESSION --effects examples/own_effect.py`.

A tool that heats the tissue: the longer it is pressed, the softer the specimen becomes. Copy this file, change the
description and the functions, and give it with --effects; every `Effect` at the top level is a
candidate beside the catalogue.
"""

from dataclasses import replace

import numpy as np

from benchmark.physics import Effect, EffectDescription, EffectParameter

DESCRIPTION = EffectDescription(
    slug="warming",
    acts_on="observation",
    sentence="The specimen warms under the tool and softens while it is touched.",
    equation="F_read = F (1 - s (1 - exp(-t / tau))), t from the start of the trial",
    source="an example, not from the literature",
    parameters=(
        EffectParameter("s", "", (0.05,), 0.0, 0.9, False, "largest share of the force that is lost"),
        EffectParameter("tau", "s", (20.0,), 0.1, 1e4, True, "time over which it is lost"),
    ),
)


def _observe(values, readings, motion, context):  # noqa: ARG001 - every place gets the same
    """Readings with the force fading; values in SI by name, (n,) arrays in readings and motion."""
    time = motion.time - motion.time[0]
    return replace(readings, force=readings.force * (1.0 + values["s"] * np.expm1(-time / values["tau"])))


EFFECT = Effect(DESCRIPTION, amplitude="s", observe=_observe)
