"""Wave and FEM with the same body effect switched on, side by side: `make bench-effects`.

Each body effect of the catalogue is given to both models through a model file, on the layered skin on a base and on the
phantom sheet over a hole, under a triangle of force. The table says where the FEM has the effect, how deep the press
goes, and how far the wave is from the FEM at the peak and anywhere in the history, in per cent of the peak's depth; the
first row of each specimen is without effects.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from benchmark.files import Scenario, load_scenario
from benchmark.model_file import AddedEffect, RepairedModel, Value
from benchmark.models import ModelResult, scenario_drive
from benchmark.physics import catalogue
from benchmark.response.model_with_effects import prepare_with_effects

SPECIMENS: Final = {"skin on a base": ("skin-5N", "2 N"), "sheet over a hole": ("phantom", "2 N")}
VALUES: Final[dict[str, dict[str, float]]] = {
    "strain_stiffening": {"b_1": 0.5, "b_2": 4.0},
    "viscoelastic_relaxation": {"g_1": 0.3, "tau_1": 1.0, "g_2": 0.2, "tau_2": 10.0},
    "viscous_damping": {"damping_time": 0.3, "drag": 0.0, "power": 1.0},
    "stress_softening": {"softening": 0.2, "softening_width": 0.5},
    "permanent_set": {"permanent_set": 0.1, "permanent_set_onset": 0.0, "marker_share": 0.5},
    "poroelastic_drainage": {"drainage_share": 0.3, "drainage_diffusivity": 2e-6},
    "pretension": {"pretension": 3e3, "field": 0.0},
    "interface_slip": {"slip_force": 0.5, "slip_share": 0.3, "marker_share": 0.0, "return_share": 0.0},
    "bottoming_out": {"floor_depth": 1e-3, "floor_stiffness": 2e3, "power": 1.0},
    "dry_friction": {"friction_force": 0.02, "friction_length": 1e-4, "friction_share": 0.02},
    "adhesion": {"tear": 0.0, "reach": 1e-3, "adhesion_force": 0.05},
}
"""A size of each body effect that changes a press; anisotropy shows in markers alone."""


@dataclass(frozen=True)
class Row:
    """One effect on one specimen.

    Attributes
    ----------
    specimen, effect : str
        The effect is "none" for the elastic answer.
    in_fem : str
        "itself" or "on top".
    depth : float
        Of the FEM at the peak, m.
    at_peak, anywhere : float
        Wave less FEM, in per cent of that depth: at the peak, and largest in the history.
    """

    specimen: str
    effect: str
    in_fem: str
    depth: float
    at_peak: float
    anywhere: float


def rows(observations: int = 40, mesh: str = "default") -> Iterator[Row]:
    """A row for each specimen and effect, the elastic answer first."""
    known = {effect.slug: effect.forms[-1] for effect in catalogue()}
    for specimen, (name, peak) in SPECIMENS.items():
        settings = {"load.peak": peak, "load.observations": str(observations), "fem.mesh": mesh}
        scenario = load_scenario(name, settings)
        yield _row(specimen, "none", scenario, ())
        for slug, values in VALUES.items():
            units = {parameter.name: parameter.unit for parameter in known[slug].description.parameters}
            parameters = {key: Value(value, units[key]) for key, value in values.items()}
            yield _row(specimen, slug, scenario, (AddedEffect(slug, parameters),))


def _row(specimen: str, slug: str, scenario: Scenario, effects: tuple[AddedEffect, ...]) -> Row:
    model = RepairedModel("side by side", scenario.tissue.name, "wave", effects, {}, "corrected")
    fem, wave = (_pressed(which, scenario, model) for which in ("fem", "wave"))
    apart = 100.0 * (wave.depth - fem.depth) / fem.depth[fem.peak_step]
    inside = slug in fem.notes.get("effects in the model itself", "")
    place = "itself" if inside or not effects else "on top"
    peak = fem.peak_step
    return Row(specimen, slug, place, float(fem.depth[peak]), float(apart[peak]), float(np.abs(apart).max()))


def _pressed(which: str, scenario: Scenario, model: RepairedModel) -> ModelResult:
    result = prepare_with_effects(which, scenario, own=model).run(scenario_drive(scenario))
    assert result.complete, f"{which} stops: {result.failure}"
    return result


def main() -> None:
    """Print the table as Markdown."""
    print("| specimen | effect | in the FEM | FEM at the peak, mm | wave at the peak, % | largest in the history, % |")
    print("|---|---|---|---|---|---|")
    for row in rows():
        numbers = f"{1e3 * row.depth:.3f} | {row.at_peak:+.2f} | {row.anywhere:.2f}"
        print(f"| {row.specimen} | `{row.effect}` | {row.in_fem} | {numbers} |", flush=True)


if __name__ == "__main__":
    main()
