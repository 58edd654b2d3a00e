"""How strong a hidden effect is and where it shows: what is left once the base model has explained what it can.

Base parameters and nuisances, each projected off by its derivative: tool radius, exponent of force over depth and width
of the lower face's field for the session; gain, zero and time shift for each trial. Where the lab is not as told, what
it does not know is projected off too, as far as its error goes (`doubts`): an effect that only a better set-up would
show is not strong.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import brentq

from benchmark.blind.doubts import doubts
from benchmark.blind.hidden import Hidden
from benchmark.blind.motion import Array, PressPlan, phases
from benchmark.blind.scene import Scene, Whitened, frame_phases, whiten
from benchmark.blind.simulate import FaceMarkers, Signals

SHAPE_STEPS = {"radius": 0.01, "exponent": 0.01, "width": 0.01}
DELAY_STEP = 5e-3
TOLERANCE = 0.003
FREE = 1e3
"""Norm of a free parameter's tangent, in standard deviations: what it explains is charged a millionth."""
SHOWS = 5.0
MAY_SHOW = 2.5
Cell = tuple[str, str]


@dataclass(frozen=True, eq=False)
class Base:
    """The base model's mean trials and their whitened tangents.

    Attributes
    ----------
    means : tuple of Signals
        One a condition, without effects.
    tangents : (samples of all conditions, parameters)
        Whitened, each condition's rows times the root of its repeats.
    errors : (parameters,) or None
        Standard deviation of each parameter, in units of its tangent; None where all are free.
    """

    means: tuple[Signals, ...]
    tangents: Array
    errors: Array | None = None

    def unexplained(self, whole: Array) -> tuple[Array, float]:
        """What no parameter explains, and the squared pull on those that are known."""
        if self.errors is None:
            scaled = self.tangents / np.linalg.norm(self.tangents, axis=0).clip(1e-30)
            return whole - scaled @ np.linalg.lstsq(scaled, whole, rcond=1e-9)[0], 0.0
        scaled, factor = self._factor
        pull = cho_solve(factor, scaled.T @ whole)
        return whole - scaled @ pull, float(pull @ pull)

    @cached_property
    def _factor(self) -> tuple[Array, tuple[Array, bool]]:
        """Tangents in units of their errors, a free one's so large that nothing holds it, and their normal matrix."""
        assert self.errors is not None
        free = FREE / np.linalg.norm(self.tangents, axis=0).clip(1e-30)
        scaled = self.tangents * np.minimum(self.errors, free)
        return scaled, cho_factor(scaled.T @ scaled + np.eye(scaled.shape[1]))


def base_of(scene: Scene) -> Base:
    """Simulate the base and its derivatives."""
    means = tuple(scene.mean(plan, ()) for plan in scene.plans)
    columns = [_session_column(scene, means, name, step) for name, step in SHAPE_STEPS.items()]
    for number, (plan, mean) in enumerate(zip(scene.plans, means, strict=True)):
        columns += [_placed(scene, means, number, each) for each in _trial_tangents(scene, plan, mean)]
    unsure = doubts(scene, means)
    if not unsure:
        return Base(means, np.stack(columns, axis=1))
    free = [np.inf] * len(columns)
    columns += [
        _weight(scene) * np.concatenate([whiten(scene, part).stacked() for part in each.change]) for each in unsure
    ]
    return Base(means, np.stack(columns, axis=1), np.array(free + [each.error for each in unsure]))


def leftover(scene: Scene, base: Base, effects: Sequence[Hidden]) -> tuple[Whitened, ...]:
    """What the base cannot explain of the effects, whitened, times the root of the repeats; one a condition."""
    return _left(scene, base, effects)[0]


def _left(scene: Scene, base: Base, effects: Sequence[Hidden]) -> tuple[tuple[Whitened, ...], float]:
    """The leftover, and the squared pull on what the lab knows."""
    changes = [
        whiten(scene, scene.mean(plan, effects).minus(mean)) for plan, mean in zip(scene.plans, base.means, strict=True)
    ]
    rest, pull = base.unexplained(_weight(scene) * np.concatenate([change.stacked() for change in changes]))
    return tuple(_split(rest, changes)), pull


def strength(scene: Scene, base: Base, effects: Sequence[Hidden]) -> float:
    """D: the norm of what the base cannot explain, in standard deviations of the trial mean."""
    rest, pull = _left(scene, base, effects)
    return float(np.sqrt(sum(np.sum(each.stacked() ** 2) for each in rest) + pull))


def scaled_to(scene: Scene, base: Base, effect: Hidden, wanted: float) -> Hidden:
    """The effect with the amplitude at which D is `wanted`.

    Raises
    ------
    ValueError
        When not even its largest amplitude is that strong.
    """
    low, high = 0.0, 1e-3
    while strength(scene, base, [effect.of_size(high)]) < wanted:
        if high >= effect.largest:
            raise ValueError(f"{effect.slug}: D = {wanted:g} is out of reach at amplitude {high:g}")
        low, high = high, min(4.0 * high, effect.largest)

    def missing(amplitude: float) -> float:
        return strength(scene, base, [effect.of_size(amplitude)]) - wanted

    return effect.of_size(float(brentq(missing, low, high, xtol=1e-9, rtol=TOLERANCE)))


def _session_column(scene: Scene, means: Sequence[Signals], name: str, step: float) -> Array:
    """Derivative of all conditions by a parameter of the body's shape."""
    shape = scene.body.shape
    shifted = scene.with_body(replace(scene.body, shape=replace(shape, **{name: getattr(shape, name) + step})))
    parts = [
        whiten(scene, shifted.mean(plan, ()).minus(mean)).stacked()
        for plan, mean in zip(scene.plans, means, strict=True)
    ]
    return _weight(scene) * np.concatenate(parts)


def _trial_tangents(scene: Scene, plan: PressPlan, mean: Signals) -> list[Signals]:
    """Derivatives of one trial by its gain, zero and time shift."""
    still_x = None if mean.x is None else np.zeros_like(mean.x)
    still_y = None if mean.y is None else np.zeros_like(mean.y)
    return [
        Signals(mean.force, still_x, still_y),
        Signals(np.full_like(mean.force, abs(mean.force).max()), still_x, still_y),
        scene.mean(plan, (), DELAY_STEP).minus(mean),
    ]


def _placed(scene: Scene, means: Sequence[Signals], number: int, tangent: Signals) -> Array:
    """A tangent of one condition among zeros for the others."""
    parts = [
        whiten(scene, tangent).stacked() if row == number else np.zeros(_size(mean)) for row, mean in enumerate(means)
    ]
    return _weight(scene) * np.concatenate(parts)


def _split(rest: Array, changes: Sequence[Whitened]) -> list[Whitened]:
    out = []
    for change in changes:
        force, rest = rest[: change.force.size], rest[change.force.size :]
        x = y = None
        if change.x is not None and change.y is not None:
            x, rest = rest[: change.x.size].reshape(change.x.shape), rest[change.x.size :]
            y, rest = rest[: change.y.size].reshape(change.y.shape), rest[change.y.size :]
        out.append(Whitened(force, x, y))
    return out


def _size(signals: Signals) -> int:
    return signals.force.size + sum(part.size for part in (signals.x, signals.y) if part is not None)


def _weight(scene: Scene) -> float:
    return float(np.sqrt(scene.repeats))


@dataclass(frozen=True)
class TrueCells:
    """Cells (channel, phase) of a hidden effect.

    Attributes
    ----------
    strongest : (channel, phase) or None
        Where it shows most.
    shows : tuple of (channel, phase)
        More than `SHOWS` standard deviations of the trial mean: who misses one has missed it.
    may_show : tuple of (channel, phase)
        More than `MAY_SHOW`, or in the single markers of a channel whose mean has nothing: finding one is no error.
    """

    strongest: Cell | None
    shows: tuple[Cell, ...]
    may_show: tuple[Cell, ...]


def true_cells(scene: Scene, base: Base, effects: Sequence[Hidden]) -> TrueCells:
    """Cells of the effects together."""
    power: dict[Cell, float] = defaultdict(float)
    single: dict[Cell, float] = defaultdict(float)
    for plan, rest in zip(scene.plans, leftover(scene, base, effects), strict=True):
        moved = scene.motion(plan)
        for phase, rows in phases(moved.time, moved.depth).items():
            power["force_z", phase] += float(np.sum(rest.force[rows] ** 2))
        if scene.grid is not None:
            for phase, rows in frame_phases(moved).items():
                for channel, values in _marker_channels(scene.grid, rest).items():
                    power[channel, phase] += float(np.sum(values[rows] ** 2))
                for channel, seen in (("marker_x", rest.x), ("marker_y", rest.y)):
                    single[channel, phase] += 0.0 if seen is None else float(np.sum(seen[rows] ** 2))
    size = {cell: np.sqrt(value) for cell, value in power.items()}
    shows = tuple(sorted(cell for cell, value in size.items() if value >= SHOWS))
    loose = {cell for cell, value in size.items() if value >= MAY_SHOW}
    loose |= {cell for cell, value in single.items() if np.sqrt(value) >= MAY_SHOW}
    strongest = max(shows, key=lambda cell: size[cell], default=None)
    return TrueCells(strongest, shows, tuple(sorted(loose)))


def _marker_channels(grid: FaceMarkers, rest: Whitened) -> dict[str, Array]:
    """Values (f, ...) of each channel: radial and tangential of each marker, x and y of all markers together."""
    if rest.x is None or rest.y is None:
        return {}
    x0, y0 = grid.positions()
    radius = np.hypot(x0, y0)
    together = np.sqrt(x0.size)
    return {
        "marker_radial": (rest.x * x0 + rest.y * y0) / radius,
        "marker_tangential": (rest.y * x0 - rest.x * y0) / radius,
        "marker_x": rest.x.mean(axis=1) * together,
        "marker_y": rest.y.mean(axis=1) * together,
    }
