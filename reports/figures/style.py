"""The one look of all figures: sizes, type, strokes, the canvas, and the marks and lines that several figures share.

matplotlib is used through its object interface only and imported when something is drawn. One unit of a drawing is one
CSS pixel at natural size. `Pair` says how the two models of a comparison are drawn and called.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from reports.blocks import LiveLine
from reports.figures.arrays import Floats, stopped_at
from reports.formatting import format_number, shortened
from reports.palette import PALETTE, name_of
from reports.svg import themed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


LineStyle = str | tuple[float, tuple[float, ...]]
INK, MUTED, GRID, PAPER = (PALETTE[name].light for name in ("ink", "muted", "grid", "paper"))
WIDE, SMALL = 600, 340
LINE_WIDTH = 1.8
_TYPE_WIDE, _TYPE_SMALL = 13.2, 11.0  # wide pictures shrink on a narrow page
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
        "lines.linewidth": LINE_WIDTH,
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
LABEL_LENGTH = 24
_DOTTED = (0, (1, 2))
_SMALL_NOTE: Mapping[str, Any] = MappingProxyType({"textcoords": "offset points", "color": MUTED, "fontsize": "small"})


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
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure as Drawing

    stream = io.StringIO()
    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # a reader's own matplotlibrc must not change a report
        matplotlib.rcParams.update(_SETTINGS)
        matplotlib.rcParams["font.size"] = _TYPE_WIDE if width > SMALL else _TYPE_SMALL
        drawing = Drawing(figsize=(width / 72, height / 72), layout=None if placed else "constrained")
        paint(drawing)
        _plain_ticks(drawing)
        canvas: Any = FigureCanvasSVG(drawing)
        canvas.print_svg(stream, metadata={"Date": None})  # savefig would draw it twice
    return themed(stream.getvalue())


def _plain_ticks(drawing: Drawing) -> None:
    """Let every tick show its whole number as text.

    matplotlib writes decades as TeX, which is no text, and takes a common factor or offset out of the numbers of an
    axis, to its end, where it stands on the label and is easily overlooked.
    """
    from matplotlib.ticker import FuncFormatter, LogFormatterMathtext, NullFormatter, ScalarFormatter

    for axis in [axis for axes in drawing.axes for axis in (axes.xaxis, axes.yaxis)]:
        major, minor = axis.get_major_formatter(), axis.get_minor_formatter()
        if isinstance(major, LogFormatterMathtext):
            axis.set_major_formatter(FuncFormatter(_decade))
        elif isinstance(major, ScalarFormatter):
            major.format_ticks(axis.get_majorticklocs().tolist())
            if major.get_offset():
                axis.set_major_formatter(FuncFormatter(_whole))
        if isinstance(minor, LogFormatterMathtext):
            low, high = sorted(axis.get_view_interval())
            few = sum(low <= 10.0**power <= high for power in range(-20, 20)) < 2
            axis.set_minor_formatter(FuncFormatter(_first_digits) if few else NullFormatter())


def _decade(value: float, _: int | None = None) -> str:
    return format_number(value, 3, trim=True)


def _first_digits(value: float, _: int | None = None) -> str:
    """Of the ticks between decades those at twice and five times."""
    return _decade(value) if f"{value:e}"[0] in "25" else ""


def _whole(value: float, _: int | None = None) -> str:
    return format_number(value, 10, trim=True)


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


@dataclass(frozen=True)
class Pair:
    """The reference (drawn as the FEM) and the fast model beside it (drawn as the wave)."""

    fem: Stroke = FEM
    wave: Stroke = WAVE

    @classmethod
    def named(cls, fem: str | None = None, wave: str | None = None) -> Pair:
        """Return the pair with names of its own; None keeps the name."""
        return cls(_named(FEM, fem), _named(WAVE, wave))

    def stroke(self, name: str, other: Stroke) -> Stroke:
        """Return the look of the model `fem` or `wave`; of any other series that of `other`, under its own name."""
        return {"fem": self.fem, "wave": self.wave}.get(name) or replace(other, label=name, name=name)

    def caption(self, both: bool, fem: str = "solid", wave: str = "dashed") -> str:
        """Say which line is which model, or that the second one has no values."""
        if both:
            return f"{self.fem.name} ({fem}) and {self.wave.name} ({wave})"
        return f"{self.fem.name} alone; the {self.wave.name} has no values here"


DEFAULT = Pair()


def _named(stroke: Stroke, name: str | None) -> Stroke:
    return stroke if name is None else replace(stroke, label=shortened(name, LABEL_LENGTH), name=name)


def model_line(axes: Axes, x: Floats, y: Floats, stroke: Stroke, stops: bool = True) -> None:
    """Draw a model's line, with a cross where only NaN follows because the model stopped.

    Without `stops`, NaN at the end means that there is nothing to draw, not that the model stopped.
    """
    axes.plot(x, y, color=stroke.colour, linestyle=stroke.line, label=stroke.label, zorder=3)
    last = stopped_at(y) if stops else None
    if last is not None:
        stop_mark(axes, float(x[last]), float(y[last]), stroke)


def stop_mark(axes: Axes, x: float, y: float, stroke: Stroke) -> None:
    """Draw a cross where a model stopped, and say so beside it."""
    look: dict[str, Any] = {"marker": "X", "markersize": 9, "markeredgecolor": PAPER, "linestyle": "", "zorder": 4}
    axes.plot(x, y, color=stroke.colour, **look)
    place: dict[str, Any] = {"xytext": (8, 0), "textcoords": "offset points", "va": "center"}
    axes.annotate(f"{stroke.label} stopped", (x, y), color=stroke.colour, **place)


def planned_line(axes: Axes, y: float, text: str) -> None:
    """Draw a horizontal reference line with its name above its left end."""
    axes.axhline(y, color=MUTED, linewidth=1, linestyle=_DOTTED, zorder=1)
    axes.annotate(text, (0.01, y), xycoords=("axes fraction", "data"), xytext=(0, 3), **_SMALL_NOTE)


def edge_line(axes: Axes, x: float, text: str) -> None:
    """Draw a vertical reference line with its name along it."""
    axes.axvline(x, color=MUTED, linewidth=1, linestyle=_DOTTED, zorder=1)
    along: dict[str, Any] = {"rotation": 90, "va": "bottom", **_SMALL_NOTE}
    axes.annotate(text, (x, 0.04), xycoords=("data", "axes fraction"), xytext=(3, 0), **along)


def live_line(name: str, x: Floats, y: Floats, colour: str, line: LineStyle, width: float = LINE_WIDTH) -> LiveLine:
    """Return a line drawn in a light shade of the palette, solid or in dashes, as wide as in the drawing."""
    dash = () if isinstance(line, str) else line[1]
    return LiveLine(name, x, y, name_of(colour), dash, width)


def model_lines(pair: Pair, x: Floats, fem: Floats, wave: Floats | None) -> list[LiveLine]:
    """Return both models' lines; the second only where there is one."""
    lines = [live_line(pair.fem.label, x, fem, pair.fem.colour, pair.fem.line)]
    if wave is not None:
        lines.append(live_line(pair.wave.label, x, wave, pair.wave.colour, pair.wave.line))
    return lines
