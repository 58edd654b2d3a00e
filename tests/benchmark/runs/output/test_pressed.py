"""The picture of the pressed tissue, and what is said where it cannot be drawn."""

import subprocess
from pathlib import Path

import numpy as np
import pytest

from benchmark.files import load_scenario
from benchmark.models import FieldSnapshot, prepare, scenario_drive
from benchmark.runs.output import pressed
from benchmark.runs.output.pressed import PACKAGES, Drawn, draw_pressed
from reports import Figure, Paragraph

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def snapshot() -> FieldSnapshot:
    """A coarse press of skin."""
    settings = {"fem.mesh": "coarse", "load.observations": "2", "load.shape": "ramp", "load.peak": "1 N"}
    scenario = load_scenario("skin-5N", settings)
    return prepare("fem", scenario).run(scenario_drive(scenario)).fields[-1]


class Record:
    """As much of a run's record as the picture needs."""

    def __init__(self, snapshot: FieldSnapshot):
        self.scenario = load_scenario("skin-5N")
        result = type("Result", (), {"fields": (snapshot,), "peak_step": snapshot.step})
        self.pair = type("Pair", (), {"fem": type("Run", (), {"result": result})})


def test_a_picture_shows_the_press(snapshot: FieldSnapshot, tmp_path: Path) -> None:
    drawn = draw_pressed(snapshot, (0.0, 0.0), 0.02)
    if not drawn.png:
        pytest.skip(f"no off-screen rendering here ({drawn.reason}); install {PACKAGES}")
    import pyvista

    assert drawn.png.startswith(PNG)
    (tmp_path / "pressed.png").write_bytes(drawn.png)
    pixels = np.asarray(pyvista.read(tmp_path / "pressed.png").active_scalars)[:, :3].astype(int)
    white = (pixels > 250).all(axis=1).mean()
    blue = ((pixels[:, 2] - pixels[:, 0]) > 60).mean()
    assert 0.3 < white < 0.95
    assert blue > 0.005


def test_a_missing_driver_names_the_packages(snapshot: FieldSnapshot, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(command, **_):
        return subprocess.CompletedProcess(command, -11, "", "cannot open libEGL.so\n")

    monkeypatch.setattr("benchmark.runs.output.pressed.subprocess.run", failing)
    record = Record(snapshot)
    block = pressed.pressed_picture(record, pressed.draw(record))
    assert isinstance(block, Paragraph)
    for word in ("exit code -11", "libEGL.so", *PACKAGES.split(), "fields/step_0002.vtu"):
        assert word in block.text


def test_the_report_has_the_picture_in_it(snapshot: FieldSnapshot, monkeypatch: pytest.MonkeyPatch) -> None:
    def drawing(command, **_):
        Path(command[4]).write_bytes(PNG)
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr("benchmark.runs.output.pressed.subprocess.run", drawing)
    record = Record(snapshot)
    block = pressed.pressed_picture(record, pressed.draw(record))
    assert isinstance(block, Figure)
    assert block.panels[0].data == PNG
    assert "without magnification" in block.caption


def test_without_fields_there_is_none(snapshot: FieldSnapshot) -> None:
    record = Record(snapshot)
    record.pair.fem.result = None
    assert pressed.draw(record) is None
    assert pressed.pressed_picture(record, None) is None


@pytest.mark.parametrize("drawn", [Drawn(PNG), Drawn(b"", "no driver"), None])
def test_it_is_kept_in_the_result_folder(drawn: Drawn | None, tmp_path: Path) -> None:
    pressed.write_drawn(tmp_path, drawn)
    assert pressed.read_drawn(tmp_path) == drawn
