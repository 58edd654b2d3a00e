"""A trial session: measured presses of one specimen, each with the tool and the support that it was made with."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from bench_hw.errors import BenchError
from bench_hw.tables import MarkerTable, TrialTable, calm, read_marker_csv, read_trial_csv
from benchmark.errors import InputError
from benchmark.files.load import Load
from benchmark.files.loading import scenario_from_table
from benchmark.files.scenario import Scenario
from benchmark.files.sessions.description import Camera, TrialEntry
from benchmark.files.sessions.fit_table import FitTable
from benchmark.files.sessions.session_folder import inside
from benchmark.files.sources import Source
from benchmark.files.tissue import Tissue
from benchmark.files.tool import Support, Tool, setup_uncertainties


@dataclass(frozen=True, eq=False)
class Trial:
    """One press.

    Attributes
    ----------
    name : str
        Unique in the session: the file's path in the folder, without its ending.
    condition : str
        What it shares with others.
    path : Path
        Its file.
    tool, support
        What it was made with, its condition's overrides included.
    table : TrialTable
        time (n,) s, depth (n,) m, force (n,) N and further columns.
    markers : MarkerTable or None
        Marker tracks.
    markers_path : Path or None
        Their file.
    film : Path or None
        A video of them, to be tracked.
    """

    name: str
    condition: str
    path: Path
    tool: Tool
    support: Support
    table: TrialTable
    markers: MarkerTable | None = None
    markers_path: Path | None = None
    film: Path | None = None


def trial_paths(
    entries: Sequence[TrialEntry], source: Source
) -> tuple[list[Path], list[Path | None], list[Path | None]]:
    """The files of the trials, of their markers and films, all inside the session's folder; raises InputError."""
    files, markers, films = [], [], []
    for index, entry in enumerate(entries):
        place = source.place(("trials", index, "file"), f"trials[#{index + 1}].file")
        files.append(inside(source.folder, entry.file, place))
        place = source.place(("trials", index, "markers"), f"trials[#{index + 1}].markers")
        markers.append(None if entry.markers is None else inside(source.folder, entry.markers, place))
        place = source.place(("trials", index, "film"), f"trials[#{index + 1}].film")
        films.append(None if entry.film is None else inside(source.folder, entry.film, place))
        if entry.film is not None and entry.markers is not None:
            raise InputError(f"{place}: this trial has marker tracks, too; allowed: markers or film.")
    return files, markers, films


def trial_names(paths: Sequence[Path], folder: Path) -> list[str]:
    """A name for each trial: its path in the folder without the ending, with it and a number where two are alike."""
    names = [path.relative_to(folder).with_suffix("").as_posix() for path in paths]
    times = Counter(names)
    names = [
        name if times[name] == 1 else path.relative_to(folder).as_posix()
        for name, path in zip(names, paths, strict=True)
    ]
    times = Counter(names)
    return [name if times[name] == 1 else f"{name} #{number}" for number, name in enumerate(names, start=1)]


def read_table(path: Path) -> TrialTable:
    """The table of a trial file, CSV or native; raises InputError."""
    try:
        if path.suffix.lower() == ".mcap":
            from bench_hw.trial_file import read_trial_mcap

            return read_trial_mcap(path)
        return read_trial_csv(path)
    except BenchError as error:
        raise InputError(f"{error}.") from None


STANDS: Final = 0.1
"""Share of the travel over which a force that does not change by one digit is no tissue's."""
TURNED: Final = 0.2
"""Of the way down that a press with its signs turned goes up at most."""
LEVELS: Final = 20
"""Values of the upper half of a force, below which its digits are too coarse to tell that it stands."""


def doubtful_forces(names: Sequence[str], tables: Sequence[TrialTable]) -> list[str]:
    """A warning for each trial whose force no tissue makes: a glitch of single rows, a sensor's end, signs turned."""
    said = []
    for name, table in zip(names, tables, strict=True):
        if _upside_down(table):
            force, depth = float(table.force.min()), float(table.depth.min())
            said.append(
                f"{name}: force and depth only fall, to {force:.4g} N and {1e3 * depth:.4g} mm, as where pressing is "
                "negative; allowed: press positive. It is used as it is; turn both columns of its file"
            )
            continue
        lone = np.flatnonzero(calm(table.force) != table.force)
        if len(lone):
            row = int(lone[0])
            said.append(
                f"{name}: the force is {table.force[row]:g} N at {table.time[row]:.6g} s, in a single row far beyond "
                f"all others (such rows: {len(lone)}): a glitch, which the fit takes for the press; take the row out"
            )
        elif (way := _standing(table)) > 0.0:
            said.append(
                f"{name}: the force stands at {table.force.max():g} N, its largest value, while the depth goes on over "
                f"{1e3 * way:.3g} mm: at the end of the sensor's range? What is fitted is then too soft"
            )
    return said


SLOW_ROWS, SLOW_PRESS = 1.0, 5e-6
"""Seconds between rows, and m/s, beyond which times may be in ms: a press of 5 mm/s, or slower, sampled at 1 kHz."""


def doubtful_times(names: Sequence[str], tables: Sequence[TrialTable]) -> list[str]:
    """A warning of trials so slow, with so few rows a second, that their times may be milliseconds."""
    found = []
    for name, table in zip(names, tables, strict=True):
        step, lasts = float(np.median(np.diff(table.time))), float(np.ptp(table.time))
        deepest = int(table.depth.argmax())
        way = float(table.depth[deepest] - table.depth[: deepest + 1].min())
        if step >= SLOW_ROWS and way < SLOW_PRESS * (table.time[deepest] - table.time[0]):
            found.append(f"{name} ({step:.3g} s from row to row, {lasts:.4g} s in all)")
    if not found:
        return []
    more = f" and {len(found) - 3} more" if len(found) > 3 else ""
    return [f"times may be milliseconds where seconds are read: {', '.join(found[:3])}{more}"]


def _upside_down(table: TrialTable) -> bool:
    """Whether force and depth leave where they began downwards, and not a fifth as far upwards."""
    few = max(5, len(table.force) // 50)
    moved = [values - float(np.median(values[:few])) for values in (table.force, table.depth)]
    return all(float(each.max()) < TURNED * -float(each.min()) for each in moved)


def _standing(table: TrialTable) -> float:
    """The longest way (m) over which the force stays at its largest value to the last digit; 0 where it is no more."""
    peak = float(table.force.max())
    if len(np.unique(table.force[table.force > 0.5 * peak])) < LEVELS:
        return 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], table.force == peak, [False]]).astype(int)))
    spans = zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    way = max(float(np.ptp(table.depth[first:last])) for first, last in spans)
    return way if way > STANDS * float(np.ptp(table.depth)) else 0.0


def is_synthetic(path: Path) -> bool:
    """Whether a native trial file says that simulated devices made it; a CSV file cannot say."""
    if path.suffix.lower() != ".mcap":
        return False
    from bench_hw.trial_file.reading import read_contents

    header = read_contents(path, ()).header
    return header is not None and header.synthetic


def read_markers(path: Path) -> MarkerTable:
    """The marker tracks of a trial; raises InputError."""
    try:
        return read_marker_csv(path)
    except BenchError as error:
        raise InputError(f"{error}.") from None


@dataclass(frozen=True, eq=False)
class Session:
    """Measured trials of one specimen.

    Attributes
    ----------
    name : str
        Any printable text; escape it where it is shown.
    folder : Path
        Where the files are.
    specimen : Tissue
        What was pressed.
    specimen_assumed : bool
        Whether nobody said so, so that it is one assumed layer whose modulus only a fit can give.
    tool, support
        What the trials were made with, where their condition does not say otherwise.
    drive : str
        The channel that the rig prescribed: "depth" or "force".
    camera : Camera or None
        Marker grid and camera; None where there are no markers.
    synthetic : bool
        Whether trials were computed, or captured from simulated devices, which every result has to say.
    trials : tuple of Trial
        In the order of the session file, or of the file names.
    warnings : tuple of str
        What was assumed, one sentence each.
    settings : mapping of str to str
        What the command line sets in the scenarios made of this session (`fem.mesh`...).
    fingerprint : str
        SHA-256 over all files of the session, in hex.
    fit : FitTable
        What its `[fit]` table says of a fit of parameters.
    shown : tuple of str
        How files of other instruments were read, for the first lines of a run.
    """

    name: str
    folder: Path
    specimen: Tissue
    specimen_assumed: bool
    tool: Tool
    support: Support
    drive: str
    camera: Camera | None
    synthetic: bool
    trials: tuple[Trial, ...]
    warnings: tuple[str, ...]
    settings: Mapping[str, str]
    fingerprint: str
    fit: FitTable = field(default_factory=FitTable)
    shown: tuple[str, ...] = ()

    @property
    def conditions(self) -> tuple[str, ...]:
        """The conditions in the order in which they first occur."""
        return tuple(dict.fromkeys(trial.condition for trial in self.trials))

    def uncertainties(self, tool: Tool, support: Support) -> dict[str, float]:
        """Standard uncertainties that are stated of a set-up, as shares of the values, by keys as in `--set`."""
        return setup_uncertainties(self.specimen, tool, support)

    def scenario(self, tissue: Tissue, tool: Tool, support: Support, load: Load) -> Scenario:
        """A press as a scenario, named like the session, with the session's `settings` in it.

        Raises
        ------
        InputError
            When the parts do not fit each other, or a setting is not allowed.
        """
        parts = {"tissue": tissue, "tool": tool.to_table(), "support": support.to_table(), "load": load.to_table()}
        return scenario_from_table({"name": self.name, **parts}, Source(f"session {self.folder}"), self.settings)
