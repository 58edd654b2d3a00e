"""What `discover` writes: discovery.json, tables, model.toml, next_experiment.toml and the page in one folder."""

from benchmark.discovery.files.document import discovery_document
from benchmark.discovery.files.folder import DiscoveryOutcome, write_discovery
from benchmark.discovery.files.tables import discovery_tables

__all__ = ["DiscoveryOutcome", "discovery_document", "discovery_tables", "write_discovery"]
