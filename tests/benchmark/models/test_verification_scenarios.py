"""Published cases through scenario files alone: what a user can check without Python."""

from pathlib import Path

import numpy as np
import pytest

from benchmark.files import load_scenario
from benchmark.models import ModelResult, prepare, scenario_drive

HALF_SPACE = """
schema = 1
name = "half-space"
[tissue]
schema = 1
name = "steel-like half-space"
[[tissue.layers]]
name = "z0"
thickness = "100 mm"
density = "1000 kg/m^3"
youngs_modulus = "200 MPa"
poisson_ratio = {nu}
[[tissue.layers]]
name = "z100"
thickness = "50 mm"
density = "1000 kg/m^3"
youngs_modulus = "200 MPa"
poisson_ratio = {nu}
[[tissue.layers]]
name = "z150"
thickness = "150 mm"
density = "1000 kg/m^3"
youngs_modulus = "200 MPa"
poisson_ratio = {nu}
[[tissue.layers]]
name = "z300"
thickness = "700 mm"
density = "1000 kg/m^3"
youngs_modulus = "200 MPa"
poisson_ratio = {nu}
[[tissue.layers]]
name = "z1000"
density = "1000 kg/m^3"
youngs_modulus = "200 MPa"
poisson_ratio = {nu}
[tool]
radius = "150 mm"
contact = "{contact}"
[support]
kind = "half_space"
[load]
peak = "{force} N"
shape = "ramp"
duration = "1 s"
observations = 2
[fem]
kinematics = "linear"
"""

HAYES = """
schema = 1
name = "rigid punch on a bonded layer"
[tissue]
schema = 1
name = "layer"
[[tissue.layers]]
name = "layer"
thickness = "{thickness} mm"
density = "1000 kg/m^3"
youngs_modulus = "100 kPa"
poisson_ratio = 0.45
[tool]
radius = "5 mm"
contact = "rigid_frictionless"
[load]
control = "depth"
peak = "0.01 mm"
shape = "ramp"
duration = "1 s"
observations = 1
[fem]
kinematics = "linear"
"""

KAPPA = {0.2: 1.2523, 0.4: 1.5993, 0.6: 2.0328, 0.8: 2.5354, 1.0: 3.0914, 1.5: 4.6576, 2.0: 6.4206}
"""Hayes et al. 1972, J Biomech 5:541, recomputed to five digits: kappa = (1 - nu^2) P / (2 a E w) by a / h."""


def solve(tmp_path: Path, text: str, model: str = "fem") -> ModelResult:
    path = tmp_path / "scenario.toml"
    path.write_text(text)
    scenario = load_scenario(path)
    return prepare(model, scenario).run(scenario_drive(scenario))


def boussinesq_disc(depths: np.ndarray, radius: float, pressure: float, youngs: float, nu: float) -> np.ndarray:
    """Settlement under the centre of a uniform disc load (Poulos and Davis 1974, eq. 3.1 family), m."""
    root = np.sqrt(radius**2 + depths**2)
    shape = 2 * (1 - nu) * (root - depths) + depths * (1 - depths / root)
    return pressure * (1 + nu) / youngs * shape


@pytest.mark.parametrize("nu", [0.35, 0.499])
def test_half_space_under_a_disc_load(tmp_path: Path, nu: float) -> None:
    force = 1.1e6 * np.pi * 0.15**2
    result = solve(tmp_path, HALF_SPACE.format(nu=nu, contact="uniform_pressure", force=force))
    exact = boussinesq_disc(np.array([0.0, 0.1, 0.15, 0.3, 1.0]), 0.15, 1.1e6, 200e6, nu)
    if nu == 0.35:
        np.testing.assert_allclose(1e3 * exact, [1.4478, 1.1055, 0.9259, 0.5769, 0.1901], rtol=0, atol=1e-4)
    np.testing.assert_allclose(result.top_deflection[-1], exact, rtol=1e-3)
    assert result.unknowns <= 10_000


def test_half_space_under_a_flat_punch(tmp_path: Path) -> None:
    result = solve(tmp_path, HALF_SPACE.format(nu=0.35, contact="rigid_frictionless", force=1000.0))
    exact = 1000.0 * (1 - 0.35**2) / (2 * 200e6 * 0.15)
    assert result.depth[-1] == pytest.approx(exact, rel=3e-3)


@pytest.mark.parametrize("ratio", KAPPA)
def test_punch_on_a_bonded_layer(tmp_path: Path, ratio: float) -> None:
    result = solve(tmp_path, HAYES.format(thickness=5.0 / ratio))
    kappa = (1 - 0.45**2) * result.force[-1] / (2 * 5e-3 * 100e3 * 0.01e-3)
    assert kappa == pytest.approx(KAPPA[ratio], rel=3e-3)
