import numpy as np
import pytest
import pyvista

import fem


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "vtk"])
def test_each_format_gives_the_surface_in_metres(ball, tmp_path, suffix):
    path = tmp_path / f"ball.{suffix}"
    pyvista.PolyData.from_regular_faces(1e3 * ball.points, ball.triangles).save(path)
    surface = fem.read_surface(path, "mm")
    assert surface.triangles.shape == ball.triangles.shape
    assert surface.volume == pytest.approx(ball.volume, rel=1e-5)
    np.testing.assert_allclose(surface.size, ball.size, rtol=1e-5)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("body.step", b"x", "suffix '.step'"),
        ("empty.stl", b"", "is empty"),
        ("words.stl", b"no surface at all", "triangles|cannot be read"),
    ],
)
def test_what_is_no_surface_is_refused(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(fem.FemError, match=words):
        fem.read_surface(tmp_path / name, "mm")


def test_a_missing_file_and_an_unknown_unit_are_refused(tmp_path):
    with pytest.raises(fem.FemError, match="there is no such file"):
        fem.read_surface(tmp_path / "none.stl", "mm")
    with pytest.raises(fem.FemError, match="allowed are cm, inch, m, mm, um"):
        fem.read_surface(tmp_path / "none.stl", "furlong")
