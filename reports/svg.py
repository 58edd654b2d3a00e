"""SVG documents made fit to stand in an HTML page: safe, with unique ids and words for those who do not see.

Drawing is in `reports.figures`.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree

SVG_NAMESPACE = "http://www.w3.org/2000/svg"
_FORBIDDEN = frozenset({"script", "foreignObject", "iframe", "image", "animate", "set", "style"})
_REFERENCE = re.compile(r"url\(#([^)]+)\)")
_FETCH = re.compile(r"url\(\s*(?!['\"]?#)|@import|javascript:", re.IGNORECASE)


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
    for child in [child for child in root if child.tag in {"title", "desc"}]:
        root.remove(child)
    names = {"title": f"{prefix}title", "desc": f"{prefix}desc"}
    for position, (tag, text) in enumerate((("title", title), ("desc", description))):
        element = ElementTree.Element(tag, {"id": names[tag]})
        element.text = text
        root.insert(position, element)
    root.set("role", "img")
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
