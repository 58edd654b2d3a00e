"""The load over time, and what the models answered to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from reports.blocks import Figure
from reports.figures.arrays import column, optional_column, peak, stopped_at
from reports.figures.marks import model_line
from reports.figures.pair import DEFAULT, Pair
from reports.figures.style import INK, WIDE, draw, legend_above
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_AXIS = {"force": "force (N)", "depth": "depth (mm)"}
_OTHER = {"force": "depth", "depth": "force"}


def load_history(
    time_s: Any, load: Any, control: str, fem: Any = None, wave: Any = None, pair: Pair = DEFAULT
) -> Figure:
    """Draw the prescribed load over time and, under it, the answer of the models.

    Parameters
    ----------
    time_s
        Instants of the steps in s, shape (n,).
    load
        Prescribed force in N or depth in mm, shape (n,).
    control
        `force` or `depth`: which of the two is prescribed.
    fem, wave
        The other of the two, depth in mm or force in N, shape (n,), NaN after the step a model stopped
        at; None without the model.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For another word than `force` or `depth`, arrays of other shapes, or infinite values.
    """
    if control not in _AXIS:
        raise ValueError(f"control is {control!r}; allowed: {', '.join(_AXIS)}")
    time = column("time_s", time_s)
    load = column("load", load, len(time))
    answers = [
        (values, stroke)
        for values, stroke in (
            (optional_column("fem", fem, len(time)), pair.fem),
            (optional_column("wave", wave, len(time)), pair.wave),
        )
        if values is not None
    ]

    def paint(drawing: Drawing) -> None:
        axes = drawing.subplots(2 if answers else 1, 1, sharex=True, squeeze=False)[:, 0]
        few = len(time) <= 150
        axes[0].plot(time, load, color=INK, marker="." if few else "", markersize=3.5, linewidth=1.2)
        axes[0].set_ylabel(_AXIS[control])
        for values, stroke in answers:
            model_line(axes[1], time, values, stroke)
            axes[1].set_ylabel(_AXIS[_OTHER[control]])
        axes[-1].set_xlabel("time (s)")
        legend_above(axes[-1])

    unit = {"force": "N", "depth": "mm"}[control]
    words = f"The prescribed {control} peaks at {format_number(peak(load), 3)} {unit} in {len(time)} steps."
    caption = f"Prescribed {control} over time, a dot a step" if len(time) <= 150 else f"Prescribed {control} over time"
    caption += f"; below, the {_OTHER[control]} the models answer with." if answers else "."
    caption += "".join(
        f" The {stroke.label} stopped early." for values, stroke in answers if stopped_at(values) is not None
    )
    return Figure.of(draw(paint, WIDE, 420 if answers else 260), caption, words, "Load history")
