"""FEBio's input files read and solved; the files are written here from the format's description."""

import numpy as np
import pytest
from scipy.optimize import brentq

from benchmark.errors import InputError
from benchmark.exchange.febio_input import read_febio_case

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SETS = {"bottom": (1, 3, 5, 7), "front": (1, 2, 5, 6), "left": (1, 2, 3, 4), "right": (5, 6, 7, 8), "last": (8,)}
NEO_HOOKEAN = '<material id="1" name="m" type="neo-Hookean"><E>3</E><v>0.3</v></material>'
MOONEY_RIVLIN = '<material id="1" name="m" type="Mooney-Rivlin"><c1>2</c1><c2>1</c2><k>30</k></material>'
OGDEN = '<material id="1" name="m" type="Ogden"><c1>6</c1><m1>3</m1><k>30</k></material>'
SLIDING = "".join(
    f'<bc type="fix" node_set="{name}"><dofs>{axis}</dofs></bc>'
    for name, axis in (("bottom", "z"), ("front", "y"), ("left", "x"))
)
PRESCRIBED = '<bc type="prescribe" node_set="right"><dof>x</dof><scale lc="1">-0.4</scale></bc>'
TIED = "".join(
    f'<bc type="linear constraint"><node>{n}</node><dof>x</dof>'
    "<child_dof><node>8</node><dof>x</dof><value>1</value></child_dof></bc>"
    for n in (5, 6, 7)
)
FORCE = (
    '<Loads><nodal_load type="nodal_load" node_set="right"><dof>x</dof><scale lc="1">-0.5</scale></nodal_load></Loads>'
)
MU, BULK = 6.0, 30.0


def text(material=NEO_HOOKEAN, boundary=SLIDING + PRESCRIBED, loads="", version="3.0", extra=""):
    """A unit cube of one element."""
    nodes = "".join(f'<node id="{n}">{x},{y},{z}</node>' for n, (x, y, z) in enumerate(CORNERS, start=1))
    sets = "".join(
        f'<NodeSet name="{name}">' + "".join(f'<n id="{n}"/>' for n in numbers) + "</NodeSet>"
        for name, numbers in SETS.items()
    )
    return (
        f'<?xml version="1.0" encoding="ISO-8859-1"?><febio_spec version="{version}"><Module type="solid"/>'
        "<Control><time_steps>5</time_steps><step_size>0.2</step_size></Control>"
        f"<Material>{material}</Material><Mesh><Nodes>{nodes}</Nodes>"
        f'<Elements type="hex8" name="part"><elem id="1">1,5,7,3,2,6,8,4</elem></Elements>{sets}</Mesh>'
        '<MeshDomains><SolidDomain name="part" mat="m"/></MeshDomains>'
        f"<Boundary>{boundary}</Boundary>{loads}{extra}"
        '<LoadData><load_controller id="1"><points><pt>0,0</pt><pt>1,1</pt></points></load_controller></LoadData>'
        "</febio_spec>"
    )


def read(folder, content):
    path = folder / "case.feb"
    path.write_text(content, encoding="latin-1")
    return read_febio_case(path)


def coupled(stretch, across):
    """Nominal stresses along and across of FEBio's neo-Hookean solid."""
    mu, lame = 3 / 2.6, 3 * 0.3 / (1.3 * 0.4)
    log = np.log(stretch * across**2)
    return (mu * stretch + (lame * log - mu) / stretch), (mu * across + (lame * log - mu) / across)


def uncoupled(stretch, across, slopes):
    """The same of an isochoric law with b_a, and FEBio's volumetric energy K/2 (ln J)^2."""
    volume = stretch * across**2
    b = slopes(np.array([stretch, across, across]) * volume ** (-1 / 3))
    nominal = (b - b.mean() + BULK * np.log(volume)) / [stretch, across, across]
    return nominal[0], nominal[1]


def mooney_rivlin(L):
    return 4.0 * L**2 - 2.0 / L**2


def ogden(L):
    return 2.0 * L**3


LAWS = [
    pytest.param(NEO_HOOKEAN, coupled, id="neo-Hookean"),
    pytest.param(MOONEY_RIVLIN, lambda s, a: uncoupled(s, a, mooney_rivlin), id="Mooney-Rivlin"),
    pytest.param(OGDEN, lambda s, a: uncoupled(s, a, ogden), id="Ogden"),
]


@pytest.mark.parametrize(("material", "stress"), LAWS)
def test_a_pressed_cube_bulges_as_in_closed_form(tmp_path, material, stress):
    across = brentq(lambda a: stress(0.6, a)[1], 0.9, 1.6, xtol=1e-15)
    assert read(tmp_path, text(material)).norm() == pytest.approx(np.sqrt(8) * (across - 1), rel=1e-10)


@pytest.mark.parametrize(("material", "stress"), LAWS)
def test_dead_forces_press_a_cube_as_in_closed_form(tmp_path, material, stress):
    def bulge(stretch):
        return brentq(lambda a: stress(stretch, a)[1], 0.9, 2.0, xtol=1e-15)

    stretch = brentq(lambda s: stress(s, bulge(s))[0] + 2.0, 0.3, 0.99, xtol=1e-14)
    found = read(tmp_path, text(material, SLIDING, FORCE)).solved()
    np.testing.assert_allclose(found[0, 4:], stretch - 1, rtol=1e-9)
    np.testing.assert_allclose(found[1, 2:4], bulge(stretch) - 1, rtol=1e-9)


def test_constrained_displacements_follow_and_are_not_counted(tmp_path):
    moved = '<bc type="prescribe" node_set="last"><dof>x</dof><scale lc="1">-0.4</scale></bc>'
    tied, plain = read(tmp_path, text(boundary=SLIDING + moved + TIED)), read(tmp_path, text())
    np.testing.assert_allclose(tied.solved(), plain.solved(), atol=1e-12)
    assert tied.body.free.sum() == plain.body.free.sum() == 8


def test_the_later_format_is_the_same(tmp_path):
    boundary = "".join(
        f'<bc type="zero displacement" node_set="{name}"><{axis}_dof>1</{axis}_dof></bc>'
        for name, axis in (("bottom", "z"), ("front", "y"), ("left", "x"))
    )
    boundary += '<bc type="prescribed displacement" node_set="right"><dof>x</dof><value lc="1">-0.4</value></bc>'
    later = text(boundary=boundary, version="4.0")
    for name, numbers in SETS.items():
        listed = "".join(f'<n id="{n}"/>' for n in numbers)
        later = later.replace(f'name="{name}">{listed}', f'name="{name}">{",".join(map(str, numbers))}')
    assert read(tmp_path, later).norm() == pytest.approx(read(tmp_path, text()).norm(), rel=1e-12)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("nothing", "no XML"),
        (text(version="2.5"), "3.0 or 4.0"),
        ("<!DOCTYPE a>" + text(), "document type"),
        (text(NEO_HOOKEAN.replace("neo-Hookean", "muscle material")), "muscle material is not read"),
        (text(NEO_HOOKEAN.replace("<v>0.3</v>", "")), "v is missing"),
        (text(NEO_HOOKEAN.replace("0.3", "0.6")), "poisson_ratio"),
        (text(NEO_HOOKEAN.replace("0.3", "much")), "'much': must be a number"),
        (text(boundary=SLIDING.replace("left", "nowhere")), "no NodeSet nowhere"),
        (text(boundary=SLIDING.replace(">z<", ">p<")), "'p': must be displacements"),
        (text(boundary='<bc type="rigid" node_set="left"/>'), "'rigid' is not read"),
        (text(loads='<Loads><surface_load type="pressure"/></Loads>'), "'pressure' is not read"),
        (text(extra="<Step><step/></Step>"), "Step: this section is not read"),
        (text().replace("7,3,2", "7,3,99"), "no node 99"),
        (text().replace("hex8", "penta6"), "penta6"),
    ],
)
def test_what_is_not_covered_is_refused_by_its_name(tmp_path, content, said):
    with pytest.raises(InputError, match=said):
        read(tmp_path, content)


def test_a_load_that_is_too_much_for_one_step_is_halved(tmp_path):
    def bulge(stretch):
        return brentq(lambda a: coupled(stretch, a)[1], 0.9, 4.0, xtol=1e-15)

    at_once = text(NEO_HOOKEAN, SLIDING, FORCE.replace("-0.5", "-2")).replace("<time_steps>5<", "<time_steps>1<")
    stretch = brentq(lambda s: coupled(s, bulge(s))[0] + 8.0, 0.1, 0.99, xtol=1e-14)
    found = read(tmp_path, at_once.replace("<step_size>0.2<", "<step_size>1<")).solved()
    np.testing.assert_allclose(found[0, 4:], stretch - 1, rtol=1e-9)


def test_a_body_that_is_pressed_flat_is_said(tmp_path):
    with pytest.raises(ArithmeticError, match="no equilibrium is found"):
        read(tmp_path, text(boundary=SLIDING + PRESCRIBED.replace("-0.4", "-1.5"))).solved()
