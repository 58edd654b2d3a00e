"""Quantities of bench files: text with a unit in, SI floats out, dimension checked.

`Length`, `Speed` and so on are field types for pydantic models: a field of type `Length` takes `"2 mm"` and
holds `0.002`. Bounds are added at the field (`Annotated[Length, Field(gt=0)]`) and are in SI.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator

if TYPE_CHECKING:
    from collections.abc import Callable

_QUANTITY = re.compile(r"\s*(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?P<unit>[^\d\s+\-].*)", re.DOTALL)


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def parse_quantity(text: object, unit: str) -> float:
    """Read one quantity and give its value in `unit`.

    Parameters
    ----------
    text : str
        A number with a unit, for instance `"2 mm"` or `"1 mm/s"`. A bare zero (`"0"` or 0) is taken too.
    unit : str
        The SI unit wanted, for instance `"m/s"`.

    Returns
    -------
    float
        The value in `unit`.

    Raises
    ------
    ValueError
        Not a number with a unit, not finite, or of another dimension.
    """
    if not isinstance(text, bool) and text in (0, "0"):
        return 0.0
    allowed = f"allowed is a text with a unit that converts to {unit}"
    if not isinstance(text, str):
        raise ValueError(f"{text!r} has no unit: {allowed}")
    parts = _QUANTITY.fullmatch(text)
    try:
        value = float(_registry().Quantity(float(parts["number"]), parts["unit"]).to(unit).magnitude) if parts else None
    except Exception as error:
        raise ValueError(f"{text!r} is no quantity in {unit}: {allowed}") from error
    if value is None:
        raise ValueError(f"{text!r} is no number with a unit: {allowed}")
    if not math.isfinite(value):
        raise ValueError(f"{text!r} is not finite: {allowed}")
    return value


def _in(unit: str) -> Callable[[object], float]:
    return lambda text: parse_quantity(text, unit)


Length = Annotated[float, BeforeValidator(_in("m"))]
"""A length: text in the file, metres inside."""
Speed = Annotated[float, BeforeValidator(_in("m/s"))]
"""A speed: text in the file, m/s inside."""
Duration = Annotated[float, BeforeValidator(_in("s"))]
"""A time: text in the file, seconds inside."""
Force = Annotated[float, BeforeValidator(_in("N"))]
"""A force: text in the file, newtons inside."""
Frequency = Annotated[float, BeforeValidator(_in("Hz"))]
"""A rate: text in the file, Hz inside."""
