"""Specimens of several heights in one session: each trial is fitted with the press on its own."""

import json

import numpy as np
import pytest

from benchmark.runs.fit_run import FitRequest, fit_to_folder
from benchmark.runs.parameters_run import ParameterWish
from benchmark.scripting import Unheard

MODULUS, RADIUS = 30e3, 10e-3
SESSION = """schema = 1
name = "cylinders"
synthetic = true
[tool]
radius = "10 mm"
contact = "rigid_frictionless"
[support]
kind = "plates"
specimen_radius = "10 mm"
"""


def squeezed(stretch):
    """Force (N) on a cylinder of an incompressible neo-Hookean solid between plates that slide: uniaxial, exactly."""
    return np.pi * RADIUS**2 * MODULUS / 3.0 * (1.0 / stretch**2 - stretch)


@pytest.fixture(scope="module")
def cylinders(tmp_path_factory):
    """One silicone in cylinders of 8, 12 and 20 mm, two presses each to 8 % of the height."""
    folder = tmp_path_factory.mktemp("cylinders")
    (folder / "session.toml").write_text(SESSION)
    lines, generator = [SESSION], np.random.default_rng(3)
    for height in (8e-3, 12e-3, 20e-3):
        for number in range(2):
            time = np.linspace(0.0, 10.0, 120)
            depth = height * np.interp(time, [0, 1, 5, 9, 10], [-0.01, 0.0, 0.08, 0.0, -0.01])
            force = squeezed(1.0 - np.maximum(depth, 0.0) / height)
            force = force * (1.0 + 3e-3 * generator.normal()) + 1e-3 * generator.normal(size=time.size)
            name = f"h{1e3 * height:g}_{number}.csv"
            columns = np.column_stack([time, 1e3 * depth, force])
            np.savetxt(folder / name, columns, delimiter=",", header="time_s,depth_mm,force_N", comments="")
            lines.append(f'[[trials]]\nfile = "{name}"\ncondition = "slow"\nheight = "{1e3 * height:g} mm"')
    (folder / "session.toml").write_text("\n".join(lines))
    return folder


def fitted(session, out, **wish):
    settings = {"fem.mesh": "coarse", "specimen.poisson_ratio": "0.4995"}
    fit_to_folder(FitRequest(session, settings=settings, wish=ParameterWish(**wish)), out, Unheard())
    return json.loads((out / "fit.json").read_text())


def test_each_trial_is_fitted_with_its_own_height(cylinders, tmp_path) -> None:
    """With the median for all one silicone had 20 to 50 kPa."""
    found = fitted(cylinders, tmp_path / "out")
    factors = [trial["stiffness_factor"] for trial in found["trials"]]
    assert np.array(factors) * 20e3 == pytest.approx(MODULUS, rel=0.015)
    assert max(factors) < 1.015 * min(factors)
    assert set(found["session"]["heights_mm"].values()) == {8.0, 12.0, 20.0}


def test_free_parameters_are_those_of_all_heights_and_thicknesses_each_ones_own(cylinders, tmp_path) -> None:
    found = fitted(cylinders, tmp_path / "out", free=("specimen.youngs_modulus",))
    value, (low, high) = (found["parameters"]["specimen.youngs_modulus"][key] for key in ("value", "ci95"))
    assert low < 1e-3 * MODULUS < high
    assert value == pytest.approx(1e-3 * MODULUS, rel=0.02)
    told = [(each["name"], each["source"]) for each in found["told"]]
    assert len([name for name, _ in told if name == "specimen.poisson_ratio"]) == 1
    thick = [source for name, source in told if name == "specimen.thickness"]
    assert [f"cylinders, {height} mm" in source for height, source in zip((8, 12, 20), thick, strict=True)] == [
        True
    ] * 3
