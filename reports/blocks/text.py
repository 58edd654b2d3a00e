"""Blocks of words: paragraphs, lists, notices, listings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

from reports.blocks.base import Block, one_of

NOTICES: Mapping[str, str] = MappingProxyType(
    {
        "warning": "Warning",
        "finding": "Finding",
        "synthetic": "Synthetic data",
        "circular": "Circular comparison",
        "assumption": "Assumption",
    }
)


@dataclass(frozen=True)
class Paragraph(Block):
    """Running text."""

    template: ClassVar[str] = "paragraph"
    text: str


@dataclass(frozen=True)
class Bullets(Block):
    """A list of short texts."""

    template: ClassVar[str] = "bullets"
    items: Sequence[str]


@dataclass(frozen=True)
class Notice(Block):
    """A remark that must not be overlooked.

    Attributes
    ----------
    kind
        `warning`, `finding`, `synthetic`, `circular` or `assumption`.
    text
        What it says.
    items
        Lines under it, if there is more than one thing to say.
    """

    template: ClassVar[str] = "notice"
    kind: str
    text: str
    items: Sequence[str] = ()

    def __post_init__(self) -> None:
        one_of("Notice kind", self.kind, NOTICES)

    @property
    def label(self) -> str:
        """The kind as words."""
        return NOTICES[self.kind]


@dataclass(frozen=True)
class Listing(Block):
    """Text in fixed-width type, e.g. a resolved scenario file; folded away if `folded`."""

    template: ClassVar[str] = "listing"
    text: str
    caption: str
    folded: bool = True
