"""The colours of pages and figures, each by name in a light and a dark shade.

One table for both: figures are drawn in the light shades, and the page swaps them through CSS variables of
the same names. Model colours (blue and orange) stay apart for all common kinds of colour blindness; text
shades have a contrast of at least 4.5 to 1 on the page, lines at least 3 to 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Shade:
    """One colour as `#rrggbb` on a light and on a dark page."""

    light: str
    dark: str


PALETTE: Mapping[str, Shade] = MappingProxyType(
    {
        "paper": Shade("#ffffff", "#12161b"),
        "raised": Shade("#f5f7f9", "#1a2027"),
        "ink": Shade("#1a1f26", "#e7ebf0"),
        "muted": Shade("#56606c", "#a3aebb"),
        "grid": Shade("#dde2e8", "#2c3540"),
        "link": Shade("#0a58a6", "#7dbbff"),
        "fem": Shade("#0b5fae", "#6db3ff"),
        "wave": Shade("#c4460d", "#ff9f5f"),
        "trial": Shade("#6f7884", "#8e99a6"),
        "measured": Shade("#20252c", "#f2f5f8"),
        "tissue": Shade("#b3564b", "#e08d7f"),
        "tool": Shade("#7b8692", "#98a4b1"),
        "good": Shade("#1a7f37", "#56d37a"),
        "finding": Shade("#8a5a00", "#e5b454"),
        "failed": Shade("#b42318", "#ff8e82"),
        "incomplete": Shade("#6e3fa8", "#c3a1f5"),
        "unknown": Shade("#0f6673", "#74ccd8"),
    }
)


def stylesheet() -> str:
    """Return the CSS rules that set every colour as a variable, dark where the reader prefers it."""
    light = "".join(f"--{name}:{shade.light};" for name, shade in PALETTE.items())
    dark = "".join(f"--{name}:{shade.dark};" for name, shade in PALETTE.items())
    return (
        f":root{{color-scheme:light dark;{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"
    )


def css_variable(colour: str) -> str | None:
    """Return `var(--name, #rrggbb)` for a light shade of the palette, None for any other colour."""
    known = any(shade.light == colour.lower() for shade in PALETTE.values())
    return f"var(--{name_of(colour)}, {colour.lower()})" if known else None


def name_of(colour: str) -> str:
    """Return the name of a light shade of the palette.

    Raises
    ------
    ValueError
        For any other colour.
    """
    for name, shade in PALETTE.items():
        if shade.light == colour.lower():
            return name
    raise ValueError(f"the colour {colour} is not in the palette")


def contrast(first: str, second: str) -> float:
    """Return the contrast ratio of two `#rrggbb` colours, 1 to 21 (WCAG 2.2, relative luminance)."""
    bright, dim = sorted((_luminance(first), _luminance(second)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


def _luminance(colour: str) -> float:
    channels = [int(colour[start : start + 2], 16) / 255 for start in (1, 3, 5)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
