"""Tables, figures, HTML and CSV from plain results.

Knows nothing of solvers, wave models, devices or the harness: plain arrays, dicts and the small frozen
dataclasses of `reports.blocks` come in, strings and files go out. Figures live in `reports.figures`.
"""

from reports.atomic import write_bytes, write_json, write_text
from reports.blocks import (
    Block,
    Bullets,
    Column,
    Download,
    Downloads,
    Equation,
    Fact,
    Facts,
    Figure,
    KeyFigure,
    KeyFigures,
    Listing,
    Notice,
    Panel,
    Paragraph,
    Picture,
    Section,
    Story,
    StoryStep,
    Subsection,
    Table,
    Verdict,
)
from reports.page import Page, render_page, write_page
from reports.result_folder import check_place, extended_folder, whole_folder, write_whole
from reports.tables import csv_text, write_csv

__all__ = [
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
    "Notice",
    "Page",
    "Panel",
    "Paragraph",
    "Picture",
    "Section",
    "Story",
    "StoryStep",
    "Subsection",
    "Table",
    "Verdict",
    "check_place",
    "csv_text",
    "extended_folder",
    "render_page",
    "whole_folder",
    "write_bytes",
    "write_csv",
    "write_json",
    "write_page",
    "write_text",
    "write_whole",
]
