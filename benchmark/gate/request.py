"""What a check was asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from benchmark.gate.history import history_path
from benchmark.gate.stored import DEFAULT


@dataclass(frozen=True)
class CheckRequest:
    """See `python -m benchmark check --help`.

    Attributes
    ----------
    baseline
        The baseline file; None for `tissuebench-baseline.json` in the current folder.
    against
        Another revision to measure beside this version.
    gate
        The gate file; None for the shipped one.
    history
        The history file; None for the one beside the baseline.
    out
        Folder of the report; None for `results/check-DATE-TIME`.
    seed
        Of the bootstrap.
    """

    baseline: Path | None = None
    against: str | None = None
    gate: Path | None = None
    history: Path | None = None
    out: Path | None = None
    seed: int = 0

    @property
    def baseline_path(self) -> Path:
        """Where the baseline is."""
        return DEFAULT if self.baseline is None else self.baseline

    @property
    def history_path(self) -> Path:
        """Where the history is."""
        return history_path(self.baseline_path) if self.history is None else self.history
