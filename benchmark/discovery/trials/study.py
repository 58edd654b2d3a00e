"""A session made ready: trials of a condition aligned row by row, with phases, cycles and marker layout. SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.marker_layout import Layout
from benchmark.files import Setup, Support, Tissue, Tool
from benchmark.physics import DepthRecord, TrialContext


@dataclass(frozen=True, eq=False)
class ConditionData:
    """The trials of one condition: R trials of n rows each, the rows of all trials at the same stage.

    Attributes
    ----------
    name : str
    specimen, tool, support
        Of the condition.
    trials : tuple of str
    numbers : (R,) int
        Place of each trial in the session.
    time, depth, acceleration : (R, n)
        s, m, m/s2.
    records : tuple of DepthRecord
        What the depths of each trial are means of, on its clock.
    signals : (R, n, C)
        Force in N, then marker combinations in m; NaN where nothing was measured.
    count : (R, n, C)
        Samples in each row and signal: raw rows, frames.
    frame_time : (R, n)
        Mean time of the frames in each row, s.
    phase, cycle, part : (n,)
        Index in PHASES, number of the press, and a half (0 or 1) of a phase.
    around : TrialContext
    specimens : (R,) int
        Trials of the same number are of one specimen, as far as its height tells.
    """

    name: str
    specimen: Tissue
    tool: Tool
    support: Support
    trials: tuple[str, ...]
    numbers: NDArray[np.int64]
    time: Array
    depth: Array
    acceleration: Array
    records: tuple[DepthRecord, ...]
    signals: Array
    count: Array
    frame_time: Array
    phase: NDArray[np.int64]
    cycle: NDArray[np.int64]
    part: NDArray[np.int64]
    around: TrialContext
    specimens: NDArray[np.int64]

    @property
    def setup(self) -> Setup:
        """What was pressed, with what, and on what."""
        return self.specimen, self.tool, self.support

    @property
    def size(self) -> int:
        """Number of trials."""
        return len(self.trials)


@dataclass(frozen=True, eq=False)
class Study:
    """All conditions of a session.

    Attributes
    ----------
    conditions : tuple of ConditionData
    layout : Layout or None
        None without markers.
    distance : float or None
        From camera to lower face, m.
    raw_interval : float
        Median time between raw rows, s.
    depth_step : float
        The smallest change that the depths show, m: their rounding or their scatter.
    warnings : tuple of str
    by_force : bool
        Whether the force was prescribed, and the depth is the answer.
    """

    conditions: tuple[ConditionData, ...]
    layout: Layout | None
    distance: float | None
    raw_interval: float
    depth_step: float
    warnings: tuple[str, ...]
    by_force: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Signals: force_z, then the marker combinations."""
        return ("force_z", *(self.layout.names if self.layout else ()))

    @property
    def channels(self) -> tuple[str, ...]:
        """The channel of each signal."""
        return ("force_z", *(self.layout.channels if self.layout else ()))

    @property
    def trial_count(self) -> int:
        """Trials in all."""
        return sum(condition.size for condition in self.conditions)
