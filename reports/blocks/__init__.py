"""What a page is made of: sections and blocks, as plain frozen dataclasses.

A block type is a dataclass here and a template of its own in `templates/blocks/`; the page asks nothing else
of it. How blocks become HTML is in `reports.page` and the templates.
"""

from reports.blocks.figure import (
    Figure,
    Live,
    LiveAxes,
    LiveBody,
    LiveFace,
    LiveLine,
    LivePlot,
    Panel,
    Picture,
    Story,
    StoryStep,
)
from reports.blocks.table import Column, Download, Downloads, Table
from reports.blocks.text import (
    NOTICES,
    VERDICTS,
    Block,
    Bullets,
    Equation,
    Fact,
    Facts,
    KeyFigure,
    KeyFigures,
    Listing,
    Notice,
    Paragraph,
    Section,
    Subsection,
    Verdict,
)

__all__ = [
    "NOTICES",
    "VERDICTS",
    "Block",
    "Bullets",
    "Column",
    "Download",
    "Downloads",
    "Equation",
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
    "Story",
    "StoryStep",
    "Subsection",
    "Table",
    "Verdict",
]
