"""Input files: tissues, scenarios and trial sessions, read with units and checked; all values SI floats.

It imports pydantic and NumPy, so a command line imports it inside the verbs that need it.
"""

from benchmark.files.load import Load, LoadHistory
from benchmark.files.loading import load_scenario, load_tissue, scenario_from_table, tissue_from_table
from benchmark.files.scenario import Scenario, scenario_notes
from benchmark.files.sessions.description import Camera
from benchmark.files.sessions.session_loading import load_session
from benchmark.files.sessions.trials import Session, Setup, Trial
from benchmark.files.shipped import Entry, shipped_scenarios, shipped_tissues
from benchmark.files.sources import Source
from benchmark.files.tissue import Layer, Tissue, scaled_tissue, stretched_tissue
from benchmark.files.tool import Support, Tool

__all__ = [
    "Camera",
    "Entry",
    "Layer",
    "Load",
    "LoadHistory",
    "Scenario",
    "Session",
    "Setup",
    "Source",
    "Support",
    "Tissue",
    "Tool",
    "Trial",
    "load_scenario",
    "load_session",
    "load_tissue",
    "scaled_tissue",
    "scenario_from_table",
    "scenario_notes",
    "shipped_scenarios",
    "shipped_tissues",
    "stretched_tissue",
    "tissue_from_table",
]
