"""Tables, and files to take away."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from reports.blocks.text import Block


@dataclass(frozen=True)
class Column:
    """A table column: heading, unit, and how many significant digits its numbers show."""

    name: str
    unit: str = ""
    digits: int = 4


@dataclass(frozen=True)
class Download:
    """A file beside the page, and optionally inside it.

    Attributes
    ----------
    href
        Path relative to the page, e.g. `tables/timing.csv`.
    description
        What is in it.
    content
        The file's content, to embed it as a `data:` link; None links to the file only.
    media_type
        Its type, e.g. `text/csv`.
    """

    href: str
    description: str = ""
    content: str | bytes | None = None
    media_type: str = "text/csv"

    def __post_init__(self) -> None:
        if not self.href or self.href.startswith(("/", "\\")) or re.match(r"[A-Za-z][A-Za-z0-9+.-]*:", self.href):
            raise ValueError(f"Download href is {self.href!r}; allowed: a path relative to the page")

    @property
    def name(self) -> str:
        """The file's name without its folders."""
        return self.href.rsplit("/", 1)[-1]


@dataclass(frozen=True)
class Downloads(Block):
    """A list of files to take away."""

    template: ClassVar[str] = "downloads"
    items: Sequence[Download]


@dataclass(frozen=True)
class Table(Block):
    """A table with caption, headings with units, and rows of numbers and text.

    Attributes
    ----------
    caption
        What it shows.
    columns
        Headings; plain text stands for a column without unit.
    rows
        One sequence of cells a row, as long as `columns`: numbers, text, booleans, None or NaN for nothing.
    download
        The same data as a file, linked under the table.
    folded
        Folded away behind its caption; None folds tables of more than 16 rows.
    row_headings
        Whether the first column heads its row.
    limit
        At most so many rows are shown; the rest is counted and left to the download.
    """

    template: ClassVar[str] = "table"
    counter: ClassVar[str] = "Table"
    caption: str
    columns: Sequence[Column | str]
    rows: Sequence[Sequence[Any]]
    download: Download | None = None
    folded: bool | None = None
    row_headings: bool = True
    limit: int = 500

    def __post_init__(self) -> None:
        for number, row in enumerate(self.rows, 1):
            if len(row) != len(self.columns):
                raise ValueError(
                    f"Table {self.caption!r}, row {number} has {len(row)} cells, allowed: {len(self.columns)}"
                )
