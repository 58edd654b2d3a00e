"""Rigid surfaces of FEBio's input files that press a cube, beside its closed form; the files are written here."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from benchmark.errors import InputError
from benchmark.exchange.febio_input import read_febio_case

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SETS = {"bottom": (1, 3, 5, 7), "front": (1, 2, 5, 6), "left": (1, 2, 3, 4), "all": range(1, 17)}
NEO_HOOKEAN = '<material id="1" name="m" type="neo-Hookean"><E>3</E><v>0.3</v></material>'
MOONEY_RIVLIN = '<material id="1" name="m" type="Mooney-Rivlin"><c1>2</c1><c2>1</c2><k>30</k></material>'
BODY = '<material id="2" name="plate" type="rigid body"><density>1</density></material>'
FACE = '<Surface name="face"><quad4 id="1">5,7,8,6</quad4></Surface>'
UNDER = '<Surface name="under"><quad4 id="1">9,10,12,11</quad4></Surface>'
PAIR = '<SurfacePair name="pair"><primary>face</primary><secondary>under</secondary></SurfacePair>'
FIXED = "".join(f"<R{axis}_dof>{int(axis != 'x')}</R{axis}_dof>" for axis in "xyzuvw")
MOVED = (
    f'<Rigid><rigid_bc type="rigid_fixed"><rb>plate</rb>{FIXED}</rigid_bc><rigid_bc type="rigid_displacement">'
    '<rb>plate</rb><dof>x</dof><value lc="1">-0.3</value><relative>0</relative></rigid_bc></Rigid>'
)
BULK, MODULUS, DEPTH = 30.0, 9 * 30 * 6 / (3 * 30 + 6), 0.3


def wall(laugon="PENALTY", penalty=40, plane="-1,0,0,-1", tolerance=0.01):
    return (
        f'<Constraints><constraint type="rigid_wall" surface="face"><laugon>{laugon}</laugon><tolerance>{tolerance}'
        f'</tolerance><penalty>{penalty}</penalty><offset lc="1">0.3</offset><plane>{plane}</plane></constraint>'
        "</Constraints>"
    )


def sliding(extra="", penalty="<penalty>40</penalty>", kind="sliding-node-on-facet"):
    return f'{MOVED}<Contact><contact type="{kind}" surface_pair="pair">{penalty}{extra}</contact></Contact>'


def text(acting, material=NEO_HOOKEAN, reach=2.0):
    """A unit cube of one element, held by three faces, and over its face x = 1 a rigid plate from y = -1 to `reach`."""
    plate = [(x, y, z) for x in (1, 2) for y in (-1, reach) for z in (-1, 2)]
    nodes = "".join(f'<node id="{n}">{x},{y},{z}</node>' for n, (x, y, z) in enumerate(CORNERS + plate, start=1))
    sets = "".join(f'<NodeSet name="{name}">{",".join(map(str, ids))}</NodeSet>' for name, ids in SETS.items())
    held = "".join(
        f'<bc type="zero displacement" node_set="{name}"><{axis}_dof>1</{axis}_dof></bc>'
        for name, axis in (("bottom", "z"), ("front", "y"), ("left", "x"))
    )
    return (
        '<febio_spec version="4.0"><Control><time_steps>3</time_steps><step_size>0.5</step_size></Control>'
        f"<Material>{material}{BODY}</Material><Mesh><Nodes>{nodes}</Nodes>"
        '<Elements type="hex8" name="soft"><elem id="1">1,5,7,3,2,6,8,4</elem></Elements>'
        '<Elements type="hex8" name="hard"><elem id="2">9,13,15,11,10,14,16,12</elem></Elements>'
        f"{sets}{FACE}{UNDER}{PAIR}</Mesh>"
        '<MeshDomains><SolidDomain name="soft" mat="m"/><SolidDomain name="hard" mat="plate"/></MeshDomains>'
        f"<Boundary>{held}</Boundary>{acting if 'Rigid' in acting else MOVED + acting}"
        '<LoadData><load_controller id="1"><points><pt>0,0</pt><pt>1.5,1</pt></points></load_controller></LoadData>'
        "</febio_spec>"
    )


def read(folder, content):
    path = folder / "case.feb"
    path.write_text(content, encoding="latin-1")
    return read_febio_case(path)


def neo_hookean(stretch, across):
    mu, lame = 3 / 2.6, 3 * 0.3 / (1.3 * 0.4)
    log = np.log(stretch * across**2)
    return (mu * stretch + (lame * log - mu) / stretch), (mu * across + (lame * log - mu) / across)


def mooney_rivlin(stretch, across):
    volume = stretch * across**2
    L = np.array([stretch, across, across]) * volume ** (-1 / 3)
    b = 4.0 * L**2 - 2.0 / L**2
    nominal = (b - b.mean() + BULK * np.log(volume)) / [stretch, across, across]
    return nominal[0], nominal[1]


def pressed(stress, penalty, factor=1.0):
    """Stretches along and across of the cube whose nominal stress is the penalty times the penetration."""

    def bulge(stretch):
        return brentq(lambda a: stress(stretch, a)[1], 0.9, 2.0, xtol=1e-15)

    def missing(stretch):
        return stress(stretch, bulge(stretch))[0] + penalty * (DEPTH - factor * (1 - stretch))

    stretch = brentq(missing, 0.5, 0.999, xtol=1e-15)
    return stretch, bulge(stretch)


@pytest.mark.parametrize(
    ("content", "stress", "penalty", "factor"),
    [
        pytest.param(text(wall()), neo_hookean, 40.0, 1.0, id="wall"),
        pytest.param(text(wall(plane="-2,0,0,-2")), neo_hookean, 40.0, 4.0, id="wall of no unit vector"),
        pytest.param(text(sliding()), neo_hookean, 40.0, 1.0, id="plate"),
        pytest.param(text(sliding("<auto_penalty>1</auto_penalty>")), neo_hookean, 120.0, 1.0, id="automatic"),
        pytest.param(
            text(sliding("<auto_penalty>1</auto_penalty>"), MOONEY_RIVLIN),
            mooney_rivlin,
            40.0 * MODULUS,
            1.0,
            id="automatic of an uncoupled law",
        ),
    ],
)
def test_a_rigid_surface_presses_a_cube_as_in_closed_form(tmp_path, content, stress, penalty, factor):
    stretch, across = pressed(stress, penalty, factor)
    case = read(tmp_path, content)
    found = case.solved()
    np.testing.assert_allclose(found[0, 4:], stretch - 1, rtol=1e-9)
    np.testing.assert_allclose(found[1, 2:4], across - 1, rtol=1e-9)
    assert case.body.free.sum() == 12
    assert case.norm() == pytest.approx(2 * np.sqrt((stretch - 1) ** 2 + 2 * (across - 1) ** 2), rel=1e-9)


@pytest.mark.parametrize(
    "content",
    [
        pytest.param(text(wall("AUGLAG", tolerance=1e-9)), id="wall"),
        pytest.param(
            text(sliding("<laugon>AUGLAG</laugon><tolerance>1e-9</tolerance><maxaug>99</maxaug>")), id="plate"
        ),
    ],
)
def test_augmented_multipliers_leave_no_penetration(tmp_path, content):
    np.testing.assert_allclose(read(tmp_path, content).solved()[0, 4:], -DEPTH, atol=1e-9)


def test_few_augmentations_leave_some_and_the_exact_contact_none(tmp_path):
    few = read(tmp_path, text(sliding("<laugon>AUGLAG</laugon><tolerance>1e-9</tolerance><maxaug>1</maxaug>")))
    exact = replace(few.body, contacts=tuple(one.exact for one in few.body.contacts))
    assert few.solved()[0, 4] > -DEPTH + 1e-5
    np.testing.assert_allclose(exact.press(few.steps)[0, 4:], -DEPTH, atol=1e-6)


def test_nodes_beside_the_plate_go_free(tmp_path):
    found = read(tmp_path, text(sliding(penalty="<penalty>1e6</penalty>"), reach=0.5)).solved()
    np.testing.assert_allclose(found[0, 4:6], -DEPTH, atol=1e-5)
    assert (found[0, 6:] > -DEPTH + 0.05).all()


def test_a_body_that_nothing_touches_is_not_moved(tmp_path):
    assert read(tmp_path, text(MOVED.replace("-0.3", "0.3") + sliding().replace(MOVED, ""))).norm() == 0.0


AUGLAG = sliding("<laugon>AUGLAG</laugon>")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (text(sliding(kind="sliding-elastic")), "contact of type 'sliding-elastic' is not read"),
        (text(sliding(kind="sliding-facet-on-facet")), "'sliding-facet-on-facet' is not read"),
        (text(sliding("<fric_coeff>0.2</fric_coeff>")), "fric_coeff = 0.2: only 0"),
        (text(sliding("<two_pass>1</two_pass>")), "two_pass = 1: only 0"),
        (text(sliding("<laugon>LAGMULT</laugon>")), "'LAGMULT' is not read"),
        (text(AUGLAG), "tolerance = None: must be a number"),
        (text(sliding(penalty="")), "penalty: no value"),
        (text(sliding()).replace('pair="pair"', 'pair="none"'), "no SurfacePair none"),
        (text(sliding()).replace("<secondary>under", "<secondary>face"), "secondary surface must be of one rigid"),
        (text(sliding()).replace("<primary>face", "<primary>under"), "surface under must be of the body"),
        (text(sliding()).replace("9,10,12,11<", "9,10,12,13<"), "facet .* off its plane"),
        (text(sliding()).replace("9,10,12,11<", "9,10,12,99<"), "quad4 1: must be a quad4 or tri3 of nodes"),
        (text(sliding()).replace("<dof>x<", "<dof>Rv<"), "must move absolutely along x, y or z"),
        (text(sliding()).replace("<Ru_dof>1", "<Ru_dof>0"), "rigid body plate: must be held or moved"),
        (text(sliding()).replace("<Ry_dof>1", "<Ry_dof>0"), "rigid body plate: must be held or moved"),
        (text(sliding()).replace('"rigid_displacement"', '"rigid_rotation"'), "'rigid_rotation' is not read"),
        (text(sliding()).replace("<rb>plate", "<rb>m"), "m is no material of type rigid body"),
        (text(wall()).replace('"rigid_wall"', '"volume"'), "constraint None: type 'volume' is not read"),
        (text(sliding("<flip_primary>1</flip_primary>")), "flip_primary is not read"),
        (text(sliding('<tolerance lc="1">1</tolerance>')), "Contact: tolerance: a load curve of it is not read"),
        (text(sliding()).replace("<relative>0", "<active>0</active><relative>0"), "active is not read"),
        (text(sliding()).replace("<rb>plate</rb><Rx", "<rb>plate</rb><Rp_dof>1</Rp_dof><Rx"), "Rp_dof is not read"),
        (text(wall().replace("<plane>", "<minaug>1</minaug><plane>")), "minaug is not read"),
        (text(wall(plane="0,0,0,1")), "plane must be a normal and a distance"),
        (text(wall()).replace('surface="face"', 'surface="no"'), "no Surface no"),
        (text(wall()).replace("1,5,7,3,2,6,8,4<", "1,5,7,3,2,6,8,9<"), "node 9 is of a rigid body"),
    ],
)
def test_contact_that_is_not_covered_is_refused_by_its_name(tmp_path, content, said):
    with pytest.raises(InputError, match=said):
        read(tmp_path, content)
