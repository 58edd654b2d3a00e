"""What a reader of a scenario's results must know about its file: allowed, but easily misread."""

from __future__ import annotations

from benchmark.files.load import Load
from benchmark.files.scenario import Scenario
from benchmark.files.tissue import Layer

_ALIKE = 0.02


def scenario_notes(scenario: Scenario) -> tuple[str, ...]:
    """Say what of a scenario has no effect, or not the one that its file suggests; one sentence each."""
    found = [_law_apart(layer) for layer in scenario.tissue.layers]
    found += [_stepped_over(scenario.load), _unused_hold(scenario.load), _unused_position(scenario)]
    if scenario.support.hole_radius is not None and scenario.support.kind != "hole":
        found.append(f"support.hole_radius has no effect: the support is {scenario.support.kind}")
    if scenario.physics.friction_coefficient is not None and scenario.tool.contact != "rigid_frictional":
        found.append(f"physics.friction_coefficient has no effect: the contact is {scenario.tool.contact}")
    return tuple(note for note in found if note)


def _law_apart(layer: Layer) -> str | None:
    """A layer whose law starts with another stiffness than its moduli say: models with and without the law differ."""
    law = layer.hyperelastic.shear_modulus
    if law is None or abs(law / layer.shear_modulus - 1) <= _ALIKE:
        return None
    return (
        f"layer {layer.name}: its {layer.hyperelastic.law} law begins with a shear modulus of {law / 1e3:.4g} kPa, "
        f"its moduli say {layer.shear_modulus / 1e3:.4g} kPa; finite strain follows the law, small strain the moduli"
    )


def _stepped_over(load: Load) -> str | None:
    if load.shape != "triangle" or load.observations is None or load.observations % 2 == 0:
        return None
    return f"{load.observations} observations, an odd number, step over the triangle's peak, which is never reached"


def _unused_hold(load: Load) -> str | None:
    if load.hold is None or load.shape == "ramp_hold":
        return None
    return f"load.hold has no effect: the shape is {load.shape}"


def _unused_position(scenario: Scenario) -> str | None:
    if scenario.tool.position == (0.0, 0.0) or scenario.support.kind == "hole":
        return None
    if scenario.fem.geometry != "axisymmetric":
        return None
    return "tool.position has no effect: the specimen is laterally endless, and the same everywhere"
