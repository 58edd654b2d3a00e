"""The hidden sheet under the phantom session: computed by the finite elements, and the facts the fit has to find."""

from __future__ import annotations

from typing import Final

import numpy as np

from bench_hw.simulated.tabulated import SheetTable
from benchmark.errors import SolverError
from benchmark.files import Load, Scenario, Support, Tool, load_tissue, scaled_tissue
from benchmark.models import Drive, prepare
from benchmark.models.model_result import lower_face

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
