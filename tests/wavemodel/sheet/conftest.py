"""The sheets that finite elements were solved for, and a factory of the plain sheet."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from wavemodel import DiscTool, WaveLayer
from wavemodel.sheet.sheet import Sheet, sheet

FEM = json.loads((Path(__file__).parent / "fem_sheets.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def fem_sheets() -> dict[str, dict]:
    """Presses of 0.5 to 5 N (or as said) by the finite-element package, by name."""
    return {case["name"]: case for case in FEM["cases"]}


@pytest.fixture(scope="session")
def pressed_sheet(silicone: Callable[..., list[WaveLayer]]) -> Callable[[str], Sheet]:
    """The phantom's sheet over its 30 mm hole under a 5 mm tool of some contact."""
    return lambda contact: sheet(silicone(), DiscTool(5e-3, contact), 30e-3, 10)
