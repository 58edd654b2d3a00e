"""Animations: a moving picture with a caption and a description in words."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from typing import ClassVar

from reports.blocks.base import Block

SIGNATURES = (b"GIF87a", b"GIF89a")


@dataclass(frozen=True)
class Animation(Block):
    """One animated picture, part of the page itself.

    Attributes
    ----------
    gif
        The file's content.
    caption
        What is seen, with units.
    alt
        The same for those who do not see it.
    title
        Its name, set before the caption.

    Raises
    ------
    ValueError
        If the content is no GIF.
    """

    template: ClassVar[str] = "animation"
    counter: ClassVar[str] = "Figure"
    gif: bytes
    caption: str
    alt: str
    title: str = ""

    def __post_init__(self) -> None:
        if not self.gif.startswith(SIGNATURES):
            raise ValueError("an animation's content is no GIF")

    @property
    def source(self) -> str:
        """The picture as a data address."""
        return "data:image/gif;base64," + base64.b64encode(self.gif).decode("ascii")
