"""Which points a sweep computes: a grid, a Latin hypercube, a Sobol sequence, or Saltelli's design for sensitivity."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from benchmark.errors import InputError
from benchmark.sweeps.parameter import Parameter
from benchmark.sweeps.sensitivity import DEFAULT_BASE, LEAST_BASE, base_samples, saltelli_design
from reports.formatting import counted

Kind = Literal["grid", "lhs", "sobol", "saltelli"]
Shares = NDArray[np.float64]
Point = tuple[str, ...]

MOST_POINTS = 100_000


@dataclass(frozen=True)
class Design:
    """How points are chosen.

    Attributes
    ----------
    kind : str
        grid | lhs | sobol | saltelli.
    points : int or None
        How many were asked for; at most so many for saltelli; None for a grid.
    seed : int
        Of a sample.
    """

    kind: Kind
    points: int | None
    seed: int

    def choose(self, parameters: Sequence[Parameter]) -> tuple[Point, ...]:
        """The points: for each, the value of every parameter as `--set` takes it.

        Raises
        ------
        InputError
            A range without a count on a grid, or more points than a sweep can have.
        """
        if self.kind == "grid":
            values = [parameter.grid() for parameter in parameters]
            _check_number(math.prod(len(each) for each in values))
            return tuple(itertools.product(*values))
        shares = self._shares([parameter.key for parameter in parameters])
        return tuple(
            tuple(parameter.text_at(float(share)) for parameter, share in zip(parameters, row, strict=True))
            for row in shares
        )

    def _shares(self, keys: Sequence[str]) -> Shares:
        """Points of the unit cube, (n, d)."""
        from scipy.stats import qmc

        count, size = self.points or 0, len(keys)
        _check_number(count)
        generator = np.random.default_rng(self.seed)
        if self.kind == "lhs":
            return np.asarray(qmc.LatinHypercube(size, rng=generator).random(count))
        if self.kind == "sobol":
            power = max(count - 1, 0).bit_length()
            return np.asarray(qmc.Sobol(size, rng=generator).random_base2(power)[:count])
        return saltelli_design(keys, base_samples(count, size), self.seed)


def chosen_design(sample: str | None, points: int | None, sensitivity: bool, parameters: int, seed: int) -> Design:
    """The design that the options ask for.

    Parameters
    ----------
    sample
        "lhs", "sobol" or None for a grid.
    points
        Points of a sample; with `sensitivity` at most so many.
    sensitivity
        Whether Sobol indices are wanted, which need a design of their own.
    parameters
        How many keys vary.
    seed
        Of a sample.

    Raises
    ------
    InputError
        Options that do not go together, or too few points.
    """
    if sensitivity:
        return _saltelli(sample, points, parameters, seed)
    if sample is None:
        if points is not None:
            raise InputError("--points is the size of a sample: give --sample lhs, --sample sobol or --sensitivity")
        return Design("grid", None, seed)
    if points is None:
        raise InputError(f"--sample {sample} needs the number of points, as in --points 64")
    return Design("lhs" if sample == "lhs" else "sobol", points, seed)


def _saltelli(sample: str | None, points: int | None, parameters: int, seed: int) -> Design:
    block = parameters + 2
    if sample == "lhs":
        raise InputError("--sensitivity needs a Sobol design of its own: leave --sample lhs out")
    if points is not None and base_samples(points, parameters) < LEAST_BASE:
        raise InputError(
            f"--points {points} is too few for --sensitivity with {counted(parameters, 'parameter')}; "
            f"allowed: at least {LEAST_BASE * block}"
        )
    return Design("saltelli", DEFAULT_BASE * block if points is None else points, seed)


def _check_number(points: int) -> None:
    if not 1 <= points <= MOST_POINTS:
        raise InputError(f"the sweep would have {points} points; allowed: 1 to {MOST_POINTS}")
