"""The elastic table of a set-up: force and lower face on a fine grid of depths, and how set-up parameters change them.

Derivatives are the finite elements' own or come from differences; the table only keeps their orders. Keys are those
of `--set` (`tool.radius`, `dermis.youngs_modulus`, `support.hole_radius`...). Nothing here runs a model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from typing import Any, Literal, TypeAlias

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.files import Support, Tissue, Tool
from benchmark.response.force_curve import Array
from benchmark.response.setup_change import is_absolute, way_of

POINTS = 500
"""Depths of a table."""
TERMS = 5
"""Terms of a field."""
MOST_GROWN = 5.0
"""Largest change of the logarithm of a force that is believed."""
ROUND_OFF = 1e-5
"""Terms of a basis below this share of the first are left out."""
ALIKE = 0.01
"""Fields below this share of the first are taken for as large, where a basis is chosen: their unit may be small."""
LEAST = 1e-300
NONE: Mapping[str, float] = {}


@dataclass(frozen=True, eq=False)
class SeparableField:
    """A field over depth and radius, m: the sum of amplitudes (c, k) over depth times shapes (c, q) over radius."""

    amplitudes: Array
    shapes: Array

    @property
    def table(self) -> Array:
        """(k, q) values at all depths and radii, m."""
        return np.asarray(self.amplitudes.T @ self.shapes)

    @staticmethod
    def of(levels: Array, table: Array, grid: Array, terms: int = TERMS) -> SeparableField:
        """The first terms of a table (levels, q) at depths (levels,), its amplitudes on a grid (k,) of depths."""
        left, sizes, right = np.linalg.svd(table, full_matrices=False)
        amplitudes = CubicSpline(levels, left[:, :terms] * sizes[:terms])(grid)
        return SeparableField(np.ascontiguousarray(amplitudes.T), np.ascontiguousarray(right[:terms]))

    def plus(self, parts: list[tuple[float, SeparableField]]) -> SeparableField:
        """Itself and factors times other fields on the same depths and radii."""
        if all(other.shapes is self.shapes for _, other in parts):
            amplitudes = self.amplitudes + sum(factor * other.amplitudes for factor, other in parts)
            return SeparableField(amplitudes, self.shapes)
        every = [self.amplitudes, *(factor * other.amplitudes for factor, other in parts)]
        return SeparableField(
            np.concatenate(every), np.concatenate([self.shapes, *(other.shapes for _, other in parts)])
        )

    @staticmethod
    def on_one_basis(fields: Sequence[SeparableField]) -> tuple[SeparableField, ...]:
        """The same fields on shapes (c, q) that all share, so that their sums have no more terms than one of them.

        What is left out of a field is small beside the first one, and beside the field itself where that is small.
        """
        sizes = [np.linalg.qr(field.amplitudes.T, mode="r") @ field.shapes for field in fields]
        largest = float(np.linalg.norm(sizes[0]))
        grown = [each * max(1.0, ALIKE * largest / max(float(np.linalg.norm(each)), LEAST)) for each in sizes]
        _, values, basis = np.linalg.svd(np.concatenate(grown), full_matrices=False)
        shapes = np.ascontiguousarray(basis[values > ROUND_OFF * values[0]])
        return tuple(SeparableField(shapes @ field.shapes.T @ field.amplitudes, shapes) for field in fields)


@dataclass(frozen=True, eq=False)
class SetupDerivative:
    """What a set-up parameter changes, by the orders (first, second) of its change: f', f''/2.

    The change is a share of its value, or an amount where `setup_change.is_absolute`.

    Attributes
    ----------
    force : (o, k) array
        N, over the change's powers.
    outward, sink : tuple of SeparableField
        One an order, as many as are known; m.
    """

    force: Array
    outward: tuple[SeparableField, ...] = ()
    sink: tuple[SeparableField, ...] = ()


@dataclass(frozen=True, eq=False)
class Addition:
    """What an amount of something that the set-up as told has none of adds, from presses with some amounts of it.

    Over the amount, it goes between them as a natural cubic spline over their logarithm does; below the first and
    beyond the last in proportion.

    Attributes
    ----------
    amounts : (n,) array
        SI, rising from above zero.
    force : (n, k) array
        N over the amount, of each.
    outward, sink : tuple of SeparableField
        m over the amount, of each; empty where no face is known.
    powers : mapping of key to (k,) array
        The powers of set-up parameters with which the added force goes.
    """

    amounts: Array
    force: Array
    outward: tuple[SeparableField, ...] = ()
    sink: tuple[SeparableField, ...] = ()
    powers: Mapping[str, Array] = field(default_factory=dict)

    def weights(self, amount: float) -> Array:
        """(n,) by which what a unit adds at each of the amounts counts to what an amount adds."""
        if self.amounts.size == 1:
            return np.array([amount])
        at = np.log(np.clip(amount, self.amounts[0], self.amounts[-1]))
        return np.asarray(amount * self._between(at))

    @cached_property
    def _between(self) -> CubicSpline:
        return CubicSpline(np.log(self.amounts), np.eye(self.amounts.size), bc_type="natural")

    def force_of(self, amount: float, changes: Mapping[str, float]) -> Array:
        """(k,) N that an amount adds, with set-up parameters changed."""
        more = self.weights(amount) @ self.force
        ways = {key: way_of(key, changes[key]) for key in self.powers if changes.get(key)}
        grown = sum((self.powers[key] * way for key, way in ways.items()), start=np.zeros_like(more))
        return np.asarray(np.exp(np.clip(grown, -MOST_GROWN, MOST_GROWN)) * more)


@dataclass(frozen=True, eq=False)
class ElasticTable:
    """Force and lower face over depth.

    A bonded lower face does not move, so markers under it stay where they are.

    Attributes
    ----------
    depth : (k,) array
        m from 0, evenly spaced.
    force : (k,) array
        N at modulus factor 1.
    radius : (q,) array
        m.
    outward, sink : SeparableField or None
        Motion of the lower face away from the axis and along the press.
    by : mapping of key to SetupDerivative
        Parameters act each by itself: there are no mixed terms.
    added : mapping of key to Addition
        What something that the set-up as told has none of adds: a tension before the press by its
        `physics.pretension`.
    note : str
        What a reader must know of it.
    """

    depth: Array
    force: Array
    radius: Array
    outward: SeparableField | None = None
    sink: SeparableField | None = None
    by: Mapping[str, SetupDerivative] = field(default_factory=dict)
    added: Mapping[str, Addition] = field(default_factory=dict)
    note: str = ""

    def force_with(self, changes: Mapping[str, float]) -> Array:
        """(k,) N with parameters changed by shares of their values; a key that the table lacks changes nothing.

        The logarithm of the force goes with that of the parameter, to the orders that are known: of 25 % of a layer's
        modulus or 5 % of a length a power of first order leaves 0.1 to 0.5 % of the force on three layers of skin, one
        of second order 0.01 to 0.05 % (docs/fem.md).
        """
        grown = sum(
            (
                part * way_of(key, change) ** order
                for key, change in self._known(changes)
                for order, part in enumerate(self._log_orders[key], start=1)
            ),
            start=np.zeros_like(self.force),
        )
        return np.asarray(self.force * np.exp(np.clip(grown, -MOST_GROWN, MOST_GROWN)))

    def force_added(self, amounts: Mapping[str, float], changes: Mapping[str, float] = NONE) -> Array:
        """(k,) N that amounts of what the set-up as told has none of add, with parameters changed as `force_with`."""
        parts = (self.added[key].force_of(amount, changes) for key, amount in amounts.items())
        return np.asarray(sum(parts, start=np.zeros_like(self.force)))

    @cached_property
    def _log_orders(self) -> dict[str, Array]:
        """Orders (o, k) of the logarithm of the force by the way of each parameter; 0 where there is no force."""
        return {key: _of_logarithm(self.force, each.force, is_absolute(key)) for key, each in self.by.items()}

    def outward_with(
        self,
        changes: Mapping[str, float],
        amounts: Mapping[str, float] = NONE,
        shown: Mapping[str, float] = NONE,
    ) -> SeparableField | None:
        """The outward motion with parameters changed, as `force_with`, linear or of second order in the way.

        `amounts` are of what the set-up as told has none of, `shown` the part of each that the face shows (1).
        """
        parts = [part for key, change in self._known(changes) for part in _moved(self.by[key].outward, key, change)]
        parts += self._parts("outward", amounts, shown)
        return None if self.outward is None else self.outward.plus(parts)

    def sink_with(
        self,
        changes: Mapping[str, float],
        amounts: Mapping[str, float] = NONE,
        shown: Mapping[str, float] = NONE,
    ) -> SeparableField | None:
        """The sinking with parameters changed, as `outward_with`."""
        parts = [part for key, change in self._known(changes) for part in _moved(self.by[key].sink, key, change)]
        parts += self._parts("sink", amounts, shown)
        return self.sink if self.sink is None or not parts else self.sink.plus(parts)

    def compact(self) -> ElasticTable:
        """The same table with the fields of each kind on one basis."""
        if self.outward is None or self.sink is None:
            return self
        parts: list[SetupDerivative | Addition] = [*self.by.values(), *self.added.values()]
        out = SeparableField.on_one_basis([self.outward, *(f for each in parts for f in each.outward)])
        sunk = SeparableField.on_one_basis([self.sink, *(f for each in parts for f in each.sink)])
        outs, sinks = iter(out[1:]), iter(sunk[1:])

        def faces(each: SetupDerivative | Addition) -> dict[str, Any]:
            return {
                "outward": tuple(islice(outs, len(each.outward))),
                "sink": tuple(islice(sinks, len(each.sink))),
            }

        by = {key: replace(each, **faces(each)) for key, each in self.by.items()}
        added = {key: replace(each, **faces(each)) for key, each in self.added.items()}
        return replace(self, outward=out[0], sink=sunk[0], by=by, added=added)

    def _parts(
        self, face: Literal["outward", "sink"], amounts: Mapping[str, float], shown: Mapping[str, float]
    ) -> list[tuple[float, SeparableField]]:
        """Factors of the fields that amounts add."""
        parts: list[tuple[float, SeparableField]] = []
        for key, amount in amounts.items():
            fields, weights = getattr(self.added[key], face), self.added[key].weights(amount)
            parts += [(shown.get(key, 1.0) * float(w), f) for w, f in zip(weights, fields, strict=False)]
        return parts

    def _known(self, changes: Mapping[str, float]) -> list[tuple[str, float]]:
        return [(key, change) for key, change in changes.items() if key in self.by]


TableOf: TypeAlias = Callable[[Tissue, Tool, Support, float], ElasticTable]
"""The table of one set-up to a depth, m."""


def _of_logarithm(force: Array, orders: Array, absolute: bool) -> Array:
    """Orders (o, k) of log f by the way x of a parameter, of orders f', f''/2 by its change.

    d log f/dx = f'/f and d2 log f/dx2 = f''/f - (f'/f)^2, plus f'/f where x is a logarithm.
    """
    share = np.divide(orders, force, out=np.zeros_like(orders), where=force > 0.0)
    if len(share) == 1:
        return share
    return np.stack([share[0], share[1] - 0.5 * share[0] ** 2 + (0.0 if absolute else 0.5 * share[0])])


def _moved(fields: tuple[SeparableField, ...], key: str, change: float) -> list[tuple[float, SeparableField]]:
    """Factors of a field's orders by the way of a parameter: u' x + (u'' + u') x^2/2 where x is a logarithm."""
    way = way_of(key, change)
    first = way if is_absolute(key) else way + 0.5 * way**2
    return list(zip((first, way**2), fields, strict=False))
