"""The result folder of `discover`, written whole or not at all."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.discovery.files.document import discovery_document
from benchmark.discovery.files.tables import discovery_tables
from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.report import discovery_page
from benchmark.model_file import model_toml
from benchmark.runs.document import describe_environment
from reports import whole_folder, write_csv, write_json, write_page, write_text


@dataclass(frozen=True)
class DiscoveryOutcome:
    """A finished discovery on disk: its folder, `discovery.json`'s content, its headline and its warnings."""

    folder: Path
    document: dict[str, Any]
    headline: str
    warnings: tuple[str, ...]


def write_discovery(record: DiscoveryRecord, folder: Path) -> DiscoveryOutcome:
    """Write discovery.json, model.toml, next_experiment.toml, tables and report into `folder`.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    document, environment = discovery_document(record), describe_environment(seed=record.seed)
    tables = discovery_tables(record)
    page = discovery_page(record, environment, list(tables))
    with whole_folder(folder) as new:
        for name, columns in tables.items():
            write_csv(new / "tables" / name, columns)
        write_json(new / "discovery.json", document)
        write_json(new / "environment.json", environment)
        write_text(new / "model.toml", model_toml(record.repaired()))
        if record.proposal is not None:
            write_text(new / "next_experiment.toml", record.proposal.toml)
        write_page(new / "report.html", page)
    return DiscoveryOutcome(folder, document, page.verdict.headline, record.found.warnings)
