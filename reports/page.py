"""Pages: one offline HTML file, readable without JavaScript, verdict first.

The look is in `templates/`, what a page holds in `reports.blocks`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from reports.atomic import StrPath, write_text
from reports.blocks import (
    Block,
    Download,
    Downloads,
    Fact,
    Figure,
    KeyFigure,
    Notice,
    Section,
    Subsection,
    Verdict,
)
from reports.rendering import environment, scripts


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
    placed = [
        (f"section-{position}", section.title, numbering.place(section.blocks, f"section-{position}"))
        for position, section in enumerate(sections, 1)
    ]
    live = scripts() if any(_is_live(block) for section in sections for block in section.blocks) else None
    html = environment().get_template("page.html.j2").render(page=page, sections=placed, scripts=live)
    return html if html.endswith("\n") else html + "\n"


def write_page(path: StrPath, page: Page) -> Path:
    """Write `render_page(page)` to a file, whole or not at all, and return its path."""
    return write_text(path, render_page(page))
