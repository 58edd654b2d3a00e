"""Off-centre load: the tool axis is beside the marker grid's centre."""

from __future__ import annotations

from dataclasses import replace

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, LowerFaceMotion, PressHistory, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="off_centre_load",
    acts_on="drive",
    sentence="The tool axis is beside the centre of the marker grid: the markers' field is not centred.",
    equation="u(x, y) -> u(x - x_0, y - y_0)",
    source="translation of the set-up",
    parameters=(
        linear("x_0", "m", -0.02, 0.02, "tool axis along x from the grid's centre"),
        linear("y_0", "m", -0.02, 0.02, "tool axis along y from the grid's centre"),
    ),
)


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    x, y = face.centre
    return replace(face, centre=(x + values["x_0"], y + values["y_0"]))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    step = 0.1 * context.spacing
    return tuple({"x_0": step * x, "y_0": step * y} for x, y in ((1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7)))


EFFECT = Effect(DESCRIPTION, "x_0", lower_face=_lower_face, starts=_starts, needs_markers=True, amplitudes=("y_0",))
