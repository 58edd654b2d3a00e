"""The base of all blocks, and sections that hold them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class Block:
    """Base of everything a section can hold."""

    template: ClassVar[str]
    counter: ClassVar[str] = ""


@dataclass(frozen=True)
class Subsection(Block):
    """Blocks under a heading of their own inside a section."""

    template: ClassVar[str] = "subsection"
    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Section:
    """A part of the page: heading and blocks."""

    title: str
    blocks: Sequence[Block]


def one_of(name: str, value: str, allowed: Mapping[str, str]) -> None:
    """Refuse a word that is not allowed."""
    if value not in allowed:
        raise ValueError(f"{name} is {value!r}; allowed: {', '.join(allowed)}")
