"""Fields as VTU files: read by VTK as they were given, and whole or not at all."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmark.models import FieldSnapshot
from benchmark.runs.fields import save_grid

pyvista = pytest.importorskip("pyvista")


def snapshot(points: int) -> FieldSnapshot:
    draw = np.random.default_rng(4)
    return FieldSnapshot(
        step=0,
        points=draw.random((points, 3)),
        cells=np.arange(points // 4 * 4).reshape(-1, 4),
        cell_type=10,
        point_data={"displacement": draw.random((points, 3))},
        cell_data={"stress": draw.random(points // 4)},
    )


def test_vtk_reads_what_was_written(tmp_path: Path) -> None:
    fields = snapshot(40)
    save_grid(fields, tmp_path / "a.vtu")
    read = pyvista.read(tmp_path / "a.vtu")
    np.testing.assert_array_equal(read.points, fields.points)
    np.testing.assert_array_equal(read.point_data["displacement"], fields.point_data["displacement"])
    np.testing.assert_array_equal(read.cell_data["stress"], fields.cell_data["stress"])


LIMITED = """
import resource, signal, sys
sys.path.insert(0, {here!r})
from test_fields import save_grid, snapshot
from pathlib import Path
import pyvista
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))
try:
    save_grid(snapshot(4000), Path({path!r}))
except OSError as error:
    sys.exit(f"refused: {{error.errno}}")
"""


def test_where_there_is_no_room_it_is_refused_and_nothing_is_left(tmp_path: Path) -> None:
    """VTK's own writer leaves a cut file behind here."""
    code = LIMITED.format(here=str(Path(__file__).parent), path=str(tmp_path / "a.vtu"))
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert ended.stderr.strip() == "refused: 27"
    assert list(tmp_path.iterdir()) == []
