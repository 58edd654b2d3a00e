"""Interface slip: layers slide over each other beyond a shear limit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, LowerFaceMotion, PressHistory, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="interface_slip",
    acts_on="body",
    sentence="Layers slide over each other beyond a shear limit: the lower face is carried along less than it should.",
    equation="F = (1 - s) f + y, y follows s f within +-s F_s; the markers' part q of the depth follows within +-d_s, "
    "f(d_s) = F_s; a share of the slip may go back at once",
    source="W. D. Iwan 1966, J Appl Mech 33:893 (Jenkin element)",
    parameters=(
        logarithmic("limit", "N", 1e-4, 1e3, "force at which the interface begins to slide"),
        linear("force_share", "", 0.0, 1.0, "share of the stiffness that goes through the interface"),
        linear("marker_share", "", 0.0, 1.0, "share of the markers' motion that goes through the interface"),
        linear("return_share", "", 0.0, 1.0, "share of the markers' slip that goes back at once when the press eases"),
    ),
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import InterfaceSlip

    return {"slip": InterfaceSlip(values["limit"], values["force_share"])}


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    from wavemodel.integrators.scan import bounded_sum

    depth, limit = face.depth, _limit_depth(values, press)
    held = bounded_sum(np.diff(depth, prepend=0.0), np.full_like(depth, limit))
    at_once = values["return_share"]
    carried = (1.0 - at_once) * held + at_once * np.clip(depth, -limit, limit)
    return replace(face, depth=depth - values["marker_share"] * (depth - carried))


def _limit_depth(values: Values, press: PressHistory) -> float:
    """Depth, m, at which the elastic force reaches the limit; beyond the deepest where it never does."""
    push = _bare(press.elastic, values["force_share"], values["limit"])
    order = np.argsort(press.surface)
    depth, force = press.surface[order], np.maximum.accumulate(push[order])
    deepest = float(depth[-1])
    if values["limit"] >= force[-1]:
        return deepest * values["limit"] / max(float(force[-1]), 1e-12)
    return max(float(np.interp(values["limit"], force, depth)), 1e-3 * deepest)


def _bare(elastic: np.ndarray, share: float, limit: float) -> np.ndarray:
    """Elastic force (n,) N before the slip took its share: as F = (1 - s) f + s y while y stays at the limit."""
    if share >= 0.95:
        return elastic
    sliding = np.abs(elastic) > limit
    return np.where(sliding, (elastic - np.sign(elastic) * share * limit) / (1.0 - share), elastic)


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    marked = context.markers is not None
    kinds = ((0.0, 0.3, 0.0), (0.0, 0.3, 1.0), (0.1, 0.3, 0.5)) if marked else ((0.1, 0.0, 0.0),)
    names = ("force_share", "marker_share", "return_share")
    levels = (0.2, 0.45)
    return tuple(
        {"limit": r * context.peak_force, **dict(zip(names, kind, strict=True))} for r in levels for kind in kinds
    )


EFFECT = Effect(
    DESCRIPTION, "marker_share", body=_body, lower_face=_lower_face, starts=_starts, amplitudes=("force_share",)
)
