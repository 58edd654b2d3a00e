"""The wave that a repair begins with."""

import json
from pathlib import Path

import numpy as np

from benchmark.discovery.from_run import at_small_strain, read_run
from benchmark.models.wave_layered import STRAINS


def _told(folder: Path, strain: str, **more: object) -> Path:
    notes = {"model": f"layered vector wave, {STRAINS[strain]}, no calibration"}
    (folder / "results.json").write_text(json.dumps({"models": {"wave": {"notes": notes}}, **more}))
    return folder


def test_finite_strain_taken_by_itself_is_taken_back(make_run) -> None:
    run = read_run(_told(make_run(), "corrected"))
    assert run.large_press == "corrected"
    small = at_small_strain(run)
    assert (small.large_press, small.restarted) == ("linear", True)
    pressed = small.force > 0.01
    per_newton = small.wave[pressed] / small.force[pressed][:, None]
    np.testing.assert_allclose(per_newton, np.tile(per_newton[0], (pressed.sum(), 1)), rtol=1e-9)
    assert (per_newton[0] > 5e-4).all()


def test_a_wave_in_small_strain_or_with_effects_stays(make_run) -> None:
    linear = read_run(_told(make_run(name="a"), "linear"))
    assert at_small_strain(linear) is linear
    repaired = read_run(_told(make_run(name="b"), "corrected", effects=["strain_stiffening"]))
    assert at_small_strain(repaired) is repaired
