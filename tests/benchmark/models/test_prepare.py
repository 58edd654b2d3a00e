"""A picture of the faces: at the right vertices, of the right depth, and what it takes."""

import numpy as np
import pytest

from benchmark.files import load_scenario
from benchmark.models import frame_seconds, prepare, scenario_drive
from benchmark.models.prepare import FRAMES
from benchmark.models.wave_model import WaveModel
from benchmark.models.wave_parts import VERTICES, vertices

QUICK = {"load.observations": "4", "load.peak": "0.5 N", "wave.large_press": "linear"}


def test_vertices_end_at_four_radii_or_at_the_border() -> None:
    assert vertices(5e-3, 1.0)[[0, VERTICES // 2, -1]] == pytest.approx([-20e-3, 0.0, 20e-3])
    assert vertices(5e-3, 15e-3)[-1] == 15e-3


@pytest.mark.parametrize("window", ["auto", "30 mm"])
def test_a_picture_is_that_of_the_peak(window: str) -> None:
    scenario = load_scenario("skin-5N", {**QUICK, "wave.window": window})
    model, drive = WaveModel(scenario), scenario_drive(scenario)
    draw = model.picture(drive)
    assert draw is not None
    faces = draw()
    assert faces.shape == (len(scenario.tissue.layers), VERTICES, VERTICES)
    middle = VERTICES // 2
    np.testing.assert_allclose(faces[:, middle, middle], model.run(drive).max_deformation(), rtol=1e-3)


def test_a_frame_takes_the_median_of_its_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[int] = []
    scenario = load_scenario("skin-5N", QUICK)
    model, drive = WaveModel(scenario), scenario_drive(scenario)
    monkeypatch.setattr(model, "picture", lambda _: lambda: drawn.append(1))
    seconds = frame_seconds(model, drive)
    assert len(drawn) == FRAMES
    assert seconds is not None
    assert 0.0 < seconds < 1e-3


def test_models_without_tables_have_no_picture() -> None:
    scenario = load_scenario("skin-5N", {**QUICK, "fem.mesh": "coarse"})
    assert frame_seconds(prepare("fem", scenario), scenario_drive(scenario)) is None
    over_hole = load_scenario("skin-5N", {**QUICK, "support.kind": "hole", "support.hole_radius": "30 mm"})
    assert WaveModel(over_hole).picture(scenario_drive(over_hole)) is None
