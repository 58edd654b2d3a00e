"""Print the wave in finite strain against the finite elements, tissue by tissue: `make bench-accuracy`.

Every shipped skin on its base and the phantom's sheet over its hole, from nothing to 5 N or to the tissue's
`max_force` (and beyond it), elastic, on the fine mesh. What counts is each load step down to the depth that the wave
takes as verified; deeper steps stand beside it.
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

from collections.abc import Iterator  # noqa: E402
from dataclasses import dataclass  # noqa: E402
from types import MappingProxyType  # noqa: E402

import numpy as np  # noqa: E402

import fem  # noqa: E402
from benchmark.files import Layer, Scenario, load_scenario  # noqa: E402
from benchmark.models import Drive  # noqa: E402
from benchmark.models.fem_problem import problem_of  # noqa: E402
from benchmark.models.fem_steps import follow_deeper  # noqa: E402
from benchmark.models.model_result import profile_radii  # noqa: E402
from benchmark.models.wave_layered import layered_wave  # noqa: E402
from benchmark.models.wave_parts import Solution  # noqa: E402
from benchmark.models.wave_plate import plate_wave  # noqa: E402
from wavemodel import DiscTool  # noqa: E402
from wavemodel.layered.body_options import verified_depth  # noqa: E402

SKINS = ("skin_forearm", "skin_mri_indentation", "skin_porcine_fat", "skin_traction")
STEPS, MOST_FORCE, SHIPPED_RADIUS, EDGE, FRICTION = 10, 5.0, 5.0, 0.2, 0.3
"""Load steps; N; mm; edge of a tool under which tissue slides, over its radius; Coulomb's coefficient."""
RANGE = 0.3
"""Of the hole's radius: up to here the bars hold over a hole; on a base `verified_depth` says it."""
DEEP = MappingProxyType(
    {"skin_forearm": 7.2, "skin_mri_indentation": 4.8, "skin_porcine_fat": 1.5, "skin_traction": 4.9}
)
"""N of a pressure on 5 mm of radius that come to 0.4 of the stack, skin by skin."""
MAXIMUM, PROFILE = 2.0, 5.0
"""The bars, %."""


@dataclass(frozen=True)
class Press:
    """A shipped scenario with another tissue, tool or load."""

    name: str
    scenario: Scenario
    peak: float

    @property
    def height(self) -> float:
        """What depths are measured by: the stack's height, or the hole's radius, m."""
        return self.scenario.support.hole_radius or sum(layer.thickness for layer in self.scenario.tissue.layers)

    @property
    def reach(self) -> float:
        """How deep the bars hold, in heights."""
        if self.scenario.support.hole_radius is not None:
            return RANGE
        tool = self.scenario.tool
        return verified_depth(DiscTool(tool.radius, tool.contact), self.height) / self.height


@dataclass(frozen=True)
class Comparison:
    """Errors of a wave at each load step.

    Attributes
    ----------
    press
        What was pressed.
    depth
        (n,) of the FEM over the stack's height, or over the hole's radius.
    maximum
        (n,) largest error of a layer's deflection on the axis, %.
    profile
        (n,) largest error of a layer's profile to five tool radii, % of its peak.
    warnings
        What the wave says of itself.
    """

    press: Press
    depth: np.ndarray
    maximum: np.ndarray
    profile: np.ndarray
    warnings: tuple[str, ...]

    @property
    def met(self) -> bool:
        """Whether both bars are met at each step inside the range, of which there is one at least."""
        worst = self.worst(inside=True)
        return worst is not None and worst[0] <= MAXIMUM and worst[1] <= PROFILE

    def worst(self, *, inside: bool) -> tuple[float, float] | None:
        """Largest errors of the steps inside, or outside, the range; None without such a step."""
        chosen = self.depth <= self.press.reach if inside else self.depth > self.press.reach
        return (float(self.maximum[chosen].max()), float(self.profile[chosen].max())) if chosen.any() else None


def shipped() -> Iterator[Press]:
    """The shipped tissues within their `max_force`."""
    for tissue in SKINS:
        for contact, radius in (
            ("uniform_pressure", 5.0),
            ("uniform_pressure", 2.0),
            ("rigid_bonded", 5.0),
            ("rigid_frictionless", 5.0),
            ("rigid_frictionless", 2.0),
            ("rigid_frictional", 5.0),
        ):
            yield _press("skin-5N", {"tissue": tissue}, contact, radius)
        yield _press("skin-5N", {"tissue": tissue}, "uniform_pressure", peak=DEEP[tissue])
    for contact in ("rigid_bonded", "uniform_pressure"):
        yield _press("phantom", {}, contact)


def beyond() -> Iterator[Press]:
    """The soft skins to 5 N, and a thick sheet over the hole."""
    for tissue in SKINS[1:]:
        yield _press("skin-5N", {"tissue": tissue}, "uniform_pressure", peak=MOST_FORCE)
    yield _press("phantom", {"silicone.thickness": "10 mm", "silicone.youngs_modulus": "200 kPa"}, "rigid_bonded")


def _press(
    base: str, changes: dict[str, str], contact: str, radius: float = SHIPPED_RADIUS, *, peak: float | None = None
) -> Press:
    """A smaller tool presses with less, so that it comes about as deep; `peak` N goes beyond the tissue's force."""
    tool = {"tool.contact": contact, "tool.radius": f"{radius:g} mm", "fem.mesh": "fine"}
    if contact in ("rigid_frictionless", "rigid_frictional"):
        tool["tool.edge_radius"] = f"{EDGE * radius:g} mm"
    if contact == "rigid_frictional":
        tool["physics.friction_coefficient"] = f"{FRICTION:g}"
    scenario = load_scenario(base, {**changes, **tool})
    usual = min(scenario.tissue.max_force or MOST_FORCE, MOST_FORCE) * radius / SHIPPED_RADIUS
    hole = scenario.support.hole_radius
    changed = "".join(f", {value}" for key, value in changes.items() if key != "tissue")
    place = "base" if hole is None else f"hole of {1e3 * hole:g} mm"
    to = "" if peak is None else f", to {peak:g} N"
    return Press(f"{scenario.tissue.name}{changed}, {contact}, {radius:g} mm, {place}{to}", scenario, peak or usual)


def compare(press: Press, steps: int = STEPS) -> Comparison:
    """Press with both in so many steps.

    Raises
    ------
    ArithmeticError
        If the finite elements stop early.
    """
    scenario = press.scenario
    time, force = np.arange(1.0, steps + 1.0), press.peak * np.arange(1, steps + 1) / steps
    hole = scenario.support.hole_radius
    elastic = scenario.tissue.model_copy(update={"layers": tuple(map(_elastic, scenario.tissue.layers))})
    peak = scenario.load.model_copy(update={"peak": press.peak})
    scenario = scenario.model_copy(update={"tissue": elastic, "load": peak})
    load = fem.Load("force", time, force)
    _, exact = follow_deeper(fem.prepare(problem_of(scenario)), lambda model, _: model.run(load))
    if not exact.complete:
        raise ArithmeticError(f"{press.name}: {exact.failure}")
    wave = (layered_wave if hole is None else plate_wave)(scenario).follow(Drive("force", time, force))
    errors = [_errors(exact, wave, step, profile_radii(scenario.tool.radius)) for step in range(steps)]
    maximum, profile = np.array(errors).T
    return Comparison(press, exact.depth / press.height, maximum, profile, wave.warnings)


def _elastic(layer: Layer) -> Layer:
    return layer.model_copy(update={"relaxation": ()})


def _errors(exact: fem.Solution, wave: Solution, step: int, radii: np.ndarray) -> tuple[float, float]:
    truth, found = exact.profile(step, radii), wave.profile(step, radii)
    peak = np.abs(truth).max(axis=1)
    maximum = np.abs(wave.top_deflection[step] / exact.top_deflection[step] - 1.0).max()
    return 100.0 * float(maximum), 100.0 * float(np.nanmax(np.abs(found - truth) / peak[:, None]))


def row(found: Comparison) -> str:
    """One line of the table."""
    cells = [found.press.name, f"{found.press.peak:g}", f"{found.depth[-1]:.2f}"]
    cells += [*_pair(found.worst(inside=True)), *_pair(found.worst(inside=False)), "yes" if found.met else "NO"]
    return f"| {' | '.join(cells)} |"


def _pair(worst: tuple[float, float] | None) -> tuple[str, str]:
    return ("-", "-") if worst is None else (f"{worst[0]:.2f}", f"{worst[1]:.2f}")


def main() -> None:
    """Measure and print, Markdown."""
    wanted = f"wanted where it is verified: maximum {MAXIMUM:g} %, profile {PROFILE:g} % of peak"
    print(f"Fine mesh, {STEPS} load steps; {wanted}.\n")
    print(
        "| press | peak N | depth over height, or hole radius | maximum % | profile % "
        "| deeper: maximum % | profile % | met |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for press in (*shipped(), *beyond()):
        print(row(compare(press)), flush=True)


if __name__ == "__main__":
    main()
