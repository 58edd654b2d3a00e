"""What a finite-element code printed over time, as rows of a reference table; and numbers out of its lines."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from bench_hw.storage.regular_file import TABLE, read_regular
from benchmark.errors import InputError
from benchmark.models.model_result import Array
from benchmark.models.reference_table import ReferenceRows

SAME_PLACE = 1e-4
"""Places are one where they differ by less than this share of the specimen's thickness: files have 6 digits."""


@dataclass
class SolverHistory:
    """Deflections on the axis by instant, filled while a file is read.

    Attributes
    ----------
    path : Path
    layers : tuple of str
    deflection : dict of (time in s, layer number) to m
        Press positive.
    force : dict of time in s to N
    profile : dict of (layer number, radius in m) to m
        At peak load.
    line : dict of (time, layer number) to the line of the file
    """

    path: Path
    layers: tuple[str, ...]
    deflection: dict[tuple[float, int], float] = field(default_factory=dict)
    force: dict[float, float] = field(default_factory=dict)
    profile: dict[tuple[int, float], float] = field(default_factory=dict)
    line: dict[tuple[float, int], int] = field(default_factory=dict)

    def add(self, time: float, layer: int, value: float, line: int) -> None:
        """A layer's deflection at an instant; of an instant that is printed twice the last one stands."""
        self.deflection[time, layer], self.line[time, layer] = value, line

    def rows(self) -> ReferenceRows:
        """The rows of a reference table; raises InputError where a layer is missing or its instants differ."""
        times = [sorted(time for time, layer in self.deflection if layer == k) for k in range(len(self.layers))]
        for name, own in zip(self.layers, times, strict=True):
            if not own:
                raise InputError(
                    f"{self.path}: no displacement of the layer {name} on the axis; needed is what an exported file "
                    "prints (--export), or nodes on the axis at each layer's top face"
                )
        keys = [(time, k) for k, own in enumerate(times) for time in own if time > 0.0]
        edge = [(1e3 * radius, k) for k, radius in sorted(self.profile)]
        columns = {
            "time_s": np.array([time for time, _ in keys] + [np.nan] * len(edge)),
            "fem_mm": 1e3
            * np.array([self.deflection[key] for key in keys] + [self.profile[k] for k in sorted(self.profile)]),
            "radius_mm": np.array([0.0] * len(keys) + [radius for radius, _ in edge]),
        }
        if self.force and all(time in self.force for time, _ in keys) and not edge:
            columns["force_N"] = np.array([self.force[time] for time, _ in keys])
        layer = tuple(self.layers[k] for _, k in (*keys, *edge))
        return ReferenceRows(self.path, columns, layer, np.array([self.line.get(key, 1) for key in (*keys, *edge)]))


def text_of(path: Path) -> list[str]:
    """The lines of a file; raises InputError where it is empty or no text."""
    data = read_regular(path, TABLE)
    if b"\0" in data[:4096] or not data.strip():
        raise InputError(
            f"{path}: {'it is empty' if not data.strip() else 'it is no text'}; needed is what a solver prints"
        )
    return data.decode("utf-8", errors="replace").splitlines()


def number(path: Path, line: int, text: str) -> float:
    """A finite number of a line (counted from 0); raises InputError."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{path}, line {line + 1}: {text.strip()[:40]!r} is no number; the file is damaged or cut off")
    return value


def layer_number(path: Path, line: int, text: str, layers: tuple[str, ...]) -> int:
    """The number from 0 of a layer that a set's name tells, from 1; raises InputError."""
    if not text.isdigit() or not 1 <= int(text[:6]) <= len(layers):
        raise InputError(
            f"{path}, line {line + 1}: AXIS_{text[:20]} is none of the scenario's {len(layers)} layers: "
            f"{', '.join(layers)}"
        )
    return int(text) - 1


def layer_at(depth: Array, thickness: Mapping[str, float]) -> Array:
    """(n,) number of the layer whose top face is at a depth (n,) m below the surface; -1 where none is."""
    tops = np.concatenate([[0.0], np.cumsum(list(thickness.values()))[:-1]])
    size = float(np.sum(np.where(np.isfinite(list(thickness.values())), list(thickness.values()), 0.0)))
    near = np.abs(np.asarray(depth)[:, None] - tops[None, :])
    return np.where(near.min(axis=1) <= SAME_PLACE * max(size, 1e-9), near.argmin(axis=1), -1)
