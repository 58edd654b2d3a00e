"""CSV tables at the border of the bench: trials and marker tracks, read strictly and written whole."""

from bench_hw.errors import TableError
from bench_hw.tables.columns import MINIMUM_ROWS
from bench_hw.tables.measurement import (
    MarkerTable,
    TrialTable,
    calm,
    read_marker_csv,
    read_trial_csv,
    write_marker_csv,
    write_trial_csv,
)

__all__ = [
    "MINIMUM_ROWS",
    "MarkerTable",
    "TableError",
    "TrialTable",
    "calm",
    "read_marker_csv",
    "read_trial_csv",
    "write_marker_csv",
    "write_trial_csv",
]
