"""What the report of a run says: which sections, tables and figures, in which words."""

from benchmark.runs.report.fit_page import fit_page
from benchmark.runs.report.run_page import run_page
from benchmark.runs.report.tissues_page import tissues_page
from benchmark.runs.report.trials_section import TrialsPart

__all__ = ["TrialsPart", "fit_page", "run_page", "tissues_page"]
