"""First-order lags, time x' + x = F, and the linear answers that are sums of them: relaxation and creep.

With the transform G(s) = 1 - sum_j g_j / (1 + s tau_j) + eta s of force over depth (a Prony series and a Kelvin-Voigt
time eta), creep is 1 / G(s): the same solid driven by force instead of depth. Its poles lie one below each rate
1 / tau_j (and with eta one above the fastest); each adds a lag of weight 1 / (lambda G'(-lambda)), all positive
(B. Gross, Mathematical Structure of the Theories of Viscoelasticity, 1953).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from wavemodel.arrays import BoolArray, FloatArray, IntArray, NumberArray
from wavemodel.integrators.scan import decaying_sum
from wavemodel.integrators.viscoelastic import Prony

WINDOW = 256
"""Steps that are looked ahead for where a tool loses a surface, or meets it; twice as many where it does not."""


@dataclass(frozen=True)
class LagStep:
    """x+ = keep x + first F_n + last F_{n+1}, exact for a force linear within the step.

    Attributes
    ----------
    keep, first, last
        Numbers, or arrays with one entry a lag.
    """

    keep: NumberArray
    first: NumberArray
    last: NumberArray


def lag_step(ratio: NumberArray) -> LagStep:
    """Coefficients for steps of `ratio` = duration / time, not negative; a step without duration keeps x."""
    lost = -np.expm1(-ratio)
    mean = np.divide(lost, ratio, out=np.ones_like(ratio), where=ratio != 0.0)
    return LagStep(1.0 - lost, mean - (1.0 - lost), 1.0 - mean)


def lagged(ratio: NumberArray, force: FloatArray, last: float = 0.0, start: NumberArray | float = 0.0) -> NumberArray:
    """(..., n) responses x to a force that is linear within each step.

    Parameters
    ----------
    ratio
        (..., n) durations of the steps over the lags' times.
    force
        (n,) at the ends of the steps.
    last
        Force before the first step.
    start
        (...) responses before the first step.
    """
    step = lag_step(ratio)
    before = np.concatenate([[last], force[:-1]])
    return decaying_sum(ratio, step.first * before + step.last * force, start)


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
    weight: NumberArray
    time: NumberArray
    rate: float = 0.0

    @property
    def static(self) -> float:
        """The answer to one, after a long time."""
        return float(np.real(self.instant + self.weight.sum()))

    def lags(self, durations: FloatArray, values: FloatArray, memory: "LagMemory | None" = None) -> NumberArray:
        """(m, n) responses of the lags to values (n,) at the ends of steps (n,), s."""
        return self._stage(durations, memory or self.rest()).follow(values)[1]

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
        out, state = self._stage(durations, memory).follow(values)
        if self.rate:
            out += self.rate * slopes(durations, values, memory.last)
        return out, LagMemory(float(values[-1]), state[:, -1])

    def rest(self, value: float = 0.0) -> "LagMemory":
        """Memory of having been at one value for ever."""
        return LagMemory(value, np.full(self.time.size, value))

    def surface(self, durations: FloatArray, values: FloatArray, start: float, hold: float) -> "Standing":
        """What comes in from a surface under a tool that holds it with a pull, and what becomes of it; see `standing`.

        Parameters
        ----------
        durations, values
            See `follow`; what comes in (n,) where the tool holds the surface.
        start
            At which the body has been for ever.
        hold
            The pull.
        """
        stage, touching = self._stage(durations, self.rest(start)), np.ones(values.size, dtype=np.bool_)
        return standing([stage], durations, values, touching, rate=self.rate, last=start, hold=hold)

    def _stage(self, durations: FloatArray, memory: "LagMemory") -> "LagStage":
        return LagStage(self, durations / self.time[:, None], memory)


@dataclass(frozen=True)
class LagMemory:
    """Where a `LagSum` stands: what came in last and its (m,) lags."""

    last: float
    state: NumberArray


@dataclass(frozen=True)
class LagStage:
    """One `LagSum` in a history, apart from what it makes of the slope.

    Attributes
    ----------
    law
        The sum.
    ratio
        (m, n) durations of the steps over the lags' times.
    memory
        Before the first step.
    """

    law: LagSum
    ratio: NumberArray
    memory: LagMemory

    def follow(self, values: FloatArray) -> tuple[FloatArray, NumberArray]:
        """(n,) answer to values (n,) at the ends of the steps, and the (m, n) lags."""
        lags = lagged(self.ratio, values, self.memory.last, self.memory.state)
        return self.answer(values, lags), lags

    def answer(self, values: FloatArray, lags: NumberArray) -> FloatArray:
        """(n,) answer to values (n,) with lags (m, n)."""
        return np.real(self.law.instant * values + self.law.weight @ lags)

    def part(self, here: slice, memory: LagMemory) -> "LagStage":
        """Some of its steps, with the memory before them."""
        return LagStage(self.law, self.ratio[:, here], memory)


@dataclass(frozen=True)
class Standing:
    """A surface that a tool may lose, in a history of n steps.

    Attributes
    ----------
    value
        (n,) what comes in.
    free
        (n,) whether the tool is off it.
    lags
        (m, n) of each sum.
    answer
        (n,) of the sums, without what they make of the slope; about nought where the surface is free.
    memories
        Of the sums after the last step.
    """

    value: FloatArray
    free: BoolArray
    lags: tuple[NumberArray, ...]
    answer: FloatArray
    memories: tuple[LagMemory, ...]


def lag_end(
    before: float, lags: Iterable[complex], steps: Iterable[tuple[complex, complex, complex]]
) -> tuple[float, float]:
    """Offset and gain: after a step weighted lags add up to offset + gain F for an F that comes in at its end.

    Parameters
    ----------
    before
        What came in at the step's start.
    lags
        (m,) weighted, before it.
    steps
        (m,) of keep, first and last of a `LagStep`, the last two times a lag's weight.
    """
    offset, gain = 0.0j, 0.0j
    for lag, (keep, first, last) in zip(lags, steps, strict=True):
        offset += keep * lag + first * before
        gain += last
    return offset.real, gain.real


def free_motion(laws: Sequence[tuple[LagSum, NumberArray]], rate: float = 0.0) -> tuple[NumberArray, NumberArray]:
    """How lags go on, z' = matrix z, while what comes in makes no answer, and what comes in, row z.

    Parameters
    ----------
    laws
        Sums one after the other, and the (m,) rates of their lags, 1/s.
    rate
        Factor of the slope of what comes in, beside the sums, s; what comes in is then the last entry of z.
    """
    count = sum(speed.size for _, speed in laws)
    matrix, fed = np.zeros((count, count), dtype=np.complex128), np.zeros(count, dtype=np.complex128)
    row, share, first = np.zeros(count, dtype=np.complex128), 1.0, 0
    for law, speed in laws:
        own = slice(first, first + speed.size)
        matrix[own] = np.outer(speed, row)
        matrix[own, own] -= np.diag(speed)
        fed[own] = speed * share
        row, share, first = law.instant * row, law.instant * share, own.stop
        row[own] += law.weight
    if rate:
        below = np.append(row, share) / -rate
        matrix, row = np.vstack([np.column_stack([matrix, fed]), below]), np.append(np.zeros(count), 1.0)
    else:
        row = -row / share
        matrix = matrix + np.outer(fed, row)
    if any(np.iscomplexobj(law.weight) for law, _ in laws):
        return matrix, row
    return matrix.real, row.real


def standing(
    stages: Sequence[LagStage],
    durations: FloatArray,
    tool: FloatArray,
    touching: BoolArray,
    *,
    rate: float = 0.0,
    last: float = 0.0,
    hold: float = 0.0,
    held: bool = True,
) -> Standing:
    """What comes in from a surface under a tool that may lose it.

    Signorini's condition at the end of each step: a tool that would pull is off, and the surface creeps back by
    itself, exactly, until the tool meets it where it then stands. In the step in which it is lost what comes in is
    taken as linear. As long as nothing is lost, it is what the tool says.

    Parameters
    ----------
    stages
        Sums one after the other that what comes in goes through.
    durations
        (n,) of the steps, s.
    tool
        (n,) what comes in where the tool holds the surface.
    touching
        (n,) whether the tool is where it can touch.
    rate
        Factor of the slope of what comes in, beside the sums, s.
    last
        What came in before the first step.
    hold
        The pull with which the surface sticks to a tool that touches it.
    held
        Whether it was touched before the first step.
    """
    memories = [stage.memory for stage in stages]
    lags = [np.empty(stage.ratio.shape, dtype=np.result_type(stage.law.weight)) for stage in stages]
    run = _UnheldRun(stages, durations, tool, touching, rate, hold, tool.copy(), ~touching, lags)
    run.follow(memories, last, held)
    return Standing(run.out, run.free, tuple(lags), run.answer(), tuple(run.at(tool.size - 1)))


@dataclass(frozen=True)
class _UnheldRun:
    """What `standing` is given."""

    stages: Sequence[LagStage]
    durations: FloatArray
    tool: FloatArray
    touching: BoolArray
    rate: float
    hold: float
    out: FloatArray
    free: BoolArray
    lags: Sequence[NumberArray]

    def follow(self, memories: list[LagMemory], last: float, held: bool) -> None:
        """From event to event: first all steps at once, then in windows that grow where there is none."""
        at, size = 0, self.out.size
        while at < self.out.size:
            here = slice(at, min(at + size, self.out.size))
            events = self._lost(here, memories, last) if held else self._let_return(here, memories, last)
            end = at + int(events[0]) if events.size else here.stop
            if end > at:
                memories, last = self.at(end - 1), float(self.out[end - 1])
            if events.size and held:
                self.out[end], self.free[end] = self._still(end, memories, last), True
                self._pressed(slice(end, end + 1), memories)
                memories, last = self.at(end), float(self.out[end])
            size = WINDOW if events.size and held else 2 * size
            at, held = end + int(events.size > 0 and held), held != bool(events.size)

    def answer(self) -> FloatArray:
        """(n,) of the sums."""
        values = self.out
        for stage, lags in zip(self.stages, self.lags, strict=True):
            values = stage.answer(values, lags)
        return values

    def _lost(self, here: slice, memories: list[LagMemory], last: float) -> IntArray:
        """Hold the surface in some steps; those, from their first, at whose ends the tool would pull."""
        answer = self._pressed(here, memories)
        if self.rate:
            answer = answer + self.rate * slopes(self.durations[here], self.out[here], last)
        return np.flatnonzero(answer < np.where(self.touching[here], -self.hold, 0.0))

    def _pressed(self, here: slice, memories: list[LagMemory]) -> FloatArray:
        """(n,) answer to what comes in, taken as linear, in some steps."""
        values = self.out[here]
        for stage, memory, lags in zip(self.stages, memories, self.lags, strict=True):
            values, lags[:, here] = stage.part(here, memory).follow(values)
        return values

    def at(self, step: int) -> list[LagMemory]:
        """Memories after a step."""
        value, out = self.out[step : step + 1], []
        for stage, lags in zip(self.stages, self.lags, strict=True):
            out.append(LagMemory(float(value[0]), lags[:, step]))
            value = stage.answer(value, lags[:, step : step + 1])
        return out

    def _let_return(self, here: slice, memories: list[LagMemory], last: float) -> IntArray:
        """Let a free surface creep back by itself in some steps; those at which a tool would be met."""
        states, row = self._freed(here, memories, last)
        back, first = np.real(row @ states), 0
        met = np.flatnonzero(self.touching[here] & (self.tool[here] >= back))
        end = int(met[0]) if met.size else back.size
        kept = slice(here.start, here.start + end)
        self.out[kept], self.free[kept] = back[:end], True
        for lags in self.lags:
            lags[:, kept] = states[first : first + len(lags), :end]
            first += len(lags)
        return met

    def _freed(self, here: slice, memories: list[LagMemory], last: float) -> tuple[NumberArray, NumberArray]:
        durations = self.durations[here]
        start = np.concatenate([memory.state for memory in memories] + [np.array([last])] * bool(self.rate))
        if not start.any():
            return np.zeros((start.size, durations.size), dtype=start.dtype), np.zeros(start.size)  # it stays at rest
        moves = int((durations > 0.0).argmax())  # a step without a duration tells no rates
        pace = durations[moves] or np.inf
        laws = [(stage.law, stage.ratio[:, here.start + moves] / pace) for stage in self.stages]
        matrix, row = free_motion(laws, self.rate)
        speeds, shapes = np.linalg.eig(matrix)
        parts = np.linalg.solve(shapes, start.astype(shapes.dtype))
        states = shapes @ (parts[:, None] * np.exp(np.outer(speeds, np.cumsum(durations))))
        return (states if np.iscomplexobj(matrix) else np.real(states)), row

    def _still(self, at: int, memories: list[LagMemory], last: float) -> float:
        """What comes in at the end of a step that answers with nothing."""
        duration = float(self.durations[at])
        if self.rate and duration == 0.0:
            return last  # what is damped does not move in no time
        jump, offset, gain = self.rate / duration if self.rate else 0.0, 0.0, 1.0
        for stage, memory in zip(self.stages, memories, strict=True):
            step, weight = lag_step(stage.ratio[:, at]), stage.law.weight
            steps = zip(step.keep, weight * step.first, weight * step.last, strict=True)
            kept, share = lag_end(memory.last, weight * memory.state, steps)
            share += stage.law.instant
            offset, gain = share * offset + kept, share * gain
        return (jump * last - offset) / (gain + jump)


def slopes(durations: FloatArray, values: FloatArray, last: float) -> FloatArray:
    """(n,) slope within each step; zero where a step has no duration."""
    change = np.diff(values, prepend=last)
    return np.divide(change, durations, out=np.zeros_like(change), where=durations > 0.0)


def relaxation(series: Prony, retardation: float = 0.0) -> LagSum:
    """Force over initial stiffness, driven by depth.

    Parameters
    ----------
    series
        Relaxation.
    retardation
        Kelvin-Voigt time eta, s.
    """
    strength, rate = series.ordered
    return LagSum(1.0, -strength, 1.0 / rate, retardation)


@lru_cache(maxsize=256)
def creep(series: Prony, retardation: float = 0.0) -> LagSum:
    """Depth over initial compliance, driven by force: the inverse of `relaxation`."""
    roots = np.array(_rates(series, retardation))
    strength, rate = series.ordered
    slope = retardation + (strength * rate / (rate - roots[:, None]) ** 2).sum(axis=1)
    weight = 1.0 / (roots * slope)
    return LagSum(0.0 if retardation else 1.0, weight, 1.0 / roots)


def _rates(series: Prony, retardation: float) -> list[float]:
    """Rates lambda of creep, rising: G(-lambda) = 0."""
    strength, rate = series.ordered

    def transform(root: float) -> float:
        return float(1.0 - retardation * root - (strength * rate / (rate - root)).sum())

    edges: FloatArray = np.concatenate([[0.0], rate])
    brackets = [(low + _gap(low), high - _gap(high)) for low, high in pairwise(edges)]
    if retardation:
        fastest = (edges[-1] + 1.0 / retardation) * (2.0 + strength.sum())
        brackets.append((edges[-1] + _gap(edges[-1]), fastest))
    return [brentq(transform, low, high, xtol=1e-300, rtol=1e-15) for low, high in brackets]


def _gap(rate: float) -> float:
    return 1e-12 * rate
