"""Pages: one offline HTML file, readable without JavaScript, verdict first.

What a page holds is in `reports.blocks`, the look in `templates/`: everything in them is escaped and nothing undefined.
The scripts (one copy of plotly, and what draws with it) stand in the page itself, and its policy lets nothing else run.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reports import formatting, palette, svg
from reports.atomic import StrPath, write_text
from reports.blocks import (
    Block,
    Column,
    Download,
    Downloads,
    Fact,
    Figure,
    KeyFigure,
    Live,
    Notice,
    Picture,
    Section,
    Story,
    Subsection,
    Table,
    Verdict,
)

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup


@dataclass(frozen=True)
class Page:
    """A report.

    Attributes
    ----------
    title
        Its only first-level heading.
    verdict
        What the reader must know first.
    sections
        Its parts, in order.
    subtitle
        One sentence under the title.
    facts
        Scenario, date, versions and the like, under the subtitle.
    notices
        What must be known before any figure is looked at, under the verdict.
    story
        What the page tells on one screen, before its tables; None without.
    key_figures
        The few numbers worth large type.
    downloads
        Files beside the page, listed at its end.
    footer
        Closing line.
    """

    title: str
    verdict: Verdict
    sections: Sequence[Section]
    subtitle: str = ""
    facts: Sequence[Fact] = ()
    notices: Sequence[Notice] = ()
    story: Story | None = None
    key_figures: Sequence[KeyFigure] = ()
    downloads: Sequence[Download] = ()
    footer: str = ""


@dataclass(frozen=True)
class Placed:
    """A block at its place in the page: with its anchor, its number and, for a subsection, what it holds."""

    block: Block
    anchor: str
    number: int = 0
    children: Sequence[Placed] = ()

    @property
    def template(self) -> str:
        """Path of the block's template."""
        return f"blocks/{self.block.template}.html.j2"


@dataclass(frozen=True)
class _Numbering:
    """Counts the blocks that have a number, kind by kind."""

    counts: dict[str, int] = field(default_factory=dict)

    def place(self, blocks: Sequence[Block], anchor: str) -> list[Placed]:
        """Return the blocks of one part with anchors and numbers."""
        return [self._place(block, f"{anchor}-{position}") for position, block in enumerate(blocks, 1)]

    def _place(self, block: Block, anchor: str) -> Placed:
        if not isinstance(block, Block):
            raise TypeError(f"a section holds a {type(block).__name__}; allowed: the block types of reports.blocks")
        if isinstance(block, Subsection):
            return Placed(block, anchor, children=self.place(block.blocks, anchor))
        if not block.counter:
            return Placed(block, anchor)
        number = self.counts[block.counter] = self.counts.get(block.counter, 0) + 1
        return Placed(block, f"{block.counter.lower()}-{number}", number)


def _is_live(block: Block) -> bool:
    """Whether a block has anything to zoom or turn."""
    if isinstance(block, Subsection):
        return any(_is_live(each) for each in block.blocks)
    return isinstance(block, Figure) and block.is_live


def render_page(page: Page) -> str:
    """Return a page as one HTML5 file that fetches nothing.

    All text is escaped: HTML in a name shows as text. Figures and tables are numbered in order of appearance.

    Raises
    ------
    TypeError
        If a section holds something that is no block.
    ValueError
        If a figure's SVG is not well-formed, or could run or fetch something.
    """
    sections = list(page.sections)
    if page.downloads:
        sections.append(Section("Downloads", (Downloads(page.downloads),)))
    numbering = _Numbering()
    story = None if page.story is None else numbering.place([page.story.figure], "story")[0]
    placed = [
        (f"section-{position}", section.title, numbering.place(section.blocks, f"section-{position}"))
        for position, section in enumerate(sections, 1)
    ]
    blocks = [block for section in sections for block in section.blocks]
    live = scripts() if any(map(_is_live, blocks)) else None
    html = environment().get_template("page.html.j2").render(page=page, story=story, sections=placed, scripts=live)
    return html if html.endswith("\n") else html + "\n"


def write_page(path: StrPath, page: Page) -> Path:
    """Write `render_page(page)` to a file, whole or not at all, and return its path."""
    return write_text(path, render_page(page))


_FOLD_FROM = 17
_LONG_TEXT = 40
"""Letters from which a column of texts would stand in tall, narrow cells on a small screen."""


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


def environment() -> Environment:
    """Return the template environment: everything escaped, nothing undefined."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    templates = Environment(
        loader=PackageLoader("reports", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters |= {
        "number": formatting.format_cell,
        "panels": _embedded_panels,
        "grid": _table_grid,
        "data_link": _data_link,
        "isolated": _isolated,
    }
    templates.globals["palette_css"] = palette.stylesheet()
    return templates


def _embedded_panels(figure: Figure, number: int) -> Iterator[tuple[Markup, Markup | None]]:
    """Yield the pictures of a figure, as inline SVG or as an image whose data is in the page, and live data as JSON."""
    from markupsafe import Markup

    for position, panel in enumerate(figure.panels):
        if isinstance(panel, Picture):
            yield _picture(panel), None
            continue
        title = panel.title or figure.title or f"Figure {number}"
        # embed() has parsed the SVG, refused anything active and escaped every text in it.
        drawing = Markup(svg.embed(panel.svg, f"f{number}-{position}-", title, panel.alt))
        yield drawing, _data(panel.live, panel.title if len(figure.panels) > 1 else "")


def _picture(picture: Picture) -> Markup:
    """Return an image; a moving one waits behind a still one until it is asked for, and stops when it is put away."""
    from markupsafe import Markup

    image = Markup('<img src="{}" alt="{}">')
    still = picture.still
    if still is None:
        return image.format(picture.address, picture.alt)
    moving = Markup('<details class="moving"><summary>Show it moving</summary>{}</details>')
    return image.format(still, picture.alt) + moving.format(image.format(picture.address, f"Moving: {picture.alt}"))


def _data(live: Live | None, title: str) -> Markup | None:
    """Return live data for a script element."""
    from markupsafe import Markup

    return None if live is None else Markup(embedded_json(live, title))


def _table_grid(table: Table) -> dict[str, Any]:
    """Return what the table template shows: columns, and rows of (text, padding, is number)."""
    columns = [column if isinstance(column, Column) else Column(column) for column in table.columns]
    shown = table.rows[: table.limit]
    by_column = [_column_cells([row[index] for row in shown], column) for index, column in enumerate(columns)]
    return {
        "columns": columns,
        "classes": [_cell_class(cells) for cells in by_column],
        "rows": list(zip(*by_column, strict=True)),
        "hidden": len(table.rows) - len(shown),
        "folded": len(table.rows) >= _FOLD_FROM if table.folded is None else table.folded,
    }


def _cell_class(cells: Sequence[tuple[str, str, bool]]) -> str:
    """The class attribute of a column: numbers to the right, long texts wide enough to be read."""
    if any(number for _, _, number in cells):
        return ' class="n"'
    return ' class="long"' if any(len(text) > _LONG_TEXT for text, _, _ in cells) else ""


def _column_cells(values: Sequence[Any], column: Column) -> list[tuple[str, str, bool]]:
    """Return text, padding and whether it is a number for each cell of a column.

    A column whose numbers are all exact within its digits (settings, counts) shows no zeros after the last one.
    """
    numbers = [formatting.is_number(value) for value in values]
    pairs = list(zip(values, numbers, strict=True))
    exact = all(formatting.is_exact(value, column.digits) for value, number in pairs if number)
    texts = [formatting.format_cell(value, column.digits, trim=exact) for value in values]
    padding = formatting.decimal_padding([text if number else "" for text, number in zip(texts, numbers, strict=True)])
    return list(zip(texts, padding, numbers, strict=True))


def _isolated(text: str) -> Markup:
    """Return text for an element, with each run of a right-to-left script as a `bdi`, so that it reorders no other."""
    from markupsafe import Markup

    return Markup(formatting.isolated(str(Markup.escape(text)), "<bdi>", "</bdi>"))


def _data_link(download: Download) -> str:
    """Return an embedded file as a `data:` link."""
    content = download.content or b""
    data = content.encode("utf-8") if isinstance(content, str) else content
    return f"data:{download.media_type};base64,{base64.b64encode(data).decode('ascii')}"
