"""Permanent set: the surface does not come back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic
from benchmark.physics.effect import Effect, LowerFaceMotion, PressHistory, Together, TrialContext, Values

if TYPE_CHECKING:
    from wavemodel.physics import PermanentSet

FIRST_TERMS = (
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
)
DESCRIPTION = EffectDescription(
    slug="permanent_set",
    acts_on="body",
    sentence="The pressed surface does not come back all the way: it is left sooner and met later in the next cycle.",
    equation="surface s = permanent_set max(d_max - onset, 0); the tool meets d_c = (d - s) d_max / (d_max - s)",
    needs=(("unloading",),),
    source="Oliver and Pharr 1992, J Mater Res 7:1564 (elastic unloading of an elastic-plastic body)",
    parameters=FIRST_TERMS,
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)
DELAYED = replace(
    DESCRIPTION,
    equation=f"{DESCRIPTION.equation}; with a delay the surface sinks under the tool, "
    "s' = (permanent_set max(d_max - onset, 0) - s) / delay, and d_c = d - s",
    source=f"{DESCRIPTION.source}; Findley, Lai and Onaran 1976, Creep and Relaxation of Nonlinear Viscoelastic "
    "Materials, chapter 1 (creep that is not recovered)",
    parameters=(
        *FIRST_TERMS,
        logarithmic("permanent_set_delay", "s", 1e-2, 1e3, "time in which the surface sinks to its set"),
    ),
    may_lack=(("permanent_set_delay",),),
)


def _law(values: Values) -> PermanentSet:
    from wavemodel.physics import PermanentSet

    delay = values.get("permanent_set_delay", 0.0)
    return PermanentSet(values["permanent_set"], values["permanent_set_onset"], delay)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    return {"permanent_set": _law(values)}


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    kept = values["marker_share"] * press.surface
    if values.get("permanent_set_delay", 0.0) == 0.0:
        return replace(face, depth=np.where(press.touching, face.depth, kept))
    passing = np.diff(press.time, prepend=press.time[0])
    set_back = (1.0 - values["marker_share"]) * _law(values).meet(passing, press.depth, ())[1]
    return replace(face, depth=np.where(press.touching, face.depth - set_back, kept))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    both = (0.0, 0.3)
    return tuple(
        {"permanent_set": 0.05, "permanent_set_onset": share * context.peak_depth, "marker_share": 0.5}
        for share in both
    )


def _delayed_starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    first, delays = _starts(context)[0], (0.02, 0.1, 0.5)
    return tuple(first | {"permanent_set_delay": share * context.duration} for share in delays)


def _deepest_set(values: Values, context: TrialContext) -> float:
    return values["permanent_set"] * max(context.peak_depth - values["permanent_set_onset"], 0.0)


SET = Together("a set of the surface after the deepest press", "m", _deepest_set, "presses to other depths")
LATE = Effect(DELAYED, "permanent_set", body=_body, lower_face=_lower_face, starts=_delayed_starts, together=SET)
EFFECT = replace(LATE, description=DESCRIPTION, starts=_starts, richer=LATE)
