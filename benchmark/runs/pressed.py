"""The picture of the pressed tissue in a run's report, or what is missing for it."""

from __future__ import annotations

from pathlib import Path

from benchmark.files import Scenario
from benchmark.picture import PACKAGES, Drawn, draw_pressed
from benchmark.runs.record import RunRecord
from reports import Block, Figure, Paragraph, write_bytes, write_text

PICTURE, REASON = "pictures/pressed.png", "pictures/pressed.txt"
REACH = 4.0
"""Tool radii round its axis that are shown."""

SHOWN = {
    "axisymmetric": "Three quarters of the round body near the tool",
    "block": "The computed part of the block near the tool",
    "surface": "The body, cut open at the tool's axis",
}


def draw(record: RunRecord) -> Drawn | None:
    """Draw the deformed tissue at the largest load; None where no fields were computed."""
    fem = record.pair.fem.result
    shown = None if fem is None else next((each for each in fem.fields if each.step == fem.peak_step), None)
    if shown is None:
        return None
    return draw_pressed(shown, _axis(record.scenario), REACH * record.scenario.tool.radius)


def pressed_picture(record: RunRecord, drawn: Drawn | None) -> Block | None:
    """What the page shows of it: the picture, or why there is none; None where no fields were computed."""
    fem = record.pair.fem.result
    if drawn is None or fem is None:
        return None
    file = f"fields/step_{fem.peak_step + 1:04d}.vtu"
    if not drawn.png:
        return Paragraph(
            f"No picture of the pressed tissue: {drawn.reason}. On Debian the packages {PACKAGES} bring off-screen "
            f"rendering; the fields are in {file} for ParaView.",
        )
    what = SHOWN[record.scenario.fem.geometry]
    caption = (
        f"{what}, deformed without magnification at step {fem.peak_step + 1}, coloured by the FEM's deflection; "
        f"lines part the layers. The same fields are in {file}."
    )
    alt = f"{what}, pressed by the tool; the deflection is largest under it."
    return Figure.of_picture(drawn.png, caption, alt, "Pressed tissue")


def write_drawn(folder: Path, drawn: Drawn | None) -> None:
    """Keep the picture, or why there is none, in a result folder, so that the page can be made again."""
    if drawn is not None and drawn.png:
        write_bytes(folder / PICTURE, drawn.png)
    elif drawn is not None:
        write_text(folder / REASON, drawn.reason)


def read_drawn(folder: Path) -> Drawn | None:
    """What `write_drawn` kept."""
    if (folder / PICTURE).is_file():
        return Drawn((folder / PICTURE).read_bytes())
    return Drawn(b"", (folder / REASON).read_text(encoding="utf-8")) if (folder / REASON).is_file() else None


def _axis(scenario: Scenario) -> tuple[float, float]:
    return (0.0, 0.0) if scenario.fem.geometry == "axisymmetric" else scenario.tool.position
