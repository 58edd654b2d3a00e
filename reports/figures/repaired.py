"""A measured channel over time beside a model before and after its repair, with the noise as a band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, column, thinned
from reports.figures.style import (
    FEM,
    MEASURED,
    SMALL,
    TRIAL,
    WAVE,
    WIDE,
    Stroke,
    draw,
    heading,
    legend_above,
    zero_line,
)
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

BEFORE = Stroke("Before", WAVE.colour, WAVE.line, "s", "the model before")
AFTER = Stroke("After", FEM.colour, "-", "o", "the model after")
_BAND = 2.0


@dataclass(frozen=True)
class RepairedTrace:
    """One channel of one trial.

    Attributes
    ----------
    title
        What the panel is called.
    x
        Shape (n,), ascending or not: time in s, or whatever `x_label` says.
    measured, before, after
        Shape (n,) in `unit`, NaN where nothing was measured.
    noise
        Shape (n,): standard deviation of the replicates round their mean; zeros leave the band out.
    channel, unit
        Name of the channel and the unit of its values.
    x_label
        What `x` is, with its unit.
    """

    title: str
    x: Any
    measured: Any
    before: Any
    after: Any
    noise: Any
    channel: str
    unit: str
    x_label: str = "time (s)"
    arrays: tuple[Floats, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        x = column(f"{self.title}: x", self.x)
        rest = [
            column(f"{self.title}: {name}", getattr(self, name), x.size)
            for name in ("measured", "before", "after", "noise")
        ]
        object.__setattr__(self, "arrays", (x, *rest))


def repaired(traces: Sequence[RepairedTrace], changed: bool = True, measured: str = MEASURED.label) -> Figure:
    """Draw each trace in a panel: above the values, below measured minus model.

    Parameters
    ----------
    traces
        At least one.
    changed
        Whether the model was repaired; otherwise only `before` is drawn, as the model.
    measured
        What the measured line is called.

    Raises
    ------
    ValueError
        Without a trace, or for arrays of other shapes.
    """
    if not traces:
        raise ValueError("traces is empty; at least one trace is needed")
    several = len(traces) > 1
    panels = [
        Panel(
            draw(
                _Panel(trace, place if several else None, changed, measured).paint,
                *((SMALL, 370) if several else (WIDE, 430)),
            ),
            _words(trace, changed),
            trace.title,
        )
        for place, trace in enumerate(traces)
    ]
    banded = any(trace.arrays[4].any() for trace in traces)
    caption = f"{measured} values and the model"
    caption += " before (dashed) and after (solid) the effect was added" if changed else ""
    caption += f"; below, {measured if measured.isupper() else measured.lower()} minus model"
    caption += ", with the spread of the replicates (two standard deviations) as a band." if banded else "."
    return Figure(panels, caption, "Measured against simulated")


@dataclass(frozen=True)
class _Panel:
    trace: RepairedTrace
    place: int | None
    changed: bool
    measured: str

    def paint(self, drawing: Drawing) -> None:
        x, measured, before, after, noise = self.trace.arrays
        top, bottom = drawing.subplots(2, 1, sharex=True, height_ratios=(1.8, 1))
        top.plot(*thinned(x, measured), color=MEASURED.colour, linewidth=2.6, label=self.measured)
        zero_line(bottom)
        if noise.any():
            _band(bottom, x, noise)
        lines = [(before, BEFORE), (after, AFTER)] if self.changed else [(before, BEFORE)]
        for values, stroke in lines:
            label = stroke.label if self.changed else "Model"
            top.plot(*thinned(x, values), color=stroke.colour, linestyle=stroke.line, linewidth=1.6, label=label)
            bottom.plot(*thinned(x, measured - values), color=stroke.colour, linestyle=stroke.line, linewidth=1.3)
        top.set_ylabel(f"{self.trace.channel} ({self.trace.unit})")
        bottom.set_ylabel(f"residual ({self.trace.unit})")
        bottom.set_xlabel(self.trace.x_label)
        heading(top, self.trace.title, self.place, room=24)
        legend_above(top, 3)


def _band(axes: Axes, x: Floats, noise: Floats) -> None:
    order = np.argsort(x, kind="stable")
    wide = _BAND * noise[order]
    axes.fill_between(x[order], -wide, wide, color=TRIAL.colour, alpha=0.25, linewidth=0)


def _words(trace: RepairedTrace, changed: bool) -> str:
    _, measured, before, after, _ = trace.arrays
    text = f"{trace.title}: {trace.channel}, root mean square of measured minus model "
    text += f"{_rms(measured - before)} {trace.unit}"
    return text + (f" before and {_rms(measured - after)} {trace.unit} after." if changed else ".")


def _rms(values: Floats) -> str:
    present = values[np.isfinite(values)]
    return format_number(float(np.sqrt(np.mean(present**2))) if present.size else float("nan"), 3)
