"""SVG documents made fit for an HTML page: safe, with unique ids, a description in words, and the page's colours.

`themed` turns what matplotlib writes into SVG that follows the page: colours of the palette become CSS variables with
the light shade as fallback, font families are left to the page, coordinates are rounded to what can be seen, and ids
are renumbered, so that equal figures are equal bytes. Drawing is in `reports.figures`.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree

from reports import palette, svg
from reports.formatting import isolated

SVG_NAMESPACE = "http://www.w3.org/2000/svg"
_FORBIDDEN = frozenset({"script", "foreignObject", "iframe", "image", "animate", "set", "style"})
_REFERENCE = re.compile(r"url\(#([^)]+)\)")
_FETCH = re.compile(r"url\(\s*(?!['\"]?#)|@import|javascript:", re.IGNORECASE)
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}\b")
_FAMILY = re.compile(r"font-family:[^;]*;?\s*")
_DECIMAL = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
WIDE = 480.0
"""A drawing wider than this in CSS pixels scrolls on a phone, where its labels would be too small to read."""
_ROUNDED = ("d", "x", "y", "width", "height", "points")


def parse(svg: str) -> ElementTree.Element:
    """Return the root of an SVG document, all names without their namespaces.

    Raises
    ------
    ValueError
        If it is no well-formed XML, or no SVG.
    """
    import defusedxml.ElementTree

    try:
        root: ElementTree.Element = defusedxml.ElementTree.fromstring(svg)
    except ElementTree.ParseError as error:
        raise ValueError(f"a figure's SVG is no well-formed XML: {error}") from None
    for element in root.iter():
        element.tag = _local(element.tag)
        element.attrib = {_local(name): value for name, value in element.attrib.items()}
    if root.tag != "svg":
        raise ValueError(f"a figure's SVG starts with <{root.tag}>, allowed: <svg>")
    return root


def serialise(root: ElementTree.Element, standalone: bool = False) -> str:
    """Return an element of `parse` as text; `standalone` declares the namespace a file of its own needs."""
    root.attrib.pop("xmlns", None)
    if standalone:
        root.attrib = {"xmlns": SVG_NAMESPACE, **root.attrib}
    return ElementTree.tostring(root, encoding="unicode")


def embed(svg: str, prefix: str, title: str, description: str) -> str:
    """Return an SVG document as an element for an HTML page.

    Parameters
    ----------
    svg
        The document.
    prefix
        Put before every id, so that several figures of one page do not clash.
    title, description
        What it is and what it shows, in words.

    Raises
    ------
    ValueError
        If it is no SVG, or holds what could run or fetch something: scripts, event handlers, style sheets,
        images, or links other than to its own parts.
    """
    root = parse(svg)
    for element in root.iter():
        _refuse_active(element)
        _prefix_ids(element, prefix)
        element.text = element.text and isolated(element.text)
    for child in [child for child in root if child.tag in {"title", "desc"}]:
        root.remove(child)
    names = {"title": f"{prefix}title", "desc": f"{prefix}desc"}
    for position, (tag, text) in enumerate((("title", title), ("desc", description))):
        element = ElementTree.Element(tag, {"id": names[tag]})
        element.text = isolated(text)
        root.insert(position, element)
    root.set("role", "img")
    if float(root.get("viewBox", "0 0 0 0").split()[2]) > WIDE:
        root.set("class", "wide")
    root.set("aria-labelledby", f"{names['title']} {names['desc']}")
    return serialise(root)


def renumber_ids(root: ElementTree.Element) -> None:
    """Name the ids that are referred to `i0, i1, ...` in order of appearance and drop all others."""
    text = ElementTree.tostring(root, encoding="unicode")
    used = set(_REFERENCE.findall(text)) | set(re.findall(r'href="#([^"]+)"', text))
    new: dict[str, str] = {}
    for element in root.iter():
        old = element.attrib.pop("id", None)
        if old is not None and old in used:
            element.set("id", new.setdefault(old, f"i{len(new)}"))
    for element in root.iter():
        _rename_references(element, new)


def _prefix_ids(element: ElementTree.Element, prefix: str) -> None:
    """Put a prefix before the id of an element and before those it refers to."""
    if "id" in element.attrib:
        element.set("id", prefix + element.attrib["id"])
    for name, value in element.attrib.items():
        if name == "href":
            element.set(name, f"#{prefix}{value[1:]}")
        else:
            element.set(name, _REFERENCE.sub(rf"url(#{prefix}\1)", value))


def _rename_references(element: ElementTree.Element, new: dict[str, str]) -> None:
    for name, value in element.attrib.items():
        if name == "href" and value[1:] in new:
            element.set(name, f"#{new[value[1:]]}")
        elif "url(#" in value:
            element.set(name, _REFERENCE.sub(lambda match: f"url(#{new[match[1]]})", value))


def _refuse_active(element: ElementTree.Element) -> None:
    """Refuse an element that could run or fetch something."""
    if element.tag in _FORBIDDEN:
        raise ValueError(f"a figure's SVG holds <{element.tag}>, which a page does not take in")
    for name, value in element.attrib.items():
        foreign = name == "href" and not value.startswith("#")
        if name.lower().startswith("on") or foreign or _FETCH.search(value):
            raise ValueError(f"a figure's SVG holds {name}={value!r}, which a page does not take in")


def _local(name: str) -> str:
    """Return a name without its namespace."""
    return name.rsplit("}", 1)[-1]


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
