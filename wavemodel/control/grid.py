"""The vertices of a tissue's surface, and the window of them that one contact moves."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError, require_positive


@dataclass(frozen=True)
class Grid:
    """Vertices every `spacing` along x from 0 to the width and along y from 0 to the height.

    Attributes
    ----------
    width, height, spacing
        In m.

    Raises
    ------
    WaveError
        If a length is not positive, or the spacing is wider than the tissue.
    """

    width: float
    height: float
    spacing: float

    def __post_init__(self) -> None:
        for name in ("width", "height", "spacing"):
            require_positive(f"tissue: {name}", getattr(self, name), "m")
        if self.spacing > min(self.width, self.height):
            raise WaveError(
                f"tissue: spacing = {self.spacing * 1e3:g} mm is not allowed: at most its sides, "
                f"{self.width * 1e3:g} x {self.height * 1e3:g} mm"
            )

    @cached_property
    def x(self) -> FloatArray:
        """(P,) in m."""
        return self._line(self.width)

    @cached_property
    def y(self) -> FloatArray:
        """(Q,) in m."""
        return self._line(self.height)

    def _line(self, side: float) -> FloatArray:
        return np.asarray(np.arange(int(side / self.spacing + 1e-9) + 1) * self.spacing)

    def holds(self, x: float, y: float) -> bool:
        """Whether a point, m, is on the tissue."""
        return 0.0 <= x <= self.width and 0.0 <= y <= self.height

    def window(self, x: float, y: float, reach: float) -> tuple[int, int, int, int]:
        """Vertices within `reach` (m) of x and of y, clipped at the edges: first and end of each."""
        return *self._span(x, reach, self.x.size), *self._span(y, reach, self.y.size)

    def most_vertices(self, reach: float) -> int:
        """Most vertices that a window can hold."""
        span = int(2.0 * reach / self.spacing + 1e-6) + 2
        return min(span, self.x.size) * min(span, self.y.size)

    def _span(self, at: float, reach: float, count: int) -> tuple[int, int]:
        first, last = np.ceil((at - reach) / self.spacing - 1e-9), np.floor((at + reach) / self.spacing + 1e-9)
        return max(int(first), 0), min(int(last) + 1, count)
