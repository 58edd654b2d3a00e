"""The text files of the phantom session: what a fit reads, and the truth it does not, trial by trial."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from benchmark.sessions.phantom_sheet import RELAXATION, SPECIMEN, TRUE_FACTOR

if TYPE_CHECKING:
    from bench_hw.simulated.specimen import MarkerGrid


@dataclass(frozen=True)
class TrueTrial:
    """What is drawn for one trial: stiffness over the sheet's, contact (m), tool axis on the grid (m), seed."""

    name: str
    condition: str
    protocol: str
    gain: float
    contact: float
    axis: tuple[float, float]
    seed: int
    film: bool


_HEAD = """\
schema = 1
name = "phantom"
specimen = "{specimen}"
synthetic = true            # computed and captured by benchmark/sessions/make_phantom.py, not measured

[tool]
radius = "5 mm"
contact = "rigid_bonded"

[support]
kind = "hole"
hole_radius = "30 mm"

[drive]
channel = "depth"

[camera]
marker_rows = {rows}
marker_columns = {columns}
marker_spacing = "{spacing:g} mm"
distance = "70 mm"
file = "camera.toml"
"""

_TRUTH = """\
# What was put into the phantom session. Synthetic. No fit reads this file; tests and readers compare with it.
schema = 1
specimen = "{specimen}"
youngs_modulus_factor = {factor}        # over the tissue file's modulus, at once after a step
relaxation = {relaxation}        # share of the force, and time in s
force_noise_N = 0.002
depth_count_mm = {count:.6f}        # of the actuator's reading
"""


def session_text(trials: Sequence[TrueTrial], grid: MarkerGrid) -> str:
    """Give the text of `session.toml`."""
    text = _HEAD.format(specimen=SPECIMEN, rows=grid.rows, columns=grid.columns, spacing=1e3 * grid.spacing)
    for trial in trials:
        text += f'\n[[trials]]\nfile = "{trial.name}.{"mcap" if trial.film else "csv"}"\n'
        text += "" if trial.film else f'markers = "{trial.name}_markers.csv"\n'
        text += f'condition = "{trial.condition}"\n'
    return text


def truth_text(trials: Sequence[TrueTrial]) -> str:
    """Give the text of `truth.toml`."""
    relaxation = [list(term) for term in RELAXATION]
    text = _TRUTH.format(specimen=SPECIMEN, factor=TRUE_FACTOR, relaxation=relaxation, count=50.0 / 1023)
    for trial in trials:
        text += f'\n[[trials]]\nname = "{trial.name}"\ngain = {trial.gain:.6f}\n'
        text += f"contact_mm = {1e3 * (trial.contact - 5e-3):.6f}\n"
        text += f"axis_mm = [{1e3 * trial.axis[0]:.6f}, {1e3 * trial.axis[1]:.6f}]\n"
    return text
