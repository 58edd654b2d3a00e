"""What a page is made of: sections and blocks, as plain frozen dataclasses.

A block type is a dataclass here and a template of its own in `templates/blocks/`; the page asks nothing else
of it. How blocks become HTML is in `reports.page`, `reports.rendering` and the templates.
"""

from reports.blocks.base import Block, Section, Subsection
from reports.blocks.facts import Fact, Facts, KeyFigure, KeyFigures
from reports.blocks.figure import Figure, Panel, Picture
from reports.blocks.live import Live, LiveAxes, LiveBody, LiveFace, LiveLine, LivePlot
from reports.blocks.table import Column, Download, Downloads, Table
from reports.blocks.text import NOTICES, Bullets, Listing, Notice, Paragraph
from reports.blocks.verdict import VERDICTS, Verdict

__all__ = [
    "NOTICES",
    "VERDICTS",
    "Block",
    "Bullets",
    "Column",
    "Download",
    "Downloads",
    "Fact",
    "Facts",
    "Figure",
    "KeyFigure",
    "KeyFigures",
    "Listing",
    "Live",
    "LiveAxes",
    "LiveBody",
    "LiveFace",
    "LiveLine",
    "LivePlot",
    "Notice",
    "Panel",
    "Paragraph",
    "Picture",
    "Section",
    "Subsection",
    "Table",
    "Verdict",
]
