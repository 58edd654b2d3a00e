"""A trial session: measured presses of one tissue, each with the tool and the support that it was made with."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeAlias

from bench_hw.errors import BenchError, TableError
from bench_hw.tables import MarkerTable, TrialTable, read_marker_csv, read_trial_csv
from benchmark.errors import InputError
from benchmark.files.load import Load
from benchmark.files.loading import scenario_from_table
from benchmark.files.scenario import Scenario
from benchmark.files.sessions.description import Camera, TrialEntry
from benchmark.files.sessions.fit_table import FitTable
from benchmark.files.sessions.session_folder import inside
from benchmark.files.sources import Source
from benchmark.files.tissue import Tissue, stretched_tissue
from benchmark.files.tool import Support, Tool, setup_uncertainties

Setup: TypeAlias = tuple[Tissue, Tool, Support]
"""What was pressed, with what, and on what."""


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
    height : float or None
        Of the specimen that it pressed, m; None where that is the session's.
    earlier : TrialTable or None
        Of a press that is cut from a longer record, the record before it.
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
    height: float | None = None
    earlier: TrialTable | None = None


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


LOOSER = (
    'Units in cells or in a row of their own, clocks and footers are read by --set import.force="force_N:N"; rows that '
    "lack a number are left out by --set import.drop_empty=true."
)
"""How a table with the bench's own names that is not written as the bench writes it may be read all the same."""


def read_table(path: Path) -> TrialTable:
    """The table of a trial file, CSV or native; raises InputError."""
    try:
        if path.suffix.lower() == ".mcap":
            from bench_hw.trial_file import read_trial_mcap

            return read_trial_mcap(path)
        return read_trial_csv(path)
    except TableError as error:
        hint = f" {LOOSER}" if error.problem.startswith(("the cell is", "the row")) else ""
        raise InputError(f"{error}.{hint}") from None
    except BenchError as error:
        raise InputError(f"{error}.") from None


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
    """Measured trials of one tissue, of one specimen or of several that differ in height.

    Attributes
    ----------
    name : str
        Any printable text; escape it where it is shown.
    folder : Path
        Where the files are.
    specimen : Tissue
        What was pressed; of several heights the one in the middle.
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
    assumed_edges : frozenset of float
        Edge radii of tools, m, that no one gave.
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
    assumed_edges: frozenset[float] = frozenset()

    @property
    def conditions(self) -> tuple[str, ...]:
        """The conditions in the order in which they first occur."""
        return tuple(dict.fromkeys(trial.condition for trial in self.trials))

    def setup(self, trial: Trial) -> Setup:
        """What a trial pressed, with what, and on what."""
        tissue = self.specimen if trial.height is None else stretched_tissue(self.specimen, trial.height)
        return tissue, trial.tool, trial.support

    @property
    def setups(self) -> tuple[Setup, ...]:
        """The set-ups of its trials, each once, in the order in which they first occur."""
        return tuple(dict.fromkeys(self.setup(trial) for trial in self.trials))

    def by_height(self) -> list[Session]:
        """The session in parts, each with the trials of one height of specimen; itself where there is but one."""
        heights = list(dict.fromkeys(trial.height for trial in self.trials))
        return [self] if heights == [None] else [self._of_height(height) for height in heights]

    def _of_height(self, height: float | None) -> Session:
        own = tuple(trial for trial in self.trials if trial.height == height)
        tissue = self.setup(own[0])[0]
        return replace(self, name=f"{self.name}, {1e3 * tissue.thickness:.4g} mm", specimen=tissue, trials=own)

    def uncertainties(self, setup: Setup) -> dict[str, float]:
        """Standard uncertainties that are stated of a set-up, as shares of the values, by keys as in `--set`."""
        return setup_uncertainties(*setup)

    def scenario(self, tissue: Tissue, tool: Tool, support: Support, load: Load) -> Scenario:
        """A press as a scenario, named like the session, with the session's `settings` in it.

        Raises
        ------
        InputError
            When the parts do not fit each other, or a setting is not allowed.
        """
        parts = {"tissue": tissue, "tool": tool.to_table(), "support": support.to_table(), "load": load.to_table()}
        return scenario_from_table({"name": self.name, **parts}, Source(f"session {self.folder}"), self.settings)
