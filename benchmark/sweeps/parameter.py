"""One varied key of a scenario: the values on its list, or its range, in the unit that was typed."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from benchmark.errors import InputError
from benchmark.files.units import DIMENSIONS, Dimension, QuantityError, parse_quantity

SCALES = ("lin", "log")
DIGITS = 10
"""Significant digits of values that are computed, so that the same command gives the same points everywhere."""

SAME = 1e-12
"""Relative difference of two numbers that are one value in different units."""

Scale = Literal["lin", "log"]


@dataclass(frozen=True)
class Parameter:
    """A varied key.

    Attributes
    ----------
    key : str
        As `--set` takes it, `dermis.youngs_modulus`.
    texts : tuple of str
        The values of a list, or both ends of a range, as typed.
    numbers : tuple of float or None
        The same in `unit`; None where they are words (`rigid_bonded`).
    unit : str
        The unit of the first value; empty for plain numbers and words.
    count : int or None
        Values of a range on a grid; None for a list, and for a range that only a sample can use.
    scale : str
        "lin" or "log", of a range.
    ranged : bool
        Whether it is a range.
    """

    key: str
    texts: tuple[str, ...]
    numbers: tuple[float, ...] | None
    unit: str
    count: int | None = None
    scale: Scale = "lin"
    ranged: bool = False

    def grid(self) -> list[str]:
        """The values on a grid, as `--set` takes them.

        Raises
        ------
        InputError
            A range that does not say how many.
        """
        if not self.ranged:
            return list(self.texts)
        if self.count is None:
            raise InputError(
                f"--vary {self.key}: a range needs its number of values on a grid, as in "
                f'"{self.texts[0]}:{self.texts[1]}:10"; without one it can only be sampled (--sample)'
            )
        return [self.text_at(share) for share in np.linspace(0.0, 1.0, self.count)]

    def text_at(self, share: float) -> str:
        """The value at a share from 0 to 1 of the range, or of the list, as `--set` takes it."""
        if not self.ranged:
            return self.texts[min(int(share * len(self.texts)), len(self.texts) - 1)]
        if share in (0.0, 1.0):
            return self.texts[int(share)]
        assert self.numbers is not None
        low, high = self.numbers
        value = low * (high / low) ** share if self.scale == "log" else low + share * (high - low)
        return f"{float(f'{value:.{DIGITS}g}')!r} {self.unit}".strip()

    def number_of(self, text: str) -> float | None:
        """A value in `unit`; None for a word."""
        return None if self.numbers is None else _numbers_of(self.key, (text,), self.unit)[0]

    @property
    def column(self) -> str:
        """The name of the column with the numbers: the key with its unit."""
        unit = self.unit.replace("/", "_per_").replace("%", "percent")
        unit = re.sub(r"[^0-9A-Za-z_]", "", unit.replace("µ", "u").replace("μ", "u"))
        return f"{self.key}_{unit}" if unit else self.key

    def describe(self) -> str:
        """What was asked for, in the form it was typed in."""
        if not self.ranged:
            return ",".join(self.texts)
        parts = [*self.texts, *([str(self.count)] if self.count else []), *(["log"] if self.scale == "log" else [])]
        return ":".join(parts)


def parse_parameter(text: str) -> Parameter:
    """Read `KEY=A,B,C` or `KEY=LOW:HIGH[:N][:log]`.

    Raises
    ------
    InputError
        Naming the key and the form that is allowed.
    """
    key, equals, values = (part.strip() for part in text.partition("="))
    if not equals or not key or not values:
        raise InputError(f'--vary {text!r} is not of the form KEY=VALUES, as in --vary tool.radius="2 mm,5 mm"')
    if ":" in values and "," not in values:
        return _range(key, values)
    texts = tuple(part.strip() for part in values.split(","))
    if not all(texts) or len(set(texts)) < len(texts):
        raise InputError(f"--vary {key}: {values!r} has an empty or a repeated value; allowed: different ones")
    unit = _common_unit(texts)
    numbers = None if unit is None else _numbers_of(key, texts, unit)
    if numbers is not None and (twice := _one_twice(texts, numbers)):
        raise InputError(f"--vary {key}: {twice} are one value; allowed: different ones")
    return Parameter(key, texts, numbers, unit or "")


def _one_twice(texts: tuple[str, ...], numbers: tuple[float, ...]) -> str:
    """Two texts that say the same number, as `4 mm and 0.004 m`; empty where there are none."""
    order = sorted(range(len(numbers)), key=numbers.__getitem__)
    same = next(
        (pair for pair in pairwise(order) if math.isclose(numbers[pair[0]], numbers[pair[1]], rel_tol=SAME)), None
    )
    return "" if same is None else " and ".join(texts[at] for at in sorted(same))


def _range(key: str, values: str) -> Parameter:
    """A range `LOW:HIGH[:N][:log|lin]`."""
    low, high, *more = (part.strip() for part in values.split(":"))
    scale = more.pop() if more and more[-1] in SCALES else "lin"
    count = int(more.pop(0)) if more and re.fullmatch(r"[0-9]{1,9}", more[0]) else None
    unit = _common_unit((low, high))
    if more or unit is None or (count is not None and count < 2):
        raise InputError(
            f"--vary {key}: {values!r} is no range; allowed: LOW:HIGH:N or LOW:HIGH:N:log, as in "
            '"50 kPa:500 kPa:10:log", with units of one kind and at least 2 values'
        )
    numbers = _numbers_of(key, (low, high), unit)
    if numbers[0] == numbers[1] or (scale == "log" and min(numbers) <= 0):
        raise InputError(f"--vary {key}: {values!r} has ends that are equal, or not above zero on a log scale")
    return Parameter(key, (low, high), numbers, unit, count, "log" if scale == "log" else "lin", ranged=True)


def _common_unit(texts: tuple[str, ...]) -> str | None:
    """The unit of the first value where all are quantities of one dimension; "" for plain numbers, None for words."""
    if all(_plain(text) is not None for text in texts):
        return ""
    dimensions = {_dimension(text) for text in texts}
    if len(dimensions) != 1 or None in dimensions:
        return None
    return re.sub(r"^\s*[-+0-9.]+(?:[eE][-+]?\d+)?\s*", "", texts[0])


def _numbers_of(key: str, texts: tuple[str, ...], unit: str) -> tuple[float, ...]:
    """The values in `unit`."""
    found = []
    for text in texts:
        number = _plain(text.removesuffix(unit)) if text.endswith(unit) else None
        if number is None:
            dimension = _dimension(text)
            if dimension is None:
                raise InputError(f"--vary {key}: {text!r} is not in {unit}")
            number = parse_quantity(text, dimension) / parse_quantity(f"1 {unit}", dimension)
        found.append(number)
    return tuple(found)


def _plain(text: str) -> float | None:
    """A finite number without a unit; None for anything else."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) and "_" not in text else None


def _dimension(text: str) -> Dimension | None:
    """What a quantity measures; None where it is no quantity."""
    for dimension in DIMENSIONS:
        try:
            parse_quantity(text, dimension)
        except QuantityError:
            continue
        return dimension
    return None
