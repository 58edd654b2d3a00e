"""Cross-section of a tissue: layers to scale with thickness and stiffness, tool on top, support below.

The face of the figure is here, its geometry and strokes are in `reports.figures.section`.
"""

from __future__ import annotations

from collections.abc import Sequence

from reports.blocks import Figure
from reports.figures.section import Section, StackLayer, paint_section
from reports.figures.style import WIDE, draw
from reports.formatting import format_number

__all__ = ["StackLayer", "layer_stack"]

_SUPPORTS = ("bonded", "hole", "half_space")


def layer_stack(
    layers: Sequence[StackLayer],
    tool_radius_mm: float,
    support: str = "bonded",
    hole_radius_mm: float | None = None,
) -> Figure:
    """Draw a tissue's cross-section through the tool axis, all thicknesses to scale.

    Parameters
    ----------
    layers
        From the surface down; only the last may be endless.
    tool_radius_mm
        Radius of the tool in mm.
    support
        `bonded`, `hole` (needs `hole_radius_mm`) or `half_space` (the last layer is endless).
    hole_radius_mm
        Radius in mm of the hole the stack lies over.

    Raises
    ------
    ValueError
        Without a layer, for a thickness, modulus or radius that is not above zero, or another support.
    """
    _check(layers, tool_radius_mm, support, hole_radius_mm)
    section = Section.of(layers, tool_radius_mm, support, hole_radius_mm)
    held = _support_words(support, hole_radius_mm)
    caption = f"Cross-section through the tool axis, thicknesses to scale, stronger colour where stiffer; {held}."
    if abs(section.stretch - 1) > 0.05:
        caption += f" The vertical scale is {format_number(section.stretch, 2)} times the horizontal one."
    words = "From the surface down: " + "; ".join(f"{layer.name}, {layer.text()}" for layer in layers)
    words += f". A tool of {format_number(float(tool_radius_mm), 3, trim=True)} mm radius stands on it; {held}."
    svg = draw(lambda drawing: paint_section(drawing, section), WIDE, section.picture_height, placed=True)
    return Figure.of(svg, caption, words, "Layers")


def _support_words(support: str, hole_radius_mm: float | None) -> str:
    if support == "half_space":
        return "the last layer is endless"
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
