"""Figures: pictures with captions and descriptions in words, and what they become where JavaScript runs.

Plots to zoom and bodies to turn are plain data; `templates/live.js` draws them. The picture itself stays the one for
paper and for readers without JavaScript.
"""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from reports.blocks.text import Block

DIGITS = 6
SIGNATURES = {b"\x89PNG\r\n\x1a\n": "image/png", b"GIF87a": "image/gif", b"GIF89a": "image/gif"}


@dataclass(frozen=True)
class LiveLine:
    """A line: its name in the legend, abscissa and ordinate (n,) with NaN for no value, and its look.

    `colour` is a name of `reports.palette`; `dash` holds lengths in line widths, none for a solid line; `width` is in
    CSS pixels, and a narrow line lies on a wide one.
    """

    name: str
    x: Iterable[float]
    y: Iterable[float]
    colour: str
    dash: Sequence[float] = ()
    width: float = 2.0

    def to_dict(self) -> dict[str, Any]:
        """Plain lists."""
        dash = ",".join(f"{self.width * part:.4g}px" for part in self.dash) or "solid"
        look = {"colour": self.colour, "dash": dash, "width": self.width}
        return {"name": self.name, "x": plain(self.x), "y": plain(self.y), **look}


@dataclass(frozen=True)
class LiveAxes:
    """Lines over one ordinate; `downwards` where it points down, as a dent does."""

    label: str
    lines: Sequence[LiveLine]
    downwards: bool = False


@dataclass(frozen=True)
class LivePlot:
    """A plot to zoom.

    Attributes
    ----------
    x_label
        What the abscissa is, with its unit.
    axes
        One above the other, over the same abscissa.
    marks
        Places on the abscissa with a name, such as the tool's edge.
    """

    kind: ClassVar[str] = "plot"
    x_label: str
    axes: Sequence[LiveAxes]
    marks: Sequence[tuple[float, str]] = ()

    def to_dict(self) -> dict[str, Any]:
        """Plain lists and tables."""
        axes = [
            {"label": each.label, "downwards": each.downwards, "lines": [line.to_dict() for line in each.lines]}
            for each in self.axes
        ]
        return {"kind": self.kind, "x_label": self.x_label, "axes": axes, "marks": [list(mark) for mark in self.marks]}


@dataclass(frozen=True)
class LiveFace:
    """The top face of a layer: its height in mm over the radius and the value that colours it, (m,) each.

    `below` is the height of what ends the layer downwards; without it only the face is shown.
    """

    name: str
    height: Iterable[float]
    value: Iterable[float]
    below: Iterable[float] | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain lists."""
        below = None if self.below is None else plain(self.below)
        return {"name": self.name, "height": plain(self.height), "value": plain(self.value), "below": below}


@dataclass(frozen=True)
class LiveBody:
    """A body of revolution to turn, three quarters of it.

    Attributes
    ----------
    radius
        (m,) distances in mm from the axis, rising.
    faces
        Of the layers from the surface down.
    value_label
        What colours the faces, with its unit.
    limit
        The largest value of the scale; the smallest is zero.
    ring
        Radius in mm of a circle on the surface, the tool's edge.
    """

    kind: ClassVar[str] = "body"
    radius: Iterable[float]
    faces: Sequence[LiveFace]
    value_label: str
    limit: float
    ring: float

    def to_dict(self) -> dict[str, Any]:
        """Plain lists and tables."""
        limit, ring = plain((self.limit, self.ring))
        return {
            "kind": self.kind,
            "radius": plain(self.radius),
            "faces": [face.to_dict() for face in self.faces],
            "value_label": self.value_label,
            "limit": limit,
            "ring": ring,
        }


Live = LivePlot | LiveBody


def plain(values: Iterable[float]) -> list[float | None]:
    """Numbers with six digits, as many as a screen shows; None for NaN."""
    return [float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None for value in map(float, values)]


@dataclass(frozen=True)
class Panel:
    """One picture of a figure: an SVG document, what it shows in words, and what it becomes where JavaScript runs."""

    svg: str
    alt: str
    title: str = ""
    live: Live | None = None


@dataclass(frozen=True)
class Picture:
    """One picture of a figure that no lines can draw, still (PNG) or moving (GIF), and what it shows, in words.

    Raises
    ------
    ValueError
        If the file's bytes are neither.
    """

    data: bytes
    alt: str
    title: str = ""

    def __post_init__(self) -> None:
        if not self.data.startswith(tuple(SIGNATURES)):
            raise ValueError("a picture's bytes are no PNG and no GIF")

    @property
    def address(self) -> str:
        """The picture as a data address, which fetches nothing."""
        return _address(self.data)

    @property
    def still(self) -> str | None:
        """The address of a picture from the middle of a moving one; None for one that does not move."""
        if self.data.startswith(b"\x89PNG"):
            return None
        from PIL import Image

        stream = io.BytesIO()
        with Image.open(io.BytesIO(self.data)) as movie:
            frames = getattr(movie, "n_frames", 1)
            movie.seek(frames // 2)
            movie.save(stream, "PNG", optimize=True)
        return _address(stream.getvalue()) if frames > 1 else None


def _address(data: bytes) -> str:
    kind = next(kind for start, kind in SIGNATURES.items() if data.startswith(start))
    return f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"


@dataclass(frozen=True)
class Figure(Block):
    """One or several pictures with a common caption.

    Attributes
    ----------
    panels
        The pictures, in order; several stand side by side and wrap on a narrow page.
    caption
        What is seen, with units and what is compared with what.
    title
        Its name, set before the caption.
    """

    template: ClassVar[str] = "figure"
    counter: ClassVar[str] = "Figure"
    panels: Sequence[Panel | Picture]
    caption: str
    title: str = ""

    @property
    def is_live(self) -> bool:
        """Whether any picture of it can be zoomed or turned."""
        return any(isinstance(panel, Panel) and panel.live is not None for panel in self.panels)

    @classmethod
    def of(cls, svg: str, caption: str, alt: str, title: str = "", live: Live | None = None) -> Figure:
        """Return a figure of a single drawing."""
        return cls(panels=(Panel(svg, alt, title, live),), caption=caption, title=title)

    @classmethod
    def of_picture(cls, data: bytes, caption: str, alt: str, title: str = "") -> Figure:
        """Return a figure of a single PNG or GIF."""
        return cls(panels=(Picture(data, alt, title),), caption=caption, title=title)


@dataclass(frozen=True)
class StoryStep:
    """A step of a story: the question, its answer in a few words, and a sentence or two of detail."""

    question: str
    answer: str
    detail: str = ""


@dataclass(frozen=True)
class Story:
    """What a page tells on one screen: the one picture that shows it, and the steps beside it, in order."""

    figure: Figure
    steps: Sequence[StoryStep]
