"""A trial file as the table the rest of the product reads: press force over depth and time.

The rows are the force sensor's own samples at their own time stamps; nothing is resampled and no force is
made up. Depth, which the actuator reports more slowly, is interpolated linearly between the two positions
around each force sample, and only where they are neighbours: over a gap in the positions, before the first
and after the last there is no row. Rows that are late, doubled, saturated or faulty are left out; what is left
out is a gap in the table.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices.netft_wire import Status
from bench_hw.errors import TrialFileError
from bench_hw.tables.model import MINIMUM_ROWS, TrialTable
from bench_hw.trial_file.contents import DepthColumns, ForceColumns, TrialContents, read_contents
from bench_hw.trial_file.intervals import longest_allowed
from bench_hw.trial_file.records import PressAxis
from bench_hw.trial_file.schemas import DEPTH, FORCE
from bench_hw.trial_file.sequence import check_sequence

FloatArray = NDArray[np.float64]


def read_trial_mcap(path: Path | str) -> TrialTable:
    """Read a native trial file.

    Parameters
    ----------
    path : path-like
        A trial that was closed well, or the result of `recover`.

    Returns
    -------
    TrialTable
        One row per usable force sample: `time` s since the trial's start, `depth` m, `force` N along the file's
        press axis, positive when pressing; the six raw components as extras `force_x` (N) to `torque_z` (N m),
        in the sensor's axes.

    Raises
    ------
    TrialFileError
        The file cannot be read, is damaged or cut, lacks its metadata, or has fewer than 20 usable rows.
    """
    contents = read_contents(Path(path), (FORCE.topic, DEPTH.topic))
    if not contents.scan.whole:
        problem = f"the trial is damaged or cut ({contents.scan.damages[0]}); use `recover` and read its result"
        raise TrialFileError(contents.scan.path, problem)
    table = trial_rows(contents)
    if len(table.time) < MINIMUM_ROWS:
        problem = f"the trial has {len(table.time)} rows with force and depth; allowed: at least {MINIMUM_ROWS}"
        raise TrialFileError(contents.scan.path, problem)
    return table


def trial_rows(contents: TrialContents, press_axis: PressAxis | None = None) -> TrialTable:
    """Join force and depth of a trial; as `read_trial_mcap`, for any number of rows of any file.

    Parameters
    ----------
    contents : TrialContents
        What the file holds.
    press_axis : str, optional
        Instead of the file's own.

    Raises
    ------
    TrialFileError
        No press axis given and the file's own is lost.
    """
    axis = press_axis or (contents.header.press_axis if contents.header else None)
    if axis is None:
        problem = "no copy of the metadata is whole, so the press axis is not known; give it"
        raise TrialFileError(contents.scan.path, problem)
    force = contents.force
    rows = np.flatnonzero(usable_rows(force))
    depth, between = _depth_at(contents.depth, force.time[rows])
    rows, depth = rows[between], depth[between]
    names = [f"{kind}_{axis_name}" for kind in ("force", "torque") for axis_name in "xyz"]
    components = np.hstack([force.force, force.torque])[rows].T
    return TrialTable(
        time=force.time[rows],
        depth=depth,
        force=press_force(force, axis)[rows],
        extra=dict(zip(names, components, strict=True)),
        source=str(contents.scan.path),
        extra_units={name: "N" if name.startswith("force") else "Nm" for name in names},
    )


def press_force(force: ForceColumns, axis: PressAxis) -> FloatArray:
    """Give the force along a press axis, N, positive when pressing, shape (n,)."""
    component = force.force[:, "xyz".index(axis[1])]
    return component if axis[0] == "+" else -component


def usable_rows(force: ForceColumns) -> NDArray[np.bool_]:
    """Say which samples are measurements: in order, healthy, finite, later than every one before; shape (n,)."""
    finite = np.isfinite(force.force).all(axis=1) & np.isfinite(force.torque).all(axis=1)
    healthy = (force.status & ~Status.LATCH_ONLY) == 0
    usable = check_sequence(force.rdt_sequence, force.ft_sequence).in_order & finite & healthy
    return _and_later(usable, force.time)


def _and_later(good: NDArray[np.bool_], time: FloatArray) -> NDArray[np.bool_]:
    """Keep of the good rows those that are later than every good row before."""
    kept = good.copy()
    kept[good] = time[good] > np.concatenate([[-np.inf], np.maximum.accumulate(time[good])])[:-1]
    return kept


def _depth_at(depth: DepthColumns, time: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Interpolate depth; the second array says where there are neighbours to do so between."""
    good = _and_later(np.isfinite(depth.depth), depth.time)
    at, value = depth.time[good], depth.depth[good]
    if len(at) < 2:
        return np.full(len(time), np.nan), np.zeros(len(time), dtype=bool)
    after = np.clip(np.searchsorted(at, time, side="left"), 1, len(at) - 1)
    inside = (time >= at[after - 1]) & (time <= at[after])
    neighbours = at[after] - at[after - 1] <= longest_allowed(at)
    measured = (time == at[after - 1]) | (time == at[after])
    return np.interp(time, at, value), inside & (neighbours | measured)
