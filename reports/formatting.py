"""Numbers as people read them in a page: significant digits, a true minus, powers of ten.

Files for machines are written with all digits by `reports.tables`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

NOTHING = "–"
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_GROUP = "\N{NARROW NO-BREAK SPACE}"
_LEFTWARDS = "\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc\U00010800-\U00010fff\U0001e800-\U0001efff"
_LEFTWARD_RUN = re.compile(rf"[{_LEFTWARDS}]+(?:[ '_-][{_LEFTWARDS}]+)*")


def format_number(value: float, digits: int = 4, trim: bool = False) -> str:
    """Return a number with `digits` significant digits, `trim` without zeros after its last decimal.

    Digits before the point are all kept, in groups of three from five on. Very small and very large numbers
    get a power of ten, except whole ones (int); NaN becomes an en dash.

    Raises
    ------
    ValueError
        If `digits` is less than 1.
    """
    if digits < 1:
        raise ValueError(f"digits is {digits}, at least 1 is needed")
    if isinstance(value, int):
        return _grouped(str(value)).replace("-", "−")
    if math.isnan(value):
        return NOTHING
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == 0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = int(exponent)
    if power < -4 or power >= max(digits, 6):
        return f"{_trimmed(mantissa, trim)} × 10{str(power).translate(_SUPERSCRIPT)}".replace("-", "−")
    return _grouped(_trimmed(f"{value:.{max(digits - 1 - power, 0)}f}", trim)).replace("-", "−")


def format_cell(value: Any, digits: int = 4, trim: bool = False) -> str:
    """Return any cell as text: numbers by `format_number`, None and NaN as a dash, booleans as yes or no."""
    if value is None:
        return NOTHING
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return format_number(value, digits, trim)
    return str(value)


def counted(number: int, what: str) -> str:
    """Return a number of things in words, one or many: "1 point", "2 points"."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def shortened(text: str, length: int) -> str:
    """Return text of at most `length` characters, its end cut off behind an ellipsis where it is longer."""
    return text if len(text) <= length else text[: length - 1].rstrip() + "…"


def isolated(text: str, before: str = "\N{FIRST STRONG ISOLATE}", after: str = "\N{POP DIRECTIONAL ISOLATE}") -> str:
    """Return text with marks around each run of words of a right-to-left script.

    Without them such a name turns the numbers and commas beside it round (Unicode Standard Annex 9, rules N1 and W7).
    """
    return _LEFTWARD_RUN.sub(lambda run: f"{before}{run[0]}{after}", text)


def is_number(value: Any) -> bool:
    """Say whether a cell is a number (booleans, None and text are not)."""
    plain = value.item() if hasattr(value, "item") else value
    return isinstance(plain, int | float) and not isinstance(plain, bool)


def is_exact(value: float, digits: int) -> bool:
    """Say whether a number is shown exactly by `digits` significant digits."""
    return float(f"{float(value):.{digits}g}") == float(value)


def decimal_padding(texts: Sequence[str]) -> list[str]:
    """Return what to put after each text so that decimal points of a right-aligned column stand in line.

    Figure spaces are as wide as a digit and a punctuation space as a point where digits are tabular.
    """
    tails = [_tail(text) for text in texts]
    widest = max((len(tail) for tail in tails), default=0)
    return ["" if "×" in text else _blank(tail, widest) for text, tail in zip(texts, tails, strict=True)]


def _trimmed(text: str, trim: bool) -> str:
    return text.rstrip("0").rstrip(".") if trim and "." in text else text


def _tail(text: str) -> str:
    """Return the point and the digits after it; nothing for texts that are no plain decimal."""
    point = text.find(".")
    return text[point:] if point >= 0 and text[point + 1 :].isdigit() else ""


def _blank(tail: str, widest: int) -> str:
    missing = widest - len(tail)
    if not missing:
        return ""
    point = "" if tail else "\N{PUNCTUATION SPACE}"
    return point + "\N{FIGURE SPACE}" * (missing - len(point))


def _grouped(text: str) -> str:
    """Group the digits before the point in threes from five digits on."""
    sign, digits = ("-", text[1:]) if text.startswith("-") else ("", text)
    whole, point, fraction = digits.partition(".")
    if len(whole) > 4:
        whole = f"{int(whole):,}".replace(",", _GROUP)
    return f"{sign}{whole}{point}{fraction}"
