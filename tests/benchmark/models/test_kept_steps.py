"""A FEM run that was stopped goes on from its kept steps, and nothing about them stops it."""

from pathlib import Path

import numpy as np
import pytest

from benchmark.files import Scenario, load_scenario
from benchmark.models import Keeping, prepare, scenario_drive
from benchmark.models import fem_steps as module


@pytest.fixture
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every step is kept."""
    monkeypatch.setattr(module, "LEAST_PAUSE", 0.0)
    monkeypatch.setattr(module, "SHARE", 1e9)


def stopped_after(step: int):
    def on_step(progress) -> None:
        if progress.step == step:
            raise KeyboardInterrupt

    return on_step


def run(scenario: Scenario, folder: Path, on_step=None):
    said: list[str] = []
    model = prepare("fem", scenario, keeping=Keeping(folder, said.append))
    drive = scenario_drive(scenario)
    return (model.run(drive) if on_step is None else model.run(drive, on_step)), said


def stop(scenario: Scenario, folder: Path, step: int) -> Path:
    with pytest.raises(KeyboardInterrupt):
        run(scenario, folder, stopped_after(step))
    return folder / "fem_steps.kept"


@pytest.mark.usefixtures("often")
def test_a_stopped_run_goes_on_and_says_so(scenario: Scenario, tmp_path: Path) -> None:
    stop(scenario, tmp_path / "kept", 4)
    resumed, said = run(scenario, tmp_path / "kept")
    whole = prepare("fem", scenario).run(scenario_drive(scenario))
    np.testing.assert_allclose(resumed.top_deflection, whole.top_deflection, rtol=1e-10)
    np.testing.assert_allclose(resumed.profile, whole.profile, rtol=1e-10)
    assert whole.resumed is None
    assert (resumed.resumed.steps, resumed.resumed.total) == (4, 6)
    assert resumed.resumed.seconds > 0.0
    assert said == ["the FEM goes on after step 4 of 6, kept by an unfinished run"]


@pytest.mark.usefixtures("often")
@pytest.mark.parametrize("what", ["scenario", "damage"])
def test_what_does_not_fit_is_said_and_left(scenario: Scenario, tmp_path: Path, what: str) -> None:
    path = stop(scenario, tmp_path, 3)
    if what == "scenario":
        scenario = scenario.model_copy(update={"load": scenario.load.model_copy(update={"peak": 0.4})})
    else:
        path.write_bytes(path.read_bytes()[:1000])
    found, said = run(scenario, tmp_path)
    assert found.complete
    assert found.resumed is None
    assert len(said) == 1
    assert said[0].startswith("the FEM starts afresh: checkpoint ")
    assert ("is of another problem" if what == "scenario" else "is damaged") in said[0]


@pytest.mark.usefixtures("often")
def test_a_folder_that_cannot_be_written_does_not_stop_a_run(scenario: Scenario, tmp_path: Path) -> None:
    (tmp_path / "kept").write_text("a file in its place")
    found, said = run(scenario, tmp_path / "kept")
    assert found.complete
    assert len(said) == 1
    assert said[0].startswith("the FEM's steps are not kept: ")


def test_a_short_run_keeps_nothing(scenario: Scenario, tmp_path: Path) -> None:
    found, said = run(scenario, tmp_path / "kept")
    assert found.complete
    assert said == []
    assert list(tmp_path.iterdir()) == []


def test_writing_takes_a_small_share_of_the_time(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Steps of 1 s and writings of 0.2 s, on a clock that is turned by hand."""
    now = [0.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])

    class Slow:
        path = tmp_path / "steps.npz"
        writings = 0

        def write(self, _) -> None:
            now[0] += 0.2
            self.writings += 1

    slow = Slow()
    kept = module.KeptSteps(slow, 1000, print)
    for _ in range(1000):
        now[0] += 1.0
        kept.write(None)
    assert 0.5 * module.SHARE < 0.2 * slow.writings / now[0] <= 1.1 * module.SHARE


def test_a_surface_keeps_its_mesh_in_the_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import pyvista

    import fem

    pyvista.Icosphere(radius=20.0, nsub=2).save(tmp_path / "ball.stl")
    settings = {"fem.geometry": "surface", "fem.surface": str(tmp_path / "ball.stl"), "fem.surface_unit": "mm"}
    asked = []
    monkeypatch.setattr(fem, "prepare", lambda _, mesh_file: asked.append(mesh_file))
    for name in ({}, settings):
        prepare("fem", load_scenario("skin-5N", name), keeping=Keeping(tmp_path / "kept", print))
    assert asked == [None, tmp_path / "kept" / "fem_mesh.kept"]
    assert (tmp_path / "kept").is_dir()
