"""Print the linear wave, nothing calibrated, against the linear finite elements: `make bench-accuracy`.

Three layers of skin on a bonded base: tools of 1 to 5 mm, fat of 3 to 20 mm, Poisson ratios of 0.45 to 0.499, fine
mesh; all of the wave's set-up is automatic. Under a pressure the force is given, under a rigid tool the depth.
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

from collections.abc import Iterator  # noqa: E402
from dataclasses import dataclass  # noqa: E402
from itertools import product  # noqa: E402

import numpy as np  # noqa: E402

import fem  # noqa: E402
from benchmark.models.model_result import profile_radii  # noqa: E402
from tests.performance.wave.job import DENSITY, LAYERS  # noqa: E402
from wavemodel import DiscTool, LayeredWave, WaveLayer  # noqa: E402

RADII, FATS, RATIOS = (1e-3, 2e-3, 5e-3), (3e-3, 10e-3, 20e-3), (0.45, 0.48, 0.499)
"""Of the tool, m; thickness of the fat, m; Poisson ratio."""
MAXIMUM, PROFILE, RIGID = 0.3, 1.0, 0.5
"""The bars, %: a layer's maximum and its profile under a pressure, force for depth under a rigid tool."""
SMALL = {"force": 1e-3, "depth": 1e-6}
"""N, m."""


@dataclass(frozen=True)
class Case:
    """One tool on one skin."""

    contact: str
    radius: float
    fat: float
    poisson_ratio: float

    @property
    def rigid(self) -> bool:
        """Whether the tool is."""
        return self.contact != "uniform_pressure"

    def __str__(self) -> str:
        """In a table."""
        cells = (self.contact, f"{1e3 * self.radius:g}", f"{1e3 * self.fat:g}", f"{self.poisson_ratio:g}")
        return " | ".join(cells)


@dataclass(frozen=True)
class Errors:
    """In %: largest of a layer's maximum, of a profile to five tool radii over its peak, and of force for depth."""

    case: Case
    maximum: float
    profile: float
    stiffness: float

    @property
    def met(self) -> bool:
        """Whether the bars of the case are met."""
        if self.case.rigid:
            return self.stiffness <= RIGID
        return self.maximum <= MAXIMUM and self.profile <= PROFILE


def cases() -> Iterator[Case]:
    """All combinations under a pressure, and the corners of them under rigid tools."""
    for radius, fat, ratio in product(RADII, FATS, RATIOS):
        yield Case("uniform_pressure", radius, fat, ratio)
    for contact in ("rigid_frictionless", "rigid_bonded"):
        for radius, fat, ratio in product(RADII[::2], FATS[::2], RATIOS[::2]):
            yield Case(contact, radius, fat, ratio)


def compare(case: Case) -> Errors:
    """Press with both."""
    thickness = {name: h for name, h, _ in LAYERS} | {LAYERS[-1][0]: case.fat}
    stack = [WaveLayer(name, thickness[name], DENSITY, e, case.poisson_ratio) for name, _, e in LAYERS]
    control = "depth" if case.rigid else "force"
    time, value = np.ones(1), np.array([SMALL[control]])
    wave = LayeredWave(stack, DiscTool(case.radius, case.contact), large_press="linear").run(control, time, value)
    exact = _finite_elements(case, stack).run(fem.Load(control, time, value))
    radii = profile_radii(case.radius)
    truth, found = exact.profile(0, radii), wave.profile(0, radii)
    peak = np.abs(truth).max(axis=1)
    maximum = np.abs(wave.top_deflection[0] / exact.top_deflection[0] - 1.0).max()
    stiffness = (wave.force[0] / wave.depth[0]) / (exact.force[0] / exact.depth[0]) - 1.0
    profile = np.nanmax(np.abs(found - truth) / peak[:, None])
    return Errors(case, *(100.0 * abs(float(error)) for error in (maximum, profile, stiffness)))


def _finite_elements(case: Case, stack: list[WaveLayer]) -> fem.Model:
    layers = (
        fem.Layer(one.name, one.thickness, one.density, fem.LinearElastic(one.youngs_modulus, one.poisson_ratio))
        for one in stack
    )
    return fem.prepare(
        fem.Problem(
            layers=tuple(layers),
            tool=fem.Tool(case.radius, case.contact),
            support=fem.Support("bonded", None),
            kinematics="linear",
            discretisation=fem.Discretisation("fine", None),
        )
    )


def row(found: Errors) -> str:
    """One line of the table."""
    errors = f"{found.maximum:.3f} | {found.profile:.3f} | {found.stiffness:.3f}"
    return f"| {found.case} | {errors} | {'yes' if found.met else 'NO'} |"


def main() -> None:
    """Measure and print, Markdown."""
    print(
        f"Wanted: under a pressure maximum {MAXIMUM:g} %, profile {PROFILE:g} % of peak; "
        f"under a rigid tool force for depth {RIGID:g} %.\n"
    )
    print("| contact | tool mm | fat mm | Poisson ratio | maximum % | profile % | force for depth % | met |")
    print("|---|---|---|---|---|---|---|---|")
    for case in cases():
        print(row(compare(case)), flush=True)


if __name__ == "__main__":
    main()
