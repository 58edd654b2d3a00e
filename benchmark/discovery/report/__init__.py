"""The page of a discovery, a section a file."""

from benchmark.discovery.report.page import discovery_page

__all__ = ["discovery_page"]
