"""The specimen of a session: a tissue that it names, or the assumed single layer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from bench_hw.tables import TrialTable
from benchmark.files.tissue import Layer, Tissue

ASSUMED_THICKNESS: Final = 10e-3
ASSUMED_YOUNGS_MODULUS: Final = 20e3
ASSUMED_POISSON_RATIO: Final = 0.49
ASSUMED_DENSITY: Final = 1000.0


def assumed_specimen(tables: Sequence[TrialTable]) -> tuple[Tissue, str]:
    """One layer of soft tissue as thick as the gap between tool and base at zero depth.

    Parameters
    ----------
    tables : sequence of TrialTable
        The session's trials; those with a `gap` column give the thickness, its median over trials.

    Returns
    -------
    (Tissue, str)
        The layer, and the warning that says what was assumed. The modulus is a start value for the fit (soft
        tissue lies at 1 to 100 kPa); the Poisson ratio is that of a nearly incompressible tissue.
    """
    gaps = [gap for gap in map(_gap_at_zero_depth, tables) if gap is not None and 1e-7 <= gap <= 1e5]
    thickness = float(np.median(gaps)) if gaps else ASSUMED_THICKNESS
    layer = Layer(
        name="specimen",
        thickness=thickness,
        density=ASSUMED_DENSITY,
        youngs_modulus=ASSUMED_YOUNGS_MODULUS,
        poisson_ratio=ASSUMED_POISSON_RATIO,
    )
    how = (
        f"median gap_mm at zero depth, trials: {len(gaps)}, {1e3 * min(gaps):.3g} to {1e3 * max(gaps):.3g} mm"
        if gaps
        else "no trial has a usable gap_mm"
    )
    warning = (
        f"the specimen is not given: assumed one layer of {1e3 * thickness:.4g} mm ({how}), "
        f"Poisson ratio {ASSUMED_POISSON_RATIO:g}, density {ASSUMED_DENSITY:g} kg/m^3, "
        f"Young's modulus {ASSUMED_YOUNGS_MODULUS / 1e3:g} kPa before any fit"
    )
    return Tissue(name="assumed specimen", citation="assumed, see warnings", layers=(layer,)), warning


def _gap_at_zero_depth(table: TrialTable) -> float | None:
    """Thickness of the specimen (m) at the row nearest to zero depth, the first of them; None without a gap."""
    gap = table.extra.get("gap")
    if gap is None:
        return None
    row = int(np.argmin(np.abs(table.depth)))
    return float(gap[row] + table.depth[row])
