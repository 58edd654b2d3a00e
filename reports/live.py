"""The scripts of a page with plots to zoom and bodies to turn: one copy of plotly, and what draws with it.

Both stand in the page itself, and the page's policy lets nothing else run. What they draw is in
`reports.blocks.live`.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

from reports.blocks.live import Live


@dataclass(frozen=True)
class Scripts:
    """What a page embeds.

    Attributes
    ----------
    library
        plotly.js, compressed (gzip) and in base64.
    loader
        The script that unpacks and uses it.
    policy
        The sources of the content security policy that let exactly these two run.
    """

    library: str
    loader: str
    policy: str


@cache
def scripts() -> Scripts:
    """Return the scripts; read and compressed once in a process.

    Raises
    ------
    ModuleNotFoundError
        If plotly is not installed.
    """
    library = _plotly()
    loader = files("reports").joinpath("templates", "live.js").read_text("utf-8")
    packed = base64.b64encode(gzip.compress(library, compresslevel=9, mtime=0)).decode("ascii")
    return Scripts(packed, loader, f"{_source(library)} {_source(loader.encode())}")


def embedded_json(live: Live, title: str = "") -> str:
    """Return data with a title as JSON that can stand in a page's script element."""
    table = {"title": title, **live.to_dict()}
    return json.dumps(table, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def _plotly() -> bytes:
    """The library's file, without importing the package it comes in."""
    found = find_spec("plotly")
    if found is None or found.origin is None:
        raise ModuleNotFoundError("plotly is not installed; a page with plots to zoom embeds it")
    return (Path(found.origin).parent / "package_data" / "plotly.min.js").read_bytes()


def _source(script: bytes) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode('ascii')}'"
