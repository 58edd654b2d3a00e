"""The picture of the pressed tissue in a run's report, or what is missing for it."""

from __future__ import annotations

from benchmark.files import Scenario
from benchmark.models import FieldSnapshot
from benchmark.picture import PACKAGES, draw_pressed
from benchmark.runs.record import RunRecord
from reports import Block, Figure, Paragraph, Picture

REACH = 4.0
"""Tool radii round its axis that are shown."""

SHOWN = {
    "axisymmetric": "Three quarters of the round body near the tool",
    "block": "The computed part of the block near the tool",
    "surface": "The body, cut open at the tool's axis",
}


def pressed_picture(record: RunRecord) -> Block | None:
    """The deformed tissue at the largest load; None where no fields were computed."""
    fem = record.pair.fem.result
    shown = None if fem is None else next((each for each in fem.fields if each.step == fem.peak_step), None)
    if shown is None:
        return None
    scenario = record.scenario
    drawn = draw_pressed(shown, _axis(scenario), REACH * scenario.tool.radius)
    if not drawn.png:
        return Paragraph(
            f"No picture of the pressed tissue: {drawn.reason}. On Debian the packages {PACKAGES} bring off-screen "
            f"rendering; the fields are in fields/{_file(shown)} for ParaView.",
        )
    what = SHOWN[scenario.fem.geometry]
    caption = (
        f"{what}, deformed without magnification at step {shown.step + 1}, coloured by the FEM's deflection; "
        f"lines part the layers. The same fields are in fields/{_file(shown)}."
    )
    alt = f"{what}, pressed by the tool; the deflection is largest under it."
    return Figure((Picture(drawn.png, alt),), caption, "Pressed tissue")


def _axis(scenario: Scenario) -> tuple[float, float]:
    return (0.0, 0.0) if scenario.fem.geometry == "axisymmetric" else scenario.tool.position


def _file(snapshot: FieldSnapshot) -> str:
    return f"step_{snapshot.step + 1:04d}.vtu"
