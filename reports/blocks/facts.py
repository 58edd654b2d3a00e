"""Single values: named facts in small type, key figures in large."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from reports.blocks.base import Block


@dataclass(frozen=True)
class Fact:
    """A named value as text, e.g. scenario, date, versions."""

    name: str
    value: str


@dataclass(frozen=True)
class Facts(Block):
    """Named values under each other."""

    template: ClassVar[str] = "facts"
    items: Sequence[Fact]


@dataclass(frozen=True)
class KeyFigure:
    """One number worth large type: what it is, its value and unit, and against what it holds."""

    label: str
    value: float | str
    unit: str = ""
    note: str = ""
    digits: int = 3


@dataclass(frozen=True)
class KeyFigures(Block):
    """Key figures side by side."""

    template: ClassVar[str] = "key_figures"
    items: Sequence[KeyFigure]
