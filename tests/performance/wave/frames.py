"""Rows of the table: each way to a frame, its time, and its error against the finite elements on the same vertices."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from tests.performance.wave import rivals
from tests.performance.wave.job import FORCE, RADIUS, Reference, errors, vertices, wave_layers
from tests.performance.wave.timing import Times, microseconds
from wavemodel import DiscTool, LayeredWave, Prony, WaveDiscretisation
from wavemodel.control import Grid, InteractiveTissue, layered_body
from wavemodel.control.contact_relaxation import ContactRelaxation

COUNTS, MODES, WINDOW = (25, 100, 512), (8, 16, 32), 60e-3
DISC, DISC_MODES = 90e-3, 24
"""Diameter that holds the corners of the vertices, m, and modes of the round window."""
Make = Callable[[], Callable[[float], np.ndarray]]
SERIES, DT = Prony((0.3,), (0.5,)), 1e-3


@dataclass(frozen=True)
class Row:
    """One way at one number of vertices; errors in % of each layer's peak."""

    vertices: int
    way: str
    times: Times
    error: tuple[float, ...]
    setup: float


def rows(exact: Reference) -> Iterator[Row]:
    """All ways at all sizes."""
    for count in COUNTS:
        x = vertices(count)
        truth = FORCE * exact.at(np.hypot(x[:, None], x))
        for way, make in _ways(count, x, exact):
            yield _row(count, way, make, truth)
        yield _mass_spring(count, x, exact, truth)


def _ways(count: int, x: np.ndarray, exact: Reference) -> Iterator[tuple[str, Make]]:
    for modes in MODES:
        yield f"layered wave, {modes} modes, viscoelastic", partial(_wave, x, modes)
    yield f"layered wave, disc of {DISC_MODES} modes, viscoelastic", partial(_wave, x, DISC_MODES, "disc", DISC)
    yield "the same under an interactive tool", partial(_interactive, count)
    for whole, name in ((True, "dense FEM compliance"), (False, "dense FEM compliance, tool in its place")):
        if rivals.fits_in_memory(count, whole):
            yield name, partial(rivals.dense_compliance, x, whole)
    yield "Kelvinlet, fitted to the peak", partial(rivals.kelvinlet, x, exact)


def _row(count: int, way: str, make: Make, truth: np.ndarray) -> Row:
    start = time.perf_counter()
    frame = make()
    setup = time.perf_counter() - start
    times = microseconds(frame)
    found = np.array(frame(FORCE))
    if found.shape[1:] != truth.shape[1:]:
        raise ArithmeticError(f"{way}: {found.shape} vertices instead of {truth.shape}")
    return Row(count, way, times, tuple(errors(found, truth[: len(found)]).tolist()), setup)


def _wave(
    x: np.ndarray, modes: int, domain: str = "rectangle", window: float = WINDOW
) -> Callable[[float], np.ndarray]:
    """A frame: one step of the relaxation, the amplitudes, the synthesis of three layers."""
    wave = LayeredWave(
        wave_layers(),
        DiscTool(RADIUS),
        discretisation=WaveDiscretisation(window=window, modes=modes, domain=domain),
        large_press="linear",
    )
    surface, relaxation = wave.surface(x, x), ContactRelaxation(1, SERIES, 0.0)

    def frame(elastic: float) -> np.ndarray:
        relaxation.held(0, elastic, DT)
        return surface.frame(wave.static_state(elastic))

    return frame


def _interactive(count: int) -> Callable[[float], np.ndarray]:
    """A frame of a tissue as wide as the vertices, tool in the middle, depth in, force out."""
    x = vertices(count)
    side = float(x[-1] - x[0])
    wave = LayeredWave(
        wave_layers(),
        DiscTool(RADIUS),
        discretisation=WaveDiscretisation(window=WINDOW, modes=32),
        large_press="linear",
    )
    grid = Grid(side, side, side / (count - 1))
    tissue = InteractiveTissue(layered_body(wave, grid), grid, series=SERIES)

    def frame(elastic: float) -> np.ndarray:
        tissue.touch(0, 0.5 * side, 0.5 * side, elastic * wave.law.compliance)
        return tissue.frame(DT)

    return frame


def _mass_spring(count: int, x: np.ndarray, exact: Reference, truth: np.ndarray) -> Row:
    start = time.perf_counter()
    grid = rivals.MassSpring(x, exact)
    setup = time.perf_counter() - start
    times = microseconds(grid.frame)
    error = tuple(errors(grid.at_rest(FORCE), truth[:1]).tolist())
    return Row(count, "mass-spring grid, one step, fitted to the peak", times, error, setup)
