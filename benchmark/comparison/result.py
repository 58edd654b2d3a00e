"""What every result of a comparison has in common: plain values for JSON and rows for a table."""

import dataclasses
import math
from typing import Any, TypeAlias

import numpy as np

Row: TypeAlias = tuple[str, float | None, float | None, float | None]
"""One line of a statistics table: quantity, value of the FEM, value of the wave model, value of both."""


@dataclasses.dataclass(frozen=True)
class Result:
    """Base of the frozen result dataclasses."""

    def to_dict(self) -> dict[str, Any]:
        """Fields as plain Python values, NaN and infinities as None, arrays as lists."""
        return {field.name: plain(getattr(self, field.name)) for field in dataclasses.fields(self)}

    def rows(self) -> list[Row]:
        """Lines of the statistics table, in print order; empty where a result has none."""
        return []


def plain(value: Any) -> Any:
    """Give a value as JSON knows it: NumPy scalars unwrapped, non-finite numbers None, results as dicts."""
    if isinstance(value, Result):
        return value.to_dict()
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
