"""A verification run as a result folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmark.runs.document import describe_environment
from benchmark.verification.cases import VerificationRow
from benchmark.verification.verification_page import columns, document, verification_page
from reports import whole_folder, write_csv, write_json, write_page


def write_verification(rows: Sequence[VerificationRow], folder: Path) -> Path:
    """Write verification.json, verification.csv and report.html; return the page's path.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    with whole_folder(folder) as new:
        write_json(new / "verification.json", document(rows))
        write_csv(new / "verification.csv", columns(rows))
        write_page(new / "report.html", verification_page(rows, describe_environment(seed=0)))
    return folder / "report.html"
