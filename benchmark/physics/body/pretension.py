"""Pretension: a tension that is there before the press."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import pchip_interpolate

from benchmark.physics.description import EffectDescription, Option, linear
from benchmark.physics.effect import (
    Effect,
    FemTerm,
    LowerFaceMotion,
    NotInFemError,
    PressHistory,
    TableTerm,
    TrialContext,
    Values,
)

if TYPE_CHECKING:
    from fem import Problem
    from wavemodel import WaveLayer

DESCRIPTION = EffectDescription(
    slug="pretension",
    acts_on="body",
    sentence="The specimen was under tension before the press, which adds a stiffness that is there from the start.",
    equation="F = f(d) + k d; over a hole k = 2 pi S t / ln(R / a) (membrane), on a base k = (S / d) dF/dS "
    "of the layers; q times its share of F moves the lower face by t d / (2 r ln(R / a)). Over a hole that finite "
    "elements cover, discovery takes force and face from their own presses under S",
    source="Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, chapter 13; M. A. Biot, Mechanics of "
    "Incremental Deformations",
    parameters=(
        linear(
            "pretension",
            "Pa",
            0.0,
            5e6,
            "in-plane tensile stress S of all layers before the press",
            option=Option(0.0, 1e12),
        ),
        linear("field", "", 0.0, 2.0, "times q of what the tension moves that show in the lower face"),
    ),
    in_wave="in the plane of every layer or of the sheet; a finite-strain wave on a base as the stiffness k on top",
    in_fem="in-plane stress of all layers before the press, in axial symmetry and blocks",
    retired=(
        (
            "stiffness",
            "pretension is a stress in Pa, which a stiffness alone does not tell: run discover on the session again, "
            'or give the stress in its place, such as pretension = "20 kPa"',
        ),
    ),
)
PROBES = (1e2, 1e3, 1e4, 1e5, 1e6, 1e7)
"""Pa at which the stiffness of a tense base is worked out; between them k / S goes smoothly with the logarithm of S."""
UNKNOWN_MODULUS = 1e5
"""Pa of a single layer in place of unknown ones."""
STIFFEST = 1e6
"""N/m; the wave takes no more."""
SHALLOW = 1e-4
"""m; the layered wave of small strain is linear in depth."""


def added_stiffness(stress: float, context: TrialContext) -> float:
    """N/m that a pretension in Pa adds: a membrane's over a hole, the layered wave's in small strain on a base."""
    if math.isfinite(context.hole_radius):
        added = 2.0 * math.pi * stress * context.thickness / math.log(context.hole_radius / context.tool_radius)
    else:
        layers = context.layers or _one_layer(context.thickness)
        per_stress = _on_base(layers, context.tool_radius, context.contact)
        at = math.log(min(max(stress, PROBES[0]), PROBES[-1]))
        added = stress * float(pchip_interpolate(np.log(PROBES), per_stress, at))
    return min(added, STIFFEST)


def _one_layer(thickness: float) -> tuple[WaveLayer, ...]:
    from wavemodel import WaveLayer

    return (WaveLayer("specimen", thickness, 1000.0, UNKNOWN_MODULUS, 0.49),)


@lru_cache(maxsize=64)
def _on_base(layers: tuple[WaveLayer, ...], tool_radius: float, contact: str) -> tuple[float, ...]:
    """K / S in m at each of the probes; friction is taken to hold."""
    from wavemodel import DiscTool, LayeredWave

    sticks = "rigid_bonded" if contact == "rigid_frictional" else contact
    tool, depth = DiscTool(tool_radius, sticks), np.array([SHALLOW])

    def force(stress: float | None) -> float:
        return float(LayeredWave(layers, tool, support="bonded", pretension=stress, large_press="linear").law(depth)[0])

    bare = force(None)
    return tuple((force(stress) - bare) / (stress * SHALLOW) for stress in PROBES)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import Pretension

    if values["pretension"] <= 0.0:
        return {}
    return {"pretension": Pretension(added_stiffness(values["pretension"], context))}


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    """The tension's share of the force makes the dent a membrane's, whose slope is d / (r ln(R / a))."""
    if not math.isfinite(context.hole_radius):
        return face
    carried = added_stiffness(values["pretension"], context) * press.surface
    pressed = press.elastic > 1e-9 * context.peak_force
    share = np.divide(carried, press.elastic, out=np.zeros_like(carried), where=pressed)
    share = np.clip(values["field"] * np.clip(share, 0.0, 1.0), 0.0, 1.0)
    slope = face.depth / math.log(context.hole_radius / context.tool_radius)
    dent = 0.5 * context.thickness * share * slope
    return replace(face, passed=face.passed * (1.0 - share), dent=(dent, context.tool_radius))


def _in_fem(values: Values, problem: Problem, context: TrialContext) -> tuple[Problem, str]:
    if problem.geometry == "surface":
        raise NotInFemError("pretension is no part of the geometry surface, which has no plane to lie in")
    return replace(problem, pretension=values["pretension"]), ""


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    wanted = 0.1 * context.peak_force / context.peak_depth
    stress = wanted * PROBES[1] / added_stiffness(PROBES[1], context)
    return tuple({"pretension": stress, "field": part} for part in (0.3, 1.0))


EFFECT = Effect(
    DESCRIPTION,
    "pretension",
    body=_body,
    lower_face=_lower_face,
    starts=_starts,
    fem=FemTerm(("pretension",), _in_fem),
    native_in_wave=("pretension",),
    in_table=TableTerm("physics.pretension", "pretension", "field"),
)
