"""How good a recording is: its channels' figures, and everything that went wrong in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bench_hw.devices.netft_status import describe
from bench_hw.devices.netft_wire import Status
from bench_hw.trial_file.channel_report import ChannelReport, report_channel
from bench_hw.trial_file.contents import TrialContents, read_contents
from bench_hw.trial_file.trial_table import trial_rows

SCHEMA = 1
DRIFT_WINDOW = 0.5
"""Time at the start and at the end of a trial over which the force is compared, s."""
DRIFT_ROWS = 10
"""Fewest rows at either end from which a drift is told."""
SAME_DEPTH = 0.2e-3
"""Depths at start and end that are this close (m) count as the same: the actuator's own accuracy."""


@dataclass(frozen=True, eq=False)
class Inspection:
    """The verdict on a trial file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    complete : bool
        Whether the file was closed well, nothing in it is damaged, and nothing was lost in a recovery before.
    channels : Mapping[str, ChannelReport]
        By name: `force`, `depth`, `camera`; those that have rows.
    faults : tuple of str
        One sentence each: damaged bytes, faults the capture noted, samples that are no measurements.
    trial : Mapping[str, Any]
        Name, start, protocol, serial numbers... empty where the metadata are lost.
    events : tuple of dict
        What the capture noted: `time_s`, `kind`, `level`, `message`.
    """

    path: Path
    complete: bool
    channels: Mapping[str, ChannelReport]
    faults: tuple[str, ...]
    trial: Mapping[str, Any]
    events: tuple[Mapping[str, Any], ...]

    def to_dict(self) -> dict[str, Any]:
        """Give the verdict as it stands in the JSON of `inspect`."""
        return {
            "schema": SCHEMA,
            "complete": self.complete,
            "channels": {name: report.to_dict() for name, report in self.channels.items()},
            "faults": list(self.faults),
            "trial": dict(self.trial),
            "events": [dict(event) for event in self.events],
        }


def inspect_trial(path: Path | str) -> Inspection:
    """Judge a trial file, also one that is cut or damaged.

    Raises
    ------
    TrialFileError
        The file cannot be read, or nothing in it is a trial.
    """
    contents = read_contents(Path(path))
    reports = {"force": _force(contents), "depth": _depth(contents), "camera": _camera(contents)}
    return Inspection(
        path=Path(path),
        complete=contents.scan.complete,
        channels={name: report for name, report in reports.items() if report.rows},
        faults=tuple(_faults(contents)),
        trial=_trial(contents),
        events=tuple(
            {"time_s": event.time, "kind": event.kind, "level": event.level, "message": event.message}
            for event in contents.events
        ),
    )


def _force(contents: TrialContents) -> ChannelReport:
    force = contents.force
    details = {
        "saturated": int(np.count_nonzero(force.status & Status.SATURATED)),
        "drift_N": force_drift(contents),
    }
    return report_channel(force.time, force.rdt_sequence, samples=force.ft_sequence, details=details)


def _depth(contents: TrialContents) -> ChannelReport:
    return report_channel(contents.depth.time, contents.depth.sequence)


def _camera(contents: TrialContents) -> ChannelReport:
    return report_channel(contents.camera.time, contents.camera.frame, camera=True)


def force_drift(contents: TrialContents) -> float | None:
    """Give how much the unloaded force moved during a trial, N along the press axis.

    The median over the end less that over the beginning: at most half a second of each, as long as the
    actuator stays within 0.2 mm of where it began. None where it did not come back there, or where there is
    too little to say.
    """
    if contents.header is None:
        return None
    table = trial_rows(contents)
    if not len(table.time) or table.time[-1] - table.time[0] < 2 * DRIFT_WINDOW:
        return None
    away = np.flatnonzero(np.abs(table.depth - table.depth[0]) > SAME_DEPTH)
    rows = np.arange(len(table.time))
    first = (table.time <= table.time[0] + DRIFT_WINDOW) & (rows < min(away, default=len(rows)))
    last = (table.time >= table.time[-1] - DRIFT_WINDOW) & (rows > max(away, default=-1))
    if min(first.sum(), last.sum()) < DRIFT_ROWS:
        return None
    return float(np.median(table.force[last]) - np.median(table.force[first]))


def _faults(contents: TrialContents) -> Iterator[str]:
    scan = contents.scan
    yield from map(str, scan.damages)
    if scan.recovery is not None:
        yield f"this file was recovered from one that had lost something: {scan.recovery.get('reason', '')}"
    if contents.header is None:
        yield "no copy of the trial's metadata is whole"
    yield from scan.losses()
    for event in contents.events:
        if event.level == "fault":
            yield f"{event.kind} at {event.time:.3f} s: {event.message}"
    yield from _sensor_faults(contents)


def _sensor_faults(contents: TrialContents) -> Iterator[str]:
    force = contents.force
    bad = force.status & ~Status.LATCH_ONLY
    for status in np.unique(bad[bad != 0]).tolist():
        rows = np.flatnonzero(bad == status)
        first = force.time[rows[0]]
        yield f"force sensor: {describe(status)} in {len(rows)} rows, first at {first:.3f} s"


def _trial(contents: TrialContents) -> dict[str, Any]:
    header = contents.header
    if header is None:
        return {}
    return {
        "name": header.name,
        "started": header.started,
        "protocol": header.protocol,
        "press_axis": header.press_axis,
        "synthetic": header.synthetic,
        "serials": dict(header.serials),
        "calibrations": dict(header.calibrations),
        "settings": dict(header.settings),
    }
