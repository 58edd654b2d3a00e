"""A run without VTK: no field files and no picture, and the page says why."""

import sys
from pathlib import Path

import numpy as np

from benchmark.cli.app import main
from benchmark.models import FieldSnapshot
from benchmark.runs.fields import missing_vtk, write_fields
from benchmark.runs.output.pressed import draw_pressed


def test_fields_are_left_out_and_the_reason_is_said(monkeypatch, tmp_path: Path, capfd) -> None:
    assert missing_vtk() is None
    monkeypatch.setitem(sys.modules, "pyvista", None)
    snapshot = FieldSnapshot(0, np.zeros((4, 3)), np.arange(4)[None], 9, {}, {})
    assert write_fields(tmp_path / "fields", [snapshot]) == []
    assert list(tmp_path.iterdir()) == []
    assert "tissuebench[solids]" in draw_pressed(snapshot, (0.0, 0.0), 0.01).reason
    assert main(["run", "skin-5N", "--fields", "all"]) == 2
    assert "--fields all: surfaces and solids need VTK" in " ".join(capfd.readouterr().err.split())
