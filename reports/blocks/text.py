"""The base of all blocks, sections, and blocks of words and single values: notices, lists, facts, the verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

NOTICES: Mapping[str, str] = MappingProxyType(
    {
        "warning": "Warning",
        "finding": "Finding",
        "synthetic": "Synthetic data",
        "circular": "Circular comparison",
        "assumption": "Assumption",
    }
)
VERDICTS: Mapping[str, str] = MappingProxyType(
    {"good": "Good", "finding": "Finding", "failed": "Failed", "incomplete": "Incomplete", "unknown": "Unknown"}
)


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


@dataclass(frozen=True)
class Paragraph(Block):
    """Running text."""

    template: ClassVar[str] = "paragraph"
    text: str


MATHML = frozenset({"math", "mfrac", "mi", "mn", "mo", "mrow", "msqrt", "msub", "msup", "mtext", "munderover"})
"""The elements an equation may have (MathML Core); attributes are not allowed."""


@dataclass(frozen=True)
class Equation(Block):
    """An equation on a line of its own.

    Attributes
    ----------
    mathml
        What stands inside its `math` element, as presentation MathML without attributes.
    words
        The same as plain text, for who does not see it.
    number
        Its number, such as "(3)".
    """

    template: ClassVar[str] = "equation"
    mathml: str
    words: str
    number: str = ""

    def __post_init__(self) -> None:
        from defusedxml import ElementTree

        try:
            found = list(ElementTree.fromstring(f"<math>{self.mathml}</math>").iter())
        except ElementTree.ParseError as error:
            raise ValueError(f"Equation {self.number} is no well-formed MathML: {error}") from None
        for element in found:
            if element.tag not in MATHML or element.attrib:
                raise ValueError(
                    f"Equation {self.number} has <{element.tag}>; allowed without attributes: {sorted(MATHML)}"
                )


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


@dataclass(frozen=True)
class Verdict:
    """What the reader must know first.

    Attributes
    ----------
    status
        `good`, `finding`, `failed`, `incomplete` or `unknown` (the data cannot tell).
    headline
        One sentence.
    points
        The lines under it.
    """

    status: str
    headline: str
    points: Sequence[str] = ()

    def __post_init__(self) -> None:
        one_of("Verdict status", self.status, VERDICTS)

    @property
    def label(self) -> str:
        """The status as a word."""
        return VERDICTS[self.status]
