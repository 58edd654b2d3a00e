"""Which parameter matters to which result: keys without effect, and Sobol indices by Saltelli's design and SALib."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.models import Array
from benchmark.sweeps.point import BAND, FAILED, SECONDS, PointResult

CONSTANT = 1e-9
"""Spread of a result, as a part of its largest value, below which it does not depend on anything."""

LEAST_BLOCKS = 4
DEFAULT_BASE, LEAST_BASE = 64, 8
COLUMNS = ("result", "parameter", "first_order", "first_order_ci95", "total_order", "total_order_ci95")


def base_samples(points: int, parameters: int) -> int:
    """The largest base sample, a power of two, whose design has at most `points` points; 0 where none has."""
    most = points // (parameters + 2)
    return 0 if most < 1 else 1 << (most.bit_length() - 1)


def saltelli_design(names: Sequence[str], base: int, seed: int) -> Array:
    """Points of the design.

    Parameters
    ----------
    names
        The d parameters.
    base
        Base samples N, a power of two.
    seed
        Of the scrambling.

    Returns
    -------
    ndarray, shape (N (d + 2), d)
        Shares from 0 to 1, block after block of d + 2 points: A, A with column i from B (i = 1..d), B. Saltelli et al.
        2010, Comput Phys Commun 181:259, without second-order indices.
    """
    from SALib.sample import sobol

    points = sobol.sample(_unit_cube(names), base, calc_second_order=False, scramble=True, seed=seed)
    return np.asarray(points, dtype=np.float64)


def _unit_cube(names: Sequence[str]) -> dict[str, Any]:
    """The parameters as SALib takes them, each from 0 to 1."""
    return {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}


@dataclass(frozen=True)
class SobolIndex:
    """What one parameter does to one result.

    Attributes
    ----------
    result, parameter : str
    first, first_ci95 : float
        First-order index (the part of the variance that the parameter explains alone) and the half-width of its 95 %
        bootstrap interval.
    total, total_ci95 : float
        Total-order index (with all interactions), likewise.
    """

    result: str
    parameter: str
    first: float
    first_ci95: float
    total: float
    total_ci95: float


@dataclass(frozen=True)
class Sensitivity:
    """Indices of every result to every parameter, and what was left out.

    Attributes
    ----------
    indices : tuple of SobolIndex
    base_samples : int
        Blocks of the design.
    warnings : tuple of str
        Results without indices, and blocks left out because of points without a value, with the reason.
    """

    indices: tuple[SobolIndex, ...]
    base_samples: int
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class SweepFindings:
    """What the points of a sweep tell of the keys that vary.

    Attributes
    ----------
    without_effect : tuple of str
        Keys that change no result.
    sensitivity : Sensitivity or None
        Sobol indices where they were asked for.
    """

    without_effect: tuple[str, ...] = ()
    sensitivity: Sensitivity | None = None


def keys_without_effect(
    keys: Sequence[str], points: Sequence[Sequence[str]], rows: Sequence[PointResult]
) -> tuple[str, ...]:
    """Varied keys that change no result: points that differ in one of them alone have the same to the last digit.

    `points` has each point's value of every key. Seconds and bands are no results; of a sample over several keys no two
    points differ in one alone.
    """
    results = {
        points[row.point - 1]: {name: value for name, value in row.values.items() if not name.endswith((SECONDS, BAND))}
        for row in rows
        if row.status != FAILED and row.values
    }
    found = []
    for place, key in enumerate(keys):
        groups: dict[tuple[str, ...], list[Mapping[str, float]]] = {}
        for point, values in results.items():
            groups.setdefault((*point[:place], *point[place + 1 :]), []).append(values)
        compared = [alike for alike in groups.values() if len(alike) > 1]
        if compared and all(each == alike[0] for alike in compared for each in alike):
            found.append(key)
    return tuple(found)


def sobol_indices(parameters: Sequence[str], results: Mapping[str, Array], *, seed: int) -> Sensitivity:
    """Compute the indices from the results at the points of `saltelli_design`.

    Parameters
    ----------
    parameters
        The d parameters of the design.
    results
        Values by name, (N (d + 2),) each, NaN at points without one. A block of the design with such a point is left
        out as a whole.
    seed
        Of the bootstrap.

    Raises
    ------
    ValueError
        A result whose length is no whole number of blocks.
    """
    indices: list[SobolIndex] = []
    warnings: dict[str, list[str]] = {}
    blocks = 0
    for name, values in results.items():
        block = values.reshape(-1, len(parameters) + 2)
        blocks = len(block)
        whole = block[np.isfinite(block).all(axis=1)]
        remark = _remark(whole, blocks)
        if remark:
            warnings.setdefault(remark, []).append(name)
        if _varies(whole):
            indices.extend(_of_one(name, parameters, whole.ravel(), seed))
    said = tuple(f"{', '.join(names)}: {remark}" for remark, names in warnings.items())
    return Sensitivity(tuple(indices), blocks, said)


def _varies(whole: Array) -> bool:
    """Whether there is enough of a result, and it changes."""
    return len(whole) >= LEAST_BLOCKS and float(np.ptp(whole)) > CONSTANT * float(np.abs(whole).max())


def _remark(whole: Array, blocks: int) -> str:
    """What must be said of a result."""
    if not len(whole):
        return "no indices: no block of the design has a value at each of its points"
    if len(whole) < LEAST_BLOCKS:
        return f"no indices: only {len(whole)} of {blocks} blocks of the design have a value at each of their points"
    if not _varies(whole):
        return "no indices: it is the same at every point"
    if len(whole) < blocks:
        return f"{blocks - len(whole)} of {blocks} blocks of the design are left out, points without a value in them"
    return ""


def _of_one(result: str, parameters: Sequence[str], values: Array, seed: int) -> list[SobolIndex]:
    """The indices of one result, (N (d + 2),) without gaps."""
    from SALib.analyze import sobol

    found: Any = sobol.analyze(
        _unit_cube(parameters),
        values,
        calc_second_order=False,
        num_resamples=1000,
        conf_level=0.95,
        seed=seed + 1,  # SALib takes 0 for "no seed"
    )
    columns = (found["S1"], found["S1_conf"], found["ST"], found["ST_conf"])
    return [
        SobolIndex(result, parameter, *(float(column[place]) for column in columns))
        for place, parameter in enumerate(parameters)
    ]


def sweep_sensitivity(parameters: Sequence[str], rows: Sequence[PointResult], *, seed: int) -> Sensitivity:
    """Indices of every result but the compute times, from all points of a saltelli design in their order."""
    names = dict.fromkeys(name for row in rows for name in row.values if not name.endswith(SECONDS))
    results = {name: np.array([row.values.get(name, np.nan) for row in rows]) for name in names}
    return sobol_indices(parameters, results, seed=seed)


def sensitivity_columns(found: Sensitivity) -> dict[str, list[Any]]:
    """Columns of `sensitivity.csv`; the intervals as half-widths at 95 %."""
    lines = [
        (index.result, index.parameter, index.first, index.first_ci95, index.total, index.total_ci95)
        for index in found.indices
    ]
    return {name: [line[place] for line in lines] for place, name in enumerate(COLUMNS)}
