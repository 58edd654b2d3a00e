"""Interface slip: layers slide over each other beyond a shear limit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic, option
from benchmark.physics.effect import Effect, FemTerm, LowerFaceMotion, NotInFemError, PressHistory, TrialContext, Values

if TYPE_CHECKING:
    from fem import Problem

SHEAR_LIMITS = ("interface_shear_limit", "clamp_shear_limit")

DESCRIPTION = EffectDescription(
    slug="interface_slip",
    acts_on="body",
    sentence="Layers slide over each other beyond a shear limit: the lower face is carried along less than it should.",
    equation="F = (1 - s) f + y, y follows s f within +-s F_s; the markers' part q of the depth follows within +-d_s, "
    "f(d_s) = F_s; a share of the slip may go back at once",
    needs=(("interface",), ("unloading",)),
    source="W. D. Iwan 1966, J Appl Mech 33:893 (Jenkin element)",
    parameters=(
        logarithmic(
            "slip_force",
            "N",
            1e-4,
            1e3,
            "force F_s on the tool at which an interface begins to slide",
            option=Option(0.0, 1e3, above=True),
            formerly="limit",
        ),
        linear(
            "slip_share",
            "",
            0.0,
            1.0,
            "share s of the stiffness that goes through that interface",
            option=Option(0.0, 1.0),
            formerly="force_share",
        ),
        linear("marker_share", "", 0.0, 1.0, "share of the markers' motion that goes through the interface"),
        linear("return_share", "", 0.0, 1.0, "share of the markers' slip that goes back at once when the press eases"),
    ),
    options=(
        option(
            "interface_shear_limit",
            "Pa",
            0.0,
            1e12,
            "shear stress at which layers begin to slide on each other: every interface, where it comes to it, in the "
            "FEM; the interface that comes to it first, as a whole, in the layered wave",
        ),
        option(
            "clamp_shear_limit",
            "Pa",
            0.0,
            1e12,
            "shear stress at which a sheet over a hole begins to slide on the plate round it",
        ),
    ),
    in_wave="slip_force and slip_share on top of its elastic law; interface_shear_limit between the layers on a base",
    in_fem="the shear limits by its interfaces and clamp, in axial symmetry; slip_force and slip_share quasi-linear",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import InterfaceSlip

    return {"slip": InterfaceSlip(values["slip_force"], values["slip_share"])}


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    from wavemodel.integrators.scan import bounded_sum

    depth, limit = face.depth, _limit_depth(values, press)
    held = bounded_sum(np.diff(depth, prepend=0.0), np.full_like(depth, limit))
    at_once = values["return_share"]
    carried = (1.0 - at_once) * held + at_once * np.clip(depth, -limit, limit)
    return replace(face, depth=depth - values["marker_share"] * (depth - carried))


def _limit_depth(values: Values, press: PressHistory) -> float:
    """Depth, m, at which the elastic force reaches the limit; beyond the deepest where it never does."""
    push = _bare(press.elastic, values["slip_share"], values["slip_force"])
    order = np.argsort(press.surface)
    depth, force = press.surface[order], np.maximum.accumulate(push[order])
    deepest = float(depth[-1])
    if values["slip_force"] >= force[-1]:
        return deepest * values["slip_force"] / max(float(force[-1]), 1e-12)
    return max(float(np.interp(values["slip_force"], force, depth)), 1e-3 * deepest)


def _bare(elastic: np.ndarray, share: float, limit: float) -> np.ndarray:
    """Elastic force (n,) N before the slip took its share: as F = (1 - s) f + s y while y stays at the limit."""
    if share >= 0.95:
        return elastic
    sliding = np.abs(elastic) > limit
    return np.where(sliding, (elastic - np.sign(elastic) * share * limit) / (1.0 - share), elastic)


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    marked = context.markers is not None
    kinds = ((0.0, 0.3, 0.0), (0.0, 0.3, 1.0), (0.1, 0.3, 0.5)) if marked else ((0.1, 0.0, 0.0),)
    names = ("slip_share", "marker_share", "return_share")
    levels = (0.2, 0.45)
    return tuple(
        {"slip_force": r * context.peak_force, **dict(zip(names, kind, strict=True))} for r in levels for kind in kinds
    )


def _in_fem(values: Values, problem: Problem, context: TrialContext) -> tuple[Problem, str]:
    interface, clamp = (values.get(name) for name in SHEAR_LIMITS)
    if interface is not None:
        if problem.geometry != "axisymmetric" or (problem.kinematics == "linear" and interface > 0.0):
            raise NotInFemError(
                "the option physics.interface_shear_limit is part of axisymmetric geometry only, in finite strain or "
                "without friction (0 Pa)"
            )
        problem = replace(problem, interface_shear_limit=interface)
    if clamp is not None:
        if (problem.support.kind, problem.kinematics, problem.geometry) != ("hole", "finite", "axisymmetric"):
            raise NotInFemError(
                "the option physics.clamp_shear_limit is part of a hole in finite strain and axisymmetric geometry only"
            )
        problem = replace(problem, support=replace(problem.support, clamp_shear_limit=clamp))
    return problem, ""


EFFECT = Effect(
    DESCRIPTION,
    "marker_share",
    body=_body,
    lower_face=_lower_face,
    remembers=True,
    seen_by="marker_share",
    starts=_starts,
    amplitudes=("slip_share",),
    fem=FemTerm(SHEAR_LIMITS, _in_fem),
    native_in_wave=SHEAR_LIMITS[:1],
)
