"""Permanent set: the surface does not come back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmark.physics.description import EffectDescription, Option, linear
from benchmark.physics.effect import Effect, LowerFaceMotion, PressHistory, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="permanent_set",
    acts_on="body",
    sentence="The pressed surface does not come back all the way: it is left sooner and met later in the next cycle.",
    equation="surface s = permanent_set max(d_max - onset, 0); the tool meets d_c = (d - s) d_max / (d_max - s)",
    needs=(("unloading",),),
    source="Oliver and Pharr 1992, J Mater Res 7:1564 (elastic unloading of an elastic-plastic body)",
    parameters=(
        linear(
            "permanent_set",
            "",
            0.0,
            0.9,
            "share of the deepest depth at which the surface stays",
            option=Option(0.0, 0.95, example="0.05"),
            formerly="fraction",
        ),
        linear(
            "permanent_set_onset",
            "m",
            0.0,
            0.05,
            "depth that leaves no set",
            option=Option(1e-9, 1.0, default=0.0),
            formerly="onset",
        ),
        linear("marker_share", "", 0.0, 1.0, "share of the set that the lower face keeps after lift-off", 0.5),
    ),
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import PermanentSet

    return {"permanent_set": PermanentSet(values["permanent_set"], values["permanent_set_onset"])}


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    kept = values["marker_share"] * press.surface
    return replace(face, depth=np.where(press.touching, face.depth, kept))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    both = (0.0, 0.3)
    return tuple(
        {"permanent_set": 0.05, "permanent_set_onset": share * context.peak_depth, "marker_share": 0.5}
        for share in both
    )


EFFECT = Effect(DESCRIPTION, "permanent_set", body=_body, lower_face=_lower_face, starts=_starts)
