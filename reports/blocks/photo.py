"""Pictures that a camera took, with a caption: PNG inside the page."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from typing import ClassVar

from reports.blocks.base import Block

_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Photo(Block):
    """A picture of pixels, numbered with the figures.

    Attributes
    ----------
    png
        The file's bytes.
    caption
        What is seen.
    alt
        The same for those who do not see it.
    title
        Its name, set before the caption.

    Raises
    ------
    ValueError
        If the bytes are no PNG.
    """

    template: ClassVar[str] = "photo"
    counter: ClassVar[str] = "Figure"
    png: bytes
    caption: str
    alt: str
    title: str = ""

    def __post_init__(self) -> None:
        if not self.png.startswith(_PNG):
            raise ValueError("a photo's bytes are no PNG")

    @property
    def address(self) -> str:
        """The picture as a data address, which fetches nothing."""
        return f"data:image/png;base64,{base64.b64encode(self.png).decode('ascii')}"
