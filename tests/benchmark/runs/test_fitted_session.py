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


def test_each_trial_is_fitted_with_its_own_height(cylinders, tmp_path, follow_links) -> None:
    """With the median for all one silicone had 20 to 50 kPa."""
    found = fitted(cylinders, tmp_path / "out")
    factors = [trial["stiffness_factor"] for trial in found["trials"]]
    assert np.array(factors) * 20e3 == pytest.approx(MODULUS, rel=0.015)
    follow_links(tmp_path / "out" / "report.html")
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


@pytest.fixture
def fading(tmp_path):
    """Three presses of a cylinder, held while three tenths of the force fade."""
    folder, time = tmp_path / "fading", np.linspace(0.0, 12.0, 240)
    folder.mkdir()
    depth = 10e-3 * np.interp(time, [0.0, 0.5, 1.0, 12.0], [-0.01, 0.0, 0.08, 0.08])
    fades = 1.0 - 0.3 * (1.0 - np.exp(-np.maximum(time - 0.75, 0.0) / 2.0))
    lines, generator = [SESSION], np.random.default_rng(4)
    for number in range(3):
        force = squeezed(1.0 - np.maximum(depth, 0.0) / 10e-3) * fades + 1e-3 * generator.normal(size=time.size)
        columns = np.column_stack([time, 1e3 * depth, force])
        name = f"{number}.csv"
        np.savetxt(folder / name, columns, delimiter=",", header="time_s,depth_mm,force_N", comments="")
        lines.append(f'[[trials]]\nfile = "{name}"\ncondition = "held"')
    (folder / "session.toml").write_text("\n".join(lines))
    return folder


def test_relaxation_that_is_fitted_is_not_called_beyond_the_law(fading, tmp_path) -> None:
    plain = fitted(fading, tmp_path / "plain")
    assert any("an elastic law cannot follow" in text for text in plain["warnings"])
    free = fitted(fading, tmp_path / "free", free=("specimen.youngs_modulus", "specimen.relaxation"))
    assert free["parameters"]["specimen.relaxation.g"]["value"] == pytest.approx(0.3, abs=0.03)
    assert not any("an elastic law cannot follow" in text for text in free["warnings"])
