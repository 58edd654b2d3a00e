"""Cross-section of a tissue: layers to scale with thickness and stiffness, tool on top, support below."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from reports.blocks import Figure
from reports.figures.arrays import Floats
from reports.figures.style import INK, MUTED, PAPER, WIDE, draw
from reports.figures.tool_outline import ToolShape
from reports.formatting import format_number, shortened
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

__all__ = ["StackLayer", "layer_stack"]


_TISSUE, _TOOL = PALETTE["tissue"].light, PALETTE["tool"].light
_LEFT, _SECTION, _BELOW, _ABOVE, _LABEL = 58.0, 345.0, 50.0, 8.0, 40.0
_SUPPORTS = ("bonded", "hole", "half_space", "plates", "grips")


@dataclass(frozen=True)
class StackLayer:
    """A layer: its name, thickness in mm (None: endless) and Young's modulus in kPa."""

    name: str
    thickness_mm: float | None
    youngs_modulus_kPa: float

    def text(self) -> str:
        """Return thickness and stiffness as words."""
        thick = (
            "endless" if self.thickness_mm is None else f"{format_number(float(self.thickness_mm), 3, trim=True)} mm"
        )
        kilo = float(self.youngs_modulus_kPa)
        modulus = (
            f"{format_number(kilo / 1000, 3, trim=True)} MPa"
            if kilo >= 1000
            else f"{format_number(kilo, 3, trim=True)} kPa"
        )
        return f"{thick}, E = {modulus}"


@dataclass(frozen=True)
class CrossSection:
    """What is drawn: layers between `faces` in mm of depth, shape (L + 1,), and how wide, in mm."""

    layers: Sequence[StackLayer]
    faces: Floats
    tool: ToolShape
    half_width: float
    endless: bool
    hole_radius: float | None
    specimen_radius: float | None = None

    @classmethod
    def of(
        cls,
        layers: Sequence[StackLayer],
        tool: ToolShape,
        support: str,
        hole_radius: float | None,
        specimen_radius: float | None = None,
    ) -> CrossSection:
        """Return the section of a stack; an endless layer is drawn as deep as makes a good picture."""
        endless = support == "half_space" or layers[-1].thickness_mm is None
        given = [layer.thickness_mm or 0.0 for layer in layers]
        if endless:
            given[-1] = max(2.5 * tool.radius_mm, 0.8 * sum(given[:-1]))
        hole = hole_radius if support == "hole" else None
        half_width = max(2.6 * tool.radius_mm, 0.9 * sum(given), 1.25 * (hole or 0.0))
        if specimen_radius is not None:
            half_width = 1.3 * max(tool.radius_mm, specimen_radius)
        return cls(layers, np.cumsum([0.0, *given]), tool, half_width, endless, hole, specimen_radius)

    @property
    def depth(self) -> float:
        """Thickness of all that is drawn in mm."""
        return float(self.faces[-1])

    @property
    def top(self) -> float:
        """Height in mm of the drawing above the surface, which holds the tool."""
        return max(0.34 * self.depth, 1.3 * self.tool.edge_radius_mm)

    @property
    def bottom(self) -> float:
        """Depth in mm of the lower end of the drawing."""
        return (1.0 if self.endless else 1.13) * self.depth

    @property
    def section_height(self) -> float:
        """Height of the drawing without its margins in px, room for all labels included."""
        alike = (self.top + self.bottom) / (2 * self.half_width)
        return max(_SECTION * float(np.clip(alike, 0.6, 1.0)), _LABEL * (len(self.layers) + 1))

    @property
    def stretch(self) -> float:
        """Vertical scale over horizontal scale: 1 unless the section would be too flat or too tall."""
        return self.section_height / _SECTION * 2 * self.half_width / (self.top + self.bottom)

    @property
    def picture_height(self) -> float:
        """Height of the picture in px."""
        return self.section_height + _ABOVE + _BELOW


def paint_section(drawing: Drawing, section: CrossSection) -> None:
    """Draw a section with its depth axis on the left and the names of its layers on the right."""
    height = section.picture_height
    axes = drawing.add_axes((_LEFT / WIDE, _BELOW / height, _SECTION / WIDE, section.section_height / height))
    axes.set(xlim=(-section.half_width, section.half_width), ylim=(section.bottom, -section.top))
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set(xlabel="distance from the tool axis (mm)", ylabel="depth (mm)")
    axes.set_yticks([tick for tick in axes.get_yticks() if 0 <= tick <= section.depth])
    _paint_layers(axes, section)
    _paint_tool(axes, section)
    _paint_support(axes, section)
    _label_layers(axes, section)


def _paint_layers(axes: Axes, section: CrossSection) -> None:
    """Fill the layers, the stiffer the stronger, by the logarithm of Young's modulus."""
    from matplotlib.patches import Rectangle

    stiffness = np.log([layer.youngs_modulus_kPa for layer in section.layers])
    shades = 0.2 + 0.55 * (stiffness - stiffness.min()) / (np.ptp(stiffness) or 1.0)
    half = section.specimen_radius or section.half_width
    for top, bottom, shade in zip(section.faces[:-1], section.faces[1:], shades, strict=True):
        place = ((-half, top), 2.0 * half, bottom - top)
        axes.add_patch(Rectangle(*place, facecolor=_TISSUE, alpha=float(shade), linewidth=0, zorder=1))
        axes.plot([-half, half], [top, top], color=_TISSUE, linewidth=1, zorder=2)


def _paint_tool(axes: Axes, section: CrossSection) -> None:
    from matplotlib.patches import Polygon

    tool, height = section.tool, 0.82 * section.top
    corners = tool.outline(height)
    axes.add_patch(Polygon(corners, closed=True, facecolor=_TOOL, edgecolor="none", zorder=3))
    axes.annotate(
        f"tool, radius {format_number(float(tool.radius_mm), 3, trim=True)} mm",
        (corners[:, 0].max(), -0.5 * height),
        xytext=(8, 0),
        textcoords="offset points",
        va="center",
        color=MUTED,
    )
    axes.axvline(0, color=PAPER, linewidth=0.9, linestyle=(0, (6, 3, 1, 3)), zorder=4)


def _paint_support(axes: Axes, section: CrossSection) -> None:
    """Hatch the rigid base, with its hole; an endless layer ends in a dotted line instead."""
    depth, width = section.depth, section.half_width
    if section.endless:
        axes.axhline(depth, color=MUTED, linewidth=1.2, linestyle=(0, (1, 2)))
        return
    spans = [(-width, width)]
    if section.hole_radius is not None:
        spans = [(-width, -section.hole_radius), (section.hole_radius, width)]
    for left, right in spans:
        axes.fill_between([left, right], depth, section.bottom, facecolor="none", edgecolor=MUTED, hatch="////", lw=0)
        axes.plot([left, right], [depth, depth], color=INK, linewidth=1.6)


def _label_layers(axes: Axes, section: CrossSection) -> None:
    """Write names, thickness and stiffness beside the layers, moved apart where layers are thin."""
    scale = section.section_height / (section.top + section.bottom)
    middles = 0.5 * (section.faces[:-1] + section.faces[1:])
    places = spread(middles * scale, _LABEL, 0.5 * _LABEL - section.top * scale, section.bottom * scale) / scale
    edge, text = section.half_width, section.half_width * (1 + 2 * 26 / _SECTION)
    for layer, middle, place in zip(section.layers, middles, places, strict=True):
        axes.plot(
            [edge, 0.3 * edge + 0.7 * text, text],
            [middle, place, place],
            color=MUTED,
            linewidth=0.8,
            clip_on=False,
        )
        for words, offset, weight, colour in (
            (shortened(layer.name, 20), 8, "bold", INK),
            (layer.text(), -8, "normal", MUTED),
        ):
            axes.annotate(
                words,
                (text, place),
                xytext=(5, offset),
                textcoords="offset points",
                va="center",
                weight=weight,
                color=colour,
                annotation_clip=False,
            )


def spread(wanted: Floats, gap: float, low: float, high: float) -> Floats:
    """Return places at least `gap` apart between `low` and `high`, in order and near those wanted.

    Parameters
    ----------
    wanted
        Ascending places, shape (n,), with room for all of them: (n - 1) `gap` <= `high` - `low`.
    gap
        Least distance of neighbours, in the same unit.
    """
    offsets = gap * np.arange(len(wanted))
    down = np.maximum.accumulate(wanted - offsets)
    up = np.minimum.accumulate((wanted - offsets)[::-1])[::-1]
    return np.clip(0.5 * (down + up), low, high - offsets[-1]) + offsets


def layer_stack(
    layers: Sequence[StackLayer],
    tool: ToolShape,
    support: str = "bonded",
    hole_radius_mm: float | None = None,
    specimen_radius_mm: float | None = None,
) -> Figure:
    """Draw a tissue's cross-section through the tool axis, all thicknesses to scale.

    Parameters
    ----------
    layers
        From the surface down; only the last may be endless.
    tool
        What stands on it.
    support
        `bonded`, `hole` (needs `hole_radius_mm`), `half_space` (the last layer is endless), `plates` or `grips` (a
        cylinder; needs `specimen_radius_mm`).
    hole_radius_mm
        Radius in mm of the hole the stack lies over.
    specimen_radius_mm
        Radius in mm of a cylinder.

    Raises
    ------
    ValueError
        Without a layer, for a thickness, modulus or radius that is not above zero, or another support.
    """
    _check(layers, tool.radius_mm, support, hole_radius_mm)
    section = CrossSection.of(layers, tool, support, hole_radius_mm, specimen_radius_mm)
    held = _support_words(support, hole_radius_mm)
    caption = f"Cross-section through the tool axis, thicknesses to scale, stronger colour where stiffer; {held}."
    if abs(section.stretch - 1) > 0.05:
        caption += f" The vertical scale is {format_number(section.stretch, 2)} times the horizontal one."
    words = "From the surface down: " + "; ".join(f"{layer.name}, {layer.text()}" for layer in layers)
    radius = format_number(float(tool.radius_mm), 3, trim=True)
    words += f". A tool of {radius} mm radius ({tool.words}) stands on it; {held}."
    svg = draw(lambda drawing: paint_section(drawing, section), WIDE, section.picture_height, placed=True)
    return Figure.of(svg, caption, words, "Layers")


def _support_words(support: str, hole_radius_mm: float | None) -> str:
    if support == "half_space":
        return "the last layer is endless"
    if support in ("plates", "grips"):
        return f"a cylinder between two {support}, its side free"
    if hole_radius_mm is None or support == "bonded":
        return "its lower face is bonded to a rigid base"
    return f"it lies over a hole of {format_number(float(hole_radius_mm), 3, trim=True)} mm radius"


def _check(layers: Sequence[StackLayer], tool_radius: float, support: str, hole_radius: float | None) -> None:
    """Refuse what cannot be drawn."""
    if not layers:
        raise ValueError("layers is empty; at least one layer is needed")
    if support not in _SUPPORTS:
        raise ValueError(f"support is {support!r}; allowed: {', '.join(_SUPPORTS)}")
    if support == "hole" and hole_radius is None:
        raise ValueError("support 'hole' needs hole_radius_mm")
    if any(layer.thickness_mm is None for layer in layers[:-1]):
        raise ValueError("only the last layer may be endless (thickness_mm None)")
    values = [("tool_radius_mm", tool_radius), ("hole_radius_mm", hole_radius)]
    for layer in layers:
        values += [
            (f"thickness_mm of {layer.name}", layer.thickness_mm),
            (f"youngs_modulus_kPa of {layer.name}", layer.youngs_modulus_kPa),
        ]
    for name, value in values:
        if value is not None and not value > 0:
            raise ValueError(f"{name} is {value}; allowed: above 0")
