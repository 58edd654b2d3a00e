"""What a lab does not know of its set-up: how the mean trials change with it, and its standard deviation."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.blind.motion import PressPlan
from benchmark.blind.scene import Scene
from benchmark.blind.simulate import FaceMarkers, Signals

TOUCH_DEPTH = 0.15e-3
"""How deep a force that shows may find the surface, m."""
DEPTH_STEP, LENS_STEP, SHARE_STEP, PRINT_STEP = 0.02e-3, 0.005, 0.02, 0.05e-3
LENS_ERROR = 0.01


@dataclass(frozen=True, eq=False)
class Doubt:
    """One thing that is not known.

    Attributes
    ----------
    change : tuple of Signals
        Of the mean trial of each condition, for one unit.
    error : float
        Standard deviation in that unit.
    """

    change: tuple[Signals, ...]
    error: float


def doubts(scene: Scene, means: Sequence[Signals]) -> list[Doubt]:
    """All doubts of a scene's lab; none where everything is as told.

    A print scatter alone, with nothing else unknown, counts only in labs: the option of older suites does not.
    """
    if not scene.lab.doubtful:
        return []
    return [*_setup(scene, means), *_touch(scene, means), *_print(scene, means), *_lens(scene, means)]


def _setup(scene: Scene, means: Sequence[Signals]) -> Iterator[Doubt]:
    """Each layer's thickness and modulus, the specimens' height, and the clamp."""
    lab, body = scene.lab, scene.body
    layers = body.specimen.layers
    keys = [(f"{layer.name}.thickness", max(lab.thickness_error, lab.height_spread)) for layer in layers]
    keys += [(f"{layer.name}.youngs_modulus", lab.modulus_error) for layer in layers if len(layers) > 1]
    for key, error in keys:
        if error:
            changed = scene.with_body(replace(body, setup=(*body.setup, (key, SHARE_STEP))))
            yield _doubt(scene, means, _means(changed), error / SHARE_STEP)
    if body.clamp != "plate":
        told = scene.with_body(replace(body, clamp="plate"))
        yield _doubt(scene, means, _means(told), 1.0)


def _touch(scene: Scene, means: Sequence[Signals]) -> Iterator[Doubt]:
    """Where depth 0 is, in each condition."""
    error = np.hypot(scene.lab.touch_scatter, TOUCH_DEPTH if scene.lab.touch_threshold else 0.0)
    if error:
        for number in range(len(means)):
            whole = _doubt(
                scene, means, lambda plan: scene.mean(plan, (), deeper=DEPTH_STEP), float(error) / DEPTH_STEP
            )
            parts = (part if row == number else part.minus(part) for row, part in enumerate(whole.change))
            yield replace(whole, change=tuple(parts))


def _print(scene: Scene, means: Sequence[Signals]) -> Iterator[Doubt]:
    """Where each marker was printed, along x and along y."""
    if scene.grid is None or not scene.lab.print_scatter:
        return
    for marker in range(scene.grid.rows * scene.grid.columns):
        for axis in (0, 1):
            yield Doubt(tuple(_one_marker(mean, marker, axis) for mean in means), scene.lab.print_scatter / PRINT_STEP)


def _one_marker(mean: Signals, marker: int, axis: int) -> Signals:
    """One marker `PRINT_STEP` farther along an axis, all the time."""
    assert mean.x is not None
    assert mean.y is not None
    x, y = np.zeros_like(mean.x), np.zeros_like(mean.y)
    (x, y)[axis][:, marker] = PRINT_STEP
    return Signals(np.zeros_like(mean.force), x, y)


def _lens(scene: Scene, means: Sequence[Signals]) -> Iterator[Doubt]:
    grid = scene.grid
    if grid is not None and grid.lens:
        other: FaceMarkers = replace(grid, lens=grid.lens + LENS_STEP)
        bent = replace(scene, grid=other)
        yield _doubt(scene, means, _means(bent), LENS_ERROR / LENS_STEP)


def _means(scene: Scene) -> Callable[[PressPlan], Signals]:
    """The mean trials of another scene."""
    return lambda plan: scene.mean(plan, ())


def _doubt(scene: Scene, means: Sequence[Signals], other: Callable[[PressPlan], Signals], error: float) -> Doubt:
    changes = (other(plan).minus(mean) for plan, mean in zip(scene.plans, means, strict=True))
    return Doubt(tuple(changes), error)
