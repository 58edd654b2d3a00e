"""The lines of a drawing as lines to zoom, with the same look."""

from __future__ import annotations

from reports.blocks import LiveLine
from reports.figures.arrays import Floats
from reports.figures.pair import Pair
from reports.figures.style import LineStyle
from reports.palette import name_of


def live_line(name: str, x: Floats, y: Floats, colour: str, line: LineStyle) -> LiveLine:
    """Return a line drawn in a light shade of the palette, solid or in dashes."""
    dash = () if isinstance(line, str) else line[1]
    return LiveLine(name, x, y, name_of(colour), dash)


def model_lines(pair: Pair, x: Floats, fem: Floats, wave: Floats | None) -> list[LiveLine]:
    """Return both models' lines; the second only where there is one."""
    lines = [live_line(pair.fem.label, x, fem, pair.fem.colour, pair.fem.line)]
    if wave is not None:
        lines.append(live_line(pair.wave.label, x, wave, pair.wave.colour, pair.wave.line))
    return lines
