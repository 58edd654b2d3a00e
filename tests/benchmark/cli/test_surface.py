"""A bad surface file: exit code 2, what and where in one paragraph, no output."""

from pathlib import Path

import pyvista

SETTINGS = {"fem.geometry": "surface", "fem.surface_unit": "mm", "load.observations": "2"}


def test_a_surface_that_crosses_itself_is_refused(benchmark_cli, tmp_path: Path) -> None:
    ball = pyvista.Icosphere(radius=20.0, nsub=2)
    ball.merge(ball.translate((20.0, 0.0, 0.0)), merge_points=False).save(tmp_path / "two.stl")
    settings = {**SETTINGS, "fem.surface": str(tmp_path / "two.stl")}
    given = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    called = benchmark_cli("run", "skin-5N", *given, "--out", tmp_path / "out", "--quiet")
    assert called.code == 2
    assert called.out == ""
    said = " ".join(called.err.split())
    assert said.startswith("error: scenario skin-5N: surface ")
    assert "two.stl: crosses itself near (" in said
    assert "Traceback" not in said
    assert not (tmp_path / "out").exists()
