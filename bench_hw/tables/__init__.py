"""CSV tables at the border of the bench: trials and marker tracks, read strictly and written whole."""

from bench_hw.errors import TableError
from bench_hw.tables.marker import read_marker_csv, write_marker_csv
from bench_hw.tables.model import MINIMUM_ROWS, MarkerTable, TrialTable
from bench_hw.tables.trial import read_trial_csv, write_trial_csv

__all__ = [
    "MINIMUM_ROWS",
    "MarkerTable",
    "TableError",
    "TrialTable",
    "read_marker_csv",
    "read_trial_csv",
    "write_marker_csv",
    "write_trial_csv",
]
