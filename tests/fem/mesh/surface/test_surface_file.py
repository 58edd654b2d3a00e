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


OUT_OF_RANGE = {
    "far.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 99999999\n",
    "before.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 1 2\n",
    "far.ply": "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 99999999\n",
    "far.vtk": "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"
    "POLYGONS 1 4\n3 0 1 99999999\n",
}


@pytest.mark.parametrize("name", ["far.obj", "far.ply"])
def test_faces_that_name_points_which_are_not_there_end_no_process_of_ours(tmp_path, name):
    (tmp_path / name).write_text(OUT_OF_RANGE[name])
    with pytest.raises(fem.FemError, match=r"reader crashed; allowed: faces that name points|no triangles"):
        fem.read_surface(tmp_path / name, "mm")


@pytest.mark.slow
@pytest.mark.parametrize("name", OUT_OF_RANGE)
def test_each_format_with_faces_out_of_range(tmp_path, name):
    (tmp_path / name).write_text(OUT_OF_RANGE[name])
    with pytest.raises(fem.FemError, match=r"surface .*: "):
        fem.read_surface(tmp_path / name, "mm")


def test_points_that_are_no_numbers_are_refused(tmp_path, capfd):
    facet = "facet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    (tmp_path / "a.stl").write_text(f"solid a\n{facet}endsolid a\n")
    with pytest.raises(fem.FemError, match=r"no finite number|no triangles"):
        fem.read_surface(tmp_path / "a.stl", "mm")
    assert capfd.readouterr().err == ""
