"""Figures: pictures with captions and descriptions in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from reports.blocks.base import Block


@dataclass(frozen=True)
class Panel:
    """One picture of a figure: an SVG document and what it shows, in words."""

    svg: str
    alt: str
    title: str = ""


@dataclass(frozen=True)
class Picture:
    """One picture of a figure that no lines can draw: a PNG file's bytes and what it shows, in words."""

    png: bytes
    alt: str
    title: str = ""


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

    @classmethod
    def of(cls, svg: str, caption: str, alt: str, title: str = "") -> Figure:
        """Return a figure of a single picture."""
        return cls(panels=(Panel(svg, alt, title),), caption=caption, title=title)
