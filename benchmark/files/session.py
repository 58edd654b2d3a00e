"""A trial session: measured presses of one specimen, with what is known and what had to be assumed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmark.files.load import Load
from benchmark.files.loading import scenario_from_table
from benchmark.files.scenario import Scenario
from benchmark.files.session_file import Camera
from benchmark.files.sources import Source
from benchmark.files.tissue import Tissue
from benchmark.files.tool import Support, Tool
from benchmark.files.trials import Trial


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

    @property
    def conditions(self) -> tuple[str, ...]:
        """The conditions in the order in which they first occur."""
        return tuple(dict.fromkeys(trial.condition for trial in self.trials))

    def scenario(self, tissue: Tissue, tool: Tool, support: Support, load: Load) -> Scenario:
        """A press as a scenario, named like the session, with the session's `settings` in it.

        Raises
        ------
        InputError
            When the parts do not fit each other, or a setting is not allowed.
        """
        parts = {"tissue": tissue, "tool": tool.to_table(), "support": support.to_table(), "load": load.to_table()}
        return scenario_from_table({"name": self.name, **parts}, Source(f"session {self.folder}"), self.settings)
