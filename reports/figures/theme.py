"""From what matplotlib writes to SVG that follows the page: its colours, its type, its light and dark.

Colours of the palette become CSS variables with the light shade as fallback, font families are left to the
page, coordinates are rounded to what can be seen, and ids are renumbered, so that equal figures are
equal bytes.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree

from reports import palette, svg

_COLOUR = re.compile(r"#[0-9a-fA-F]{6}\b")
_FAMILY = re.compile(r"font-family:[^;]*;?\s*")
_DECIMAL = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
_ROUNDED = ("d", "x", "y", "width", "height", "points")


def themed(raw: str) -> str:
    """Return matplotlib's SVG as a standalone document that follows the page it is put into.

    Raises
    ------
    ValueError
        If a colour is not in `reports.palette`, because it would not follow the page.
    """
    root = svg.parse(raw)
    for parent in list(root.iter()):
        for child in [child for child in parent if child.tag in {"metadata", "style"}]:
            parent.remove(child)
    for element in root.iter():
        _theme(element)
    svg.renumber_ids(root)
    _drop_empty_defs(root)
    _, _, width, height = root.attrib["viewBox"].split()
    root.attrib = {
        "viewBox": root.attrib["viewBox"],
        "width": width,
        "height": height,
        "font-family": "sans-serif",
        "stroke-linejoin": "round",
    }
    return svg.serialise(root, standalone=True)


def _theme(element: ElementTree.Element) -> None:
    """Change colours, fonts and coordinates of one element in place."""
    element.tail = None
    if element.tag != "text" and element.tag != "tspan":
        element.text = None
    if "style" in element.attrib:
        style = _FAMILY.sub("", element.attrib["style"])
        element.set("style", _COLOUR.sub(_variable, style))
    for name in _ROUNDED:
        if name in element.attrib:
            value = " ".join(element.attrib[name].split())
            element.set(name, _DECIMAL.sub(_round, value))


def _variable(match: re.Match[str]) -> str:
    variable = palette.css_variable(match[0])
    if variable is None:
        raise ValueError(f"figure colour {match[0]} is not in the palette, so it cannot follow the page")
    return variable


def _round(match: re.Match[str]) -> str:
    text = f"{float(match[0]):.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _drop_empty_defs(root: ElementTree.Element) -> None:
    for parent in list(root.iter()):
        for child in [child for child in parent if child.tag == "defs" and not len(child)]:
            parent.remove(child)
