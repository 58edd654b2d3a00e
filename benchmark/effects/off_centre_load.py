"""Off-centre load: the tool axis is beside the marker grid's centre."""

from __future__ import annotations

from dataclasses import replace

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Effect, Press, Spread, Surroundings, Values

CARD = Card(
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


def _spread(values: Values, spread: Spread, press: Press, around: Surroundings) -> Spread:
    x, y = spread.centre
    return replace(spread, centre=(x + values["x_0"], y + values["y_0"]))


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    step = 0.1 * around.spacing
    return tuple({"x_0": step * x, "y_0": step * y} for x, y in ((1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7)))


EFFECT = Effect(CARD, "x_0", spread=_spread, starts=_starts, needs_markers=True, amplitudes=("y_0",))
