"""An exported press for FEBio: well-formed, with bricks the right way round that fill the quarter. FEBio is not run."""

from itertools import pairwise

import numpy as np
import pytest
from defusedxml import ElementTree

from benchmark.errors import InputError
from benchmark.exchange import export_text
from benchmark.files import load_scenario

SMALL = {"load.observations": "5", "load.shape": "ramp", "fem.mesh": "coarse", "fem.radius": "20 mm"}
BONDED = SMALL | {"tool.contact": "rigid_bonded"}


def parsed(**settings: str):
    return ElementTree.fromstring(export_text(load_scenario("skin-5N", settings), "feb"))


def places(tree) -> np.ndarray:
    nodes = [[float(x) for x in node.text.split(",")] for node in tree.iter("node")]
    numbers = [int(node.get("id")) for node in tree.iter("node")]
    assert numbers == list(range(1, len(numbers) + 1)) or sorted(numbers) == list(range(1, len(numbers) + 1))
    out = np.empty((len(nodes) + 1, 3))
    out[numbers] = nodes
    return out


TETRAHEDRA = {
    "hex8": [(0, 1, 3, 4), (1, 2, 3, 6), (4, 6, 5, 1), (4, 7, 6, 3), (1, 3, 4, 6)],
    "penta6": [(0, 1, 2, 3), (1, 2, 3, 5), (1, 5, 3, 4)],
}


def volumes(tree, at: np.ndarray, kind: str) -> np.ndarray:
    """(n,) m3 of all elements of a kind, by tetrahedra whose corners keep the element's order."""
    texts = [one.text for part in tree.iter("Elements") if part.get("type") == kind for one in part]
    corners = at[np.array([[int(n) for n in text.split(",")] for text in texts])]
    edges = [corners[:, t[1:]] - corners[:, t[:1]] for t in map(list, TETRAHEDRA[kind])]
    return sum(np.linalg.det(edge) / 6.0 for edge in edges)


@pytest.mark.parametrize("tissue", ["skin_forearm", "ecoflex_00_30"])
def test_bricks_fill_the_quarter_and_stand_the_right_way_round(tissue: str) -> None:
    tree = parsed(**BONDED, tissue=tissue)
    at = places(tree)
    bricks, wedges = (volumes(tree, at, kind) for kind in ("hex8", "penta6"))
    assert bricks.min() > 0.0
    assert wedges.min() > 0.0
    height = -at[1:, 2].min()
    assert bricks.sum() + wedges.sum() == pytest.approx(0.25 * np.pi * 20e-3**2 * height, rel=2e-3)


def test_planes_of_symmetry_and_the_tool_hold_what_they_should() -> None:
    tree = parsed(**BONDED)
    at = places(tree)
    sets = {one.get("name"): [int(n) for n in one.text.split(",")] for one in tree.iter("NodeSet")}
    assert np.abs(at[sets["PLANE_X"], 0]).max() < 1e-12
    assert np.abs(at[sets["PLANE_Y"], 1]).max() < 1e-12
    assert np.hypot(*at[sets["TOOL"], :2].T).max() == pytest.approx(5e-3)
    assert {float(z) for z in at[sets["TOOL"], 2]} == {0.0}
    value = next(tree.iter("rigid_load")).find("value")
    assert float(value.text) == -0.25


def test_traction_adds_up_to_a_quarter_of_the_force() -> None:
    tree = parsed(**SMALL)
    at = places(tree)
    area = 0.0
    for facet in next(tree.iter("Surface")):
        corners = at[[int(n) for n in facet.text.split(",")]]
        edges = corners[1:] - corners[0]
        normals = [np.cross(a, b)[2] for a, b in pairwise(edges)]
        assert min(normals) > 0.0
        area += 0.5 * sum(normals)
    pressure = float(next(tree.iter("traction")).text.split(",")[2])
    assert area * pressure == pytest.approx(-0.25, rel=1e-9)


def test_laws_and_relaxation_are_in_its_own_terms() -> None:
    tree = parsed(
        **BONDED,
        **{
            "dermis.hyperelastic": '{law="gent", mu="0.3 MPa", jm=3.0}',
            "epidermis.hyperelastic": '{law="ogden", terms=[{mu="100 kPa", alpha=6.0}]}',
            "subcutaneous_fat.relaxation": '[{g=0.3, tau="2 s"}]',
        },
    )
    materials = {one.get("name"): one for one in tree.iter("material")}
    assert float(materials["MATERIAL_1"].find("c1").text) == pytest.approx(6e5)
    assert materials["MATERIAL_2"].get("type") == "Gent"
    fat = materials["MATERIAL_3"]
    assert [float(fat.find(name).text) for name in ("g0", "g1", "t1")] == pytest.approx([0.7, 0.3, 2.0])


def test_small_strain_is_refused() -> None:
    with pytest.raises(InputError, match="FEBio has finite strain only"):
        export_text(load_scenario("skin-5N", {"fem.kinematics": "linear"}), "feb")
