"""The picture of the pressed tissue in a run's report, or what is missing for it.

It is drawn in a process of its own, because a graphics driver that is missing can end the process.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from bench_hw.storage.folder_lock import scratch
from benchmark.files import Scenario
from benchmark.models.model_result import FieldSnapshot
from benchmark.runs.fields import missing_vtk, save_grid
from benchmark.runs.record import RunRecord
from reports import Block, Figure, Paragraph, write_bytes, write_text

PACKAGES = "libegl1 libegl-mesa0"
"""Debian packages that bring off-screen rendering."""

SECONDS = 180.0
DRAWING = Path(__file__).with_name("picture_drawing.py")
"""Started by its path, which with -P takes no module from the current folder."""


@dataclass(frozen=True)
class Drawn:
    """The picture as PNG, or why there is none, in one sentence."""

    png: bytes
    reason: str = ""


def draw_pressed(snapshot: FieldSnapshot, axis: tuple[float, float], reach: float) -> Drawn:
    """Draw the deformed body of a snapshot.

    Parameters
    ----------
    snapshot
        Fields of the press.
    axis
        (x, y) in m of the tool's axis.
    reach
        Distance in m from it up to which plane layers are shown.
    """
    missing = missing_vtk()
    if missing is not None:
        return Drawn(b"", missing)
    with scratch() as folder:
        vtu, png = folder / "pressed.vtu", folder / "pressed.png"
        save_grid(snapshot, vtu)
        place = [repr(value) for value in (*axis, reach)]
        command = [sys.executable, "-P", str(DRAWING), str(vtu), str(png), *place]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            return Drawn(b"", f"the drawing was given up ({type(error).__name__})")
        if done.returncode != 0 or not png.is_file():
            return Drawn(b"", _reason(done.returncode, done.stderr))
        return Drawn(png.read_bytes())


def _reason(code: int, said: str) -> str:
    lines = [line for line in said.splitlines() if line.strip()]
    last = f": {lines[-1].strip()[:200]}" if lines else ""
    return f"off-screen rendering failed (exit code {code}{last})"


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
    if not drawn.png and "not installed" in drawn.reason:
        return Paragraph(f"No picture of the pressed tissue and no files of its fields: {drawn.reason}.")
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
