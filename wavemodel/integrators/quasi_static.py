"""Presses that are slow against the first frequency: inertia left out, damping by stiffness and relaxation kept.

The first frequency of skin on a base is a few hundred hertz, a press takes seconds. Where all layers relax alike every
mode is in the same state, x(t) times its static answer, and the whole history is one scalar. Where each relaxes in its
own way there is one field for each of a few shared lags.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray, NumberArray
from wavemodel.integrators.lags import LagSum, Standing, creep, relaxation, slopes
from wavemodel.integrators.load_history import History, Load
from wavemodel.integrators.viscoelastic import ELASTIC, Prony


class StaticBody(Protocol):
    """A body without inertia whose answer is made of B fields, each driven by its own force in time."""

    @property
    def unit(self) -> FloatArray:
        """(B, L, K) amplitudes of the fields per force, m3/N."""
        ...

    @property
    def axis(self) -> FloatArray:
        """(B, L) deflection of each layer's top face on the axis per force, m/N."""
        ...

    def follow(self, load: Load) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, B) force that drives each field in N, (n,) force in N and (n,) depth in m."""
        ...


@dataclass(frozen=True)
class SharedBody:
    """All layers creep alike: one field.

    Attributes
    ----------
    unit, axis
        (1, L, K) and (1, L) static answers per force by the initial moduli.
    compliance
        Initial depth per force, m/N.
    series
        Relaxation.
    retardation
        Kelvin-Voigt time, s.
    sticks
        Whether the surface sticks to the tool; if not, one that creeps or is damped is not pulled by depth.
    """

    unit: FloatArray
    axis: FloatArray
    compliance: float
    series: Prony = ELASTIC
    retardation: float = 0.0
    sticks: bool = True

    def follow(self, load: Load) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, 1) force on the field, (n,) force, (n,) depth; exact for a force, or depth, linear in each step."""
        by_force = load.control == "force"
        law = (creep if by_force else relaxation)(self.series, self.retardation)
        driven = load.value if by_force else load.value / self.compliance
        if not self.series.strength and self.retardation == 0.0:
            return driven[:, None], driven, driven * self.compliance
        found, answer = answered(law, load, driven, by_force or self.sticks)
        driven = found.value
        driven_by, force = (answer, driven) if by_force else (driven, answer)
        return driven_by[:, None], force, driven_by * self.compliance


def answered(law: LagSum, load: Load, driven: FloatArray, sticks: bool) -> tuple[Standing, FloatArray]:
    """How a surface stands under a tool, and the (n,) answer.

    Parameters
    ----------
    law
        What lets force relax.
    load
        The history.
    driven
        (n,) what comes in where the tool holds the surface.
    sticks
        Whether it holds it in any case; if not, it does not pull.
    """
    driven = driven if sticks else np.maximum(driven, 0.0)
    start = load.initial(driven)
    found = law.surface(load.durations, driven, start, hold=np.inf if sticks else 0.0)
    answer = found.answer + law.rate * slopes(load.durations, found.value, start)
    return found, np.where(found.free, 0.0, answer)


def quasi_static(load: Load, body: StaticBody) -> History:
    """Run a load history without inertia; the depth is the surface's."""
    driven_by, force, depth = body.follow(load)
    unit = body.unit

    def amplitude(step: int) -> FloatArray:
        return np.asarray(np.einsum("b,blk->lk", driven_by[step], unit))

    return History(force, depth, driven_by @ body.axis, driven_by, amplitude)


@dataclass(frozen=True)
class LayerwiseBody:
    """B = 1 + M fields: the first answers at once, the others as lags of the force (a `StaticBody`).

    Attributes
    ----------
    unit
        (B, L, K) amplitudes per force, m3/N.
    axis
        (B, L) deflection of each layer's top face on the axis per force, m/N.
    depth
        (B,) depth per force, m/N; the first is zero under Kelvin-Voigt damping.
    rate
        (M,) of the lags, 1/s.
    sticks
        As of a `SharedBody`.
    """

    unit: FloatArray
    axis: FloatArray
    depth: FloatArray
    rate: FloatArray
    sticks: bool = True

    def follow(self, load: Load) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, B) force on each field, (n,) force, (n,) depth; exact for a force, or depth, linear in each step."""
        if load.control == "force":
            lags = self._lags(load, load.value, 1.0 / self.rate)
            driven_by = np.concatenate([load.value[:, None], lags.T], axis=1)
            return driven_by, load.value, driven_by @ self.depth
        inverse = self._inverse
        found, force = answered(inverse.law, load, load.value, self.sticks)
        state = np.outer(found.value, inverse.direct) + np.real(found.lags[0].T @ inverse.states.T)
        return np.concatenate([force[:, None], state], axis=1), force, found.value

    @staticmethod
    def _lags(load: Load, driven: FloatArray, time: NumberArray) -> NumberArray:
        bank = LagSum(0.0, np.ones(time.size), time)
        return bank.lags(load.durations, driven, bank.rest(load.initial(driven)))

    @cached_property
    def _inverse(self) -> "_DepthDriven":
        """Driven by depth d = c_0 F + c y, the lags y' = rate (F - y) obey y' = A y + b d or, with c_0 = 0, b d'."""
        first, rest = self.depth[0], self.depth[1:]
        pull = self.rate * rest
        if first > 0.0:
            matrix = -np.diag(self.rate) - np.outer(self.rate, rest) / first
            values, shapes = np.linalg.eig(matrix)
            driven = np.linalg.solve(shapes, (self.rate / first).astype(shapes.dtype))
            return _DepthDriven(
                -1.0 / values, -shapes * (driven / values), np.zeros(rest.size), 1.0 / first, -rest / first, 0.0
            )
        direct = self.rate / pull.sum()
        values, shapes = np.linalg.eig(-np.diag(self.rate) + np.outer(self.rate, pull) / pull.sum())
        driven = np.linalg.solve(shapes, direct.astype(shapes.dtype))
        kept = np.arange(values.size) != np.abs(values).argmin()
        return _DepthDriven(
            -1.0 / values[kept], -(shapes * driven)[:, kept], direct, 0.0, pull / pull.sum(), 1.0 / pull.sum()
        )


@dataclass(frozen=True)
class _DepthDriven:
    """The M lags of the force from lags of the depth, and the force from both.

    Attributes
    ----------
    time, states
        (m,) times of lags of the depth and (M, m) what they add to the lags of the force.
    direct
        (M,) what the depth itself adds.
    force_by_depth, force_by_state, force_by_rate
        The force per depth, per lag (M,) and per rate of depth.
    """

    time: NumberArray
    states: NumberArray
    direct: FloatArray
    force_by_depth: float
    force_by_state: FloatArray
    force_by_rate: float

    @property
    def law(self) -> LagSum:
        """Force over depth; its weights may be complex in pairs, which add up to what is real."""
        weight = self.force_by_state @ self.states
        return LagSum(
            self.force_by_depth + float(self.force_by_state @ self.direct), weight, self.time, self.force_by_rate
        )
