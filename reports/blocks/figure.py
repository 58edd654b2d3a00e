"""Figures: pictures with captions and descriptions in words."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from reports.blocks.base import Block
from reports.blocks.live import Live


@dataclass(frozen=True)
class Panel:
    """One picture of a figure: an SVG document, what it shows in words, and what it becomes where JavaScript runs."""

    svg: str
    alt: str
    title: str = ""
    live: Live | None = None


SIGNATURES = {b"\x89PNG\r\n\x1a\n": "image/png", b"GIF87a": "image/gif", b"GIF89a": "image/gif"}


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
        kind = next(kind for start, kind in SIGNATURES.items() if self.data.startswith(start))
        return f"data:{kind};base64,{base64.b64encode(self.data).decode('ascii')}"


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
