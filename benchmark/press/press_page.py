"""The page on which a tissue is pressed: one HTML file, its tables, style and script inside, that fetches nothing."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from reports.palette import stylesheet

SCRIPTS = ("wave.js", "hands.js", "scene.js", "app.js")
"""In the order in which they stand in the page; the first two run without one."""


def render_press_page(document: Mapping[str, Any], *, served: bool = False) -> str:
    """The page.

    Parameters
    ----------
    document
        What `benchmark.press.press_request.document` gives.
    served
        Whether it may speak with the server that it came from; a saved file may speak with nobody.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    templates = Environment(
        loader=PackageLoader("benchmark.press", "page"), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )
    code = script()
    data = json.dumps(document, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    ramps = [one["fem"]["levels"] for one in document["specimens"] if one["fem"] is not None]
    return templates.get_template("press.html.j2").render(
        palette=stylesheet(),
        style=part("press.css"),
        script=code,
        policy=f"'sha256-{base64.b64encode(hashlib.sha256(code.encode()).digest()).decode('ascii')}'",
        data=data,
        served=served,
        levels=max(ramps, default=0),
        version=version("tissuebench"),
    )


def script() -> str:
    """All of the page's script."""
    return "\n" + "\n".join(part(name) for name in SCRIPTS)


def part(name: str) -> str:
    """One of the page's files."""
    return files("benchmark.press").joinpath("page", name).read_text("utf-8")
