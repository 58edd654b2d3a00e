"""The page of a check."""

from benchmark.gate.report.page import check_page

__all__ = ["check_page"]
