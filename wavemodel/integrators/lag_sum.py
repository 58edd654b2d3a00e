"""A linear answer with fading memory: what comes in at once, by its rate, and through first-order lags."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray, NumberArray
from wavemodel.integrators.lag import lagged


@dataclass(frozen=True)
class LagSum:
    """out = instant F + rate F' + sum_i weight_i x_i with time_i x_i' + x_i = F; exact for F linear in each step.

    Attributes
    ----------
    instant
        Factor of what comes in at once.
    weight, time
        (m,) of the lags; times in s.
    rate
        Factor of the slope within the step that ends, s.
    """

    instant: float
    weight: FloatArray
    time: NumberArray
    rate: float = 0.0

    @property
    def static(self) -> float:
        """The answer to one, after a long time."""
        return float(self.instant + self.weight.sum())

    def lags(self, durations: FloatArray, values: FloatArray, memory: "LagMemory | None" = None) -> NumberArray:
        """(m, n) responses of the lags to values (n,) at the ends of steps (n,), s."""
        memory = memory or self.rest()
        pairs = zip(self.time.tolist(), memory.state.tolist(), strict=True)
        rows = [lagged(durations / time, values, memory.last, start) for time, start in pairs]
        return np.array(rows).reshape(self.time.size, values.size)

    def follow(
        self, durations: FloatArray, values: FloatArray, memory: "LagMemory | None" = None
    ) -> tuple[FloatArray, "LagMemory"]:
        """(n,) answer to values (n,) at the ends of steps (n,), s, and the memory to go on from.

        Parameters
        ----------
        durations
            Of the steps, s. Where there is none the value jumps and the lags stay.
        values
            What comes in.
        memory
            None: at rest.
        """
        memory = memory or self.rest()
        state = self.lags(durations, values, memory)
        out = self.instant * values + self.weight @ state
        if self.rate:
            out += self.rate * slopes(durations, values, memory.last)
        return out, LagMemory(float(values[-1]), state[:, -1])

    def rest(self, value: float = 0.0) -> "LagMemory":
        """Memory of having been at one value for ever."""
        return LagMemory(value, np.full(self.time.size, value))


@dataclass(frozen=True)
class LagMemory:
    """Where a `LagSum` stands: what came in last and its (m,) lags."""

    last: float
    state: FloatArray


def slopes(durations: FloatArray, values: FloatArray, last: float) -> FloatArray:
    """(n,) slope within each step; zero where a step has no duration."""
    change = np.diff(values, prepend=last)
    return np.divide(change, durations, out=np.zeros_like(change), where=durations > 0.0)
