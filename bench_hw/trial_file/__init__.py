"""Native trial files: one `.mcap` a trial, written to survive a kill, read without inventing anything."""

from bench_hw.trial_file.reading import Ending, ending_of_trial, read_trial_mcap
from bench_hw.trial_file.records import (
    EventRecord,
    ForceRecord,
    FrameRecord,
    PositionRecord,
    TrialHeader,
    TrialWriter,
)
from bench_hw.trial_file.writer import open_trial

__all__ = [
    "Ending",
    "EventRecord",
    "ForceRecord",
    "FrameRecord",
    "PositionRecord",
    "TrialHeader",
    "TrialWriter",
    "ending_of_trial",
    "open_trial",
    "read_trial_mcap",
]
