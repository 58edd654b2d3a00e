"""The whole of `reproduce`: run, compare, write."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.reproduce.article_page import ITEMS, reproduce_page
from benchmark.reproduce.article_statistics import table_two_items, text_items
from benchmark.reproduce.article_wave import equation_items, table_one_items
from benchmark.reproduce.evidence import Evidence, gather
from benchmark.reproduce.items import Item, columns, document
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import claimed, destination
from benchmark.runs.output.document import describe_environment
from reports import csv_text, write_json, write_page, write_text, write_whole


@dataclass(frozen=True)
class Reproduced:
    """A finished reproduction on disk: its folder, its items, and the content of `reproduce.json`."""

    folder: Path
    items: tuple[Item, ...]
    document: dict[str, Any]

    @property
    def report(self) -> Path:
        """The page."""
        return self.folder / "report.html"


def reproduce(out: Path | None, listener: Listener) -> Reproduced:
    """Recompute the article's numbers, redraw its figures, and write both.

    Parameters
    ----------
    out
        Folder of the result; `results/reproduce-DATE-TIME` by default.
    listener
        Told of progress.

    Raises
    ------
    InputError
        `out` holds something else; nothing is run then.
    OSError
        Where the file system refuses; the folder is then as it was.
    """
    with claimed(out, "reproduce"):
        return _reproduced(destination(out, "reproduce"), listener)


def _reproduced(folder: Path, listener: Listener) -> Reproduced:
    evidence = gather(listener)
    items = all_items(evidence)
    text = csv_text(columns(items), where=ITEMS)
    page = reproduce_page(items, evidence, describe_environment(seed=0), text)
    found = document(items)

    def fill(new: Path) -> None:
        write_text(new / ITEMS, text)
        write_json(new / "reproduce.json", found)
        write_page(new / "report.html", page)

    write_whole(folder, fill)
    return Reproduced(folder, items, found)


def all_items(evidence: Evidence) -> tuple[Item, ...]:
    """Return every item in the order of the article."""
    return (
        *table_one_items(evidence.chain),
        *equation_items(),
        *table_two_items(evidence.table_2),
        *text_items(evidence),
    )
