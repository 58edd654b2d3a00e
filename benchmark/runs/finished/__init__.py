"""Finished runs read back from their folders: the page of one made again, several set side by side."""

from benchmark.runs.finished.carrying_out import ReportOutcome, compare_runs, page_again
from benchmark.runs.finished.saved_run import SavedRun, read_run

__all__ = ["ReportOutcome", "SavedRun", "compare_runs", "page_again", "read_run"]
