"""Adhesion: the tool is held on lift-off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic
from benchmark.physics.effect import Effect, FemTerm, Motion, NotInFemError, Readings, TrialContext, Values

if TYPE_CHECKING:
    from fem import Problem

RISE = 0.1
"""Share of its reach over which a tearing bond takes up its pull where a model file does not say."""

DESCRIPTION = EffectDescription(
    slug="adhesion",
    acts_on="body",
    sentence="The tissue sticks to the tool: lifting it takes a pull before it lets go.",
    equation="F = -f(|d|) above the surface until -F exceeds the pull-off force; a tearing bond adds "
    "-p min(|d| / (s r), (1 - |d| / r) / (1 - s))",
    needs=(("lift_off",),),
    source="K. Kendall 1971, J Phys D 4:1186; Geubelle and Baylor 1998, Compos B 29:589 (bilinear cohesive law)",
    parameters=(
        linear("tear", "N", 0.0, 100.0, "pull p of a bond that tears gradually"),
        logarithmic("reach", "m", 1e-5, 0.02, "height r above the surface at which that bond is gone"),
        linear("rise", "", 0.02, 0.98, "share s of that height over which its pull grows", RISE),
        linear(
            "adhesion_force",
            "N",
            0.0,
            100.0,
            "pull with which tissue that follows the tool holds it before it lets go",
            option=Option(0.0, 1e3),
            formerly="pull_off",
        ),
    ),
    may_lack=(("rise",),),
    in_wave="on top of its elastic law",
    in_fem="the contact of a rigid_frictionless or rigid_frictional tool in finite strain lets go at that pull",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import Adhesion

    return {"adhesion": Adhesion(values["adhesion_force"])}


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    from wavemodel.physics import Adhesion

    if values["tear"] <= 0.0:
        return readings
    height = -motion.depth / values["reach"]
    held = Adhesion(1.0).touching(motion.depth, height, False) & (height > 0.0)
    rise = values.get("rise", RISE)
    pull = values["tear"] * np.minimum(height / rise, np.maximum(1.0 - height, 0.0) / (1.0 - rise))
    return replace(readings, force=readings.force - np.where(held, pull, 0.0))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    peak, depth = context.peak_force, context.peak_depth
    tearing = {"tear": 0.05 * peak, "adhesion_force": 0.0}
    following = {"tear": 0.0, "reach": 0.2 * depth, "rise": RISE}
    return (
        *(tearing | {"reach": share * depth, "rise": rise} for share in (0.1, 0.2, 0.4) for rise in (RISE, 0.9)),
        *(following | {"adhesion_force": share * peak} for share in (0.015, 0.03, 0.06, 0.1, 0.2, 0.3)),
    )


def _in_fem(values: Values, problem: Problem, context: TrialContext) -> tuple[Problem, str]:
    if problem.tool.contact not in ("rigid_frictionless", "rigid_frictional") or problem.kinematics != "finite":
        raise NotInFemError("adhesion_force is part of rigid_frictionless and rigid_frictional tools in finite strain")
    if problem.geometry == "surface":
        raise NotInFemError("adhesion_force is not part of the geometry surface")
    return replace(problem, tool=replace(problem.tool, adhesion_force=values["adhesion_force"])), ""


EFFECT = Effect(
    DESCRIPTION,
    "tear",
    body=_body,
    observe=_observe,
    starts=_starts,
    amplitudes=("adhesion_force",),
    fem=FemTerm(("adhesion_force",), _in_fem, elastic=False),
)
