"""Runs from request to result folder."""

from benchmark.runs.fit_run import FitOutcome, FitRequest, fit_to_folder
from benchmark.runs.options import RunOptions
from benchmark.runs.output.run_folder import RunOutcome
from benchmark.runs.requests import RunRequest, carry_out

__all__ = ["FitOutcome", "FitRequest", "RunOptions", "RunOutcome", "RunRequest", "carry_out", "fit_to_folder"]
