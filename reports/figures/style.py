"""The one look of all figures: sizes, type, strokes, and the canvas they are drawn on.

matplotlib is used through its object interface only and imported when something is drawn. One unit of a
drawing is one CSS pixel at natural size.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from reports.figures.theme import themed
from reports.formatting import shortened
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

LineStyle = str | tuple[float, tuple[float, ...]]
INK, MUTED, GRID, PAPER = (PALETTE[name].light for name in ("ink", "muted", "grid", "paper"))
WIDE, SMALL = 600, 340
_TYPE_WIDE, _TYPE_SMALL = 13.2, 11.0  # wide pictures shrink on a narrow page


@dataclass(frozen=True)
class Stroke:
    """How a series is drawn, never by colour alone: its label, colour, line style, marker and name in a sentence."""

    label: str
    colour: str
    line: LineStyle
    marker: str
    name: str


FEM = Stroke("FEM", PALETTE["fem"].light, "-", "o", "FEM")
WAVE = Stroke("Wave", PALETTE["wave"].light, (0, (4, 1.8)), "s", "wave model")
MEASURED = Stroke("Measured", PALETTE["measured"].light, "-", "D", "measured")
TRIAL = Stroke("Trial", PALETTE["trial"].light, "-", "o", "trial")

_SETTINGS: Mapping[Any, Any] = MappingProxyType(
    {
        "svg.fonttype": "none",
        "svg.hashsalt": "reports",
        "text.parse_math": False,
        "axes.formatter.use_mathtext": False,
        "axes.formatter.limits": (-4, 5),
        "figure.dpi": 72,
        "font.family": "DejaVu Sans",
        "axes.titlesize": "large",
        "axes.titleweight": "bold",
        "axes.labelsize": "medium",
        "xtick.labelsize": "medium",
        "ytick.labelsize": "medium",
        "legend.fontsize": "medium",
        "text.color": INK,
        "axes.titlecolor": INK,
        "axes.labelcolor": MUTED,
        "axes.edgecolor": MUTED,
        "axes.facecolor": "none",
        "figure.facecolor": "none",
        "savefig.facecolor": "none",
        "xtick.color": MUTED,
        "ytick.color": MUTED,
        "axes.linewidth": 0.9,
        "axes.axisbelow": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": GRID,
        "grid.linewidth": 0.8,
        "xtick.major.size": 4,
        "ytick.major.size": 0,
        "xtick.minor.size": 0,
        "ytick.minor.size": 0,
        "ytick.major.pad": 5,
        "lines.linewidth": 1.8,
        "lines.solid_capstyle": "round",
        "lines.dash_capstyle": "butt",
        "legend.frameon": False,
        "legend.handlelength": 2.1,
        "legend.handletextpad": 0.55,
        "legend.columnspacing": 1.5,
        "legend.borderpad": 0,
        "legend.borderaxespad": 0.35,
        "hatch.linewidth": 0.8,
        "figure.constrained_layout.w_pad": 0.03,
        "figure.constrained_layout.h_pad": 0.04,
    }
)


def draw(paint: Callable[[Drawing], None], width: float = WIDE, height: float = 360, placed: bool = False) -> str:
    """Return what `paint` draws on a transparent canvas as SVG text that follows the page.

    Equal drawings give equal text, byte for byte.

    Parameters
    ----------
    paint
        Called with an empty matplotlib figure.
    width, height
        Natural size in CSS pixels.
    placed
        Whether `paint` places its axes itself, instead of matplotlib's constrained layout.

    Raises
    ------
    ValueError
        If a colour outside `reports.palette` is used.
    """
    import matplotlib
    from matplotlib.figure import Figure as Drawing

    stream = io.StringIO()
    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # a reader's own matplotlibrc must not change a report
        matplotlib.rcParams.update(_SETTINGS)
        matplotlib.rcParams["font.size"] = _TYPE_WIDE if width > SMALL else _TYPE_SMALL
        drawing = Drawing(figsize=(width / 72, height / 72), layout=None if placed else "constrained")
        paint(drawing)
        drawing.savefig(stream, format="svg", metadata={"Date": None})
    return themed(stream.getvalue())


def heading(axes: Axes, text: str, position: int | None = None, room: float = 8) -> None:
    """Write a title at the upper left, after the letter of its panel, `room` px up; a long one is cut."""
    letter = "" if position is None else f"({panel_letter(position)}) "
    width = axes.figure.bbox.width
    axes.set_title(letter + shortened(text, int(width / 10) - len(letter)), loc="left", pad=room)


def panel_letter(position: int) -> str:
    """Return a, b, ..., z, aa, ab, ... for 0, 1, ..."""
    first, last = divmod(position, 26)
    return (chr(ord("a") + first - 1) if first else "") + chr(ord("a") + last)


def legend_above(axes: Axes, columns: int = 4) -> None:
    """Put the legend in a row between title and axes, where it hides nothing."""
    handles, labels = axes.get_legend_handles_labels()
    if handles:
        axes.legend(handles, labels, loc="lower left", bbox_to_anchor=(0, 1), ncols=columns)


def zero_line(axes: Axes) -> None:
    """Draw the line of zero difference."""
    axes.axhline(0, color=MUTED, linewidth=0.9, zorder=1)
