"""The hidden sheet under the phantom session, computed by the finite elements, and what the session's files say of it.

A fit reads `session_text`; the facts that it has to find stand in `truth_text`, trial by trial.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from bench_hw.simulated.tabulated import SheetTable
from benchmark.errors import SolverError
from benchmark.files import Load, Scenario, Support, Tool, load_tissue, scaled_tissue
from benchmark.models import Drive, prepare
from benchmark.models.model_result import lower_face

if TYPE_CHECKING:
    from bench_hw.simulated.specimen import MarkerGrid

SPECIMEN: Final = "rtv3498_sheet"
TRUE_FACTOR: Final = 0.83
"""The sheet's modulus over the tissue file's 400 kPa: 332 kPa, at once after a step."""
RELAXATION: Final = ((0.06, 1.5),)
"""Share and time (s) by which the force relaxes."""
TOOL: Final = Tool(radius=5e-3, contact="rigid_bonded")
SUPPORT: Final = Support(kind="hole", hole_radius=30e-3)
DEEPEST: Final = 6e-3
STEPS: Final = 30
SOURCE: Final = (
    "computed by the axisymmetric finite elements of this product (finite strain, neo-Hookean), 332 kPa, Poisson's "
    "ratio 0.49, 4 mm over a hole of 30 mm radius, rigid tool of 5 mm radius bonded to it; synthetic, not measured"
)


def hidden_sheet() -> SheetTable:
    """Press the hidden sheet and give force and lower face over depth.

    Raises
    ------
    SolverError
        It could not be pressed deep enough.
    """
    tissue = scaled_tissue(load_tissue(SPECIMEN), TRUE_FACTOR, "hidden sheet")
    load = Load(control="depth", peak=DEEPEST, shape="ramp", duration=1.0, observations=1)
    scenario = Scenario(name="hidden sheet", tissue=tissue, tool=TOOL, support=SUPPORT, load=load)
    fractions = np.arange(1, STEPS + 1) / STEPS
    result = prepare("fem", scenario, every_field=True).run(Drive("depth", fractions, DEEPEST * fractions))
    face = lower_face(result)
    if result.failure is not None or face is None:
        raise SolverError(f"the hidden sheet could not be pressed: {result.failure}")
    inside = face.radius <= SUPPORT.hole_radius + 1e-9 if SUPPORT.hole_radius is not None else slice(None)
    return SheetTable(
        depth=face.depth,
        force=np.append(0.0, result.force),
        radius=face.radius[inside],
        outward=np.round(face.outward[:, inside], 10),
        sunk=np.round(face.sunk[:, inside], 10),
        hole_radius=float(SUPPORT.hole_radius or 0.0),
        tool_radius=TOOL.radius,
        source=SOURCE,
        tissue=SPECIMEN,
    )


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
