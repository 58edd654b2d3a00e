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


SOLVER = "<solver {}><arc_length>{}</arc_length></solver></Control>"


def curved(words, steps):
    """The cube with words before its load curve's points, and as many steps of 0.2."""
    return text().replace("<points>", f"{words}<points>").replace("<time_steps>5<", f"<time_steps>{steps}<")


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
        (
            text(NEO_HOOKEAN.replace("0.3", "0.6")),
            r"material m \(id 1\): v = 0.6: Poisson's ratio must be above -1 and",
        ),
        (text(NEO_HOOKEAN.replace("0.3", "much")), "'much': must be a number"),
        (text(boundary=SLIDING.replace("left", "nowhere")), "no NodeSet nowhere"),
        (text(boundary=SLIDING.replace(">z<", ">p<")), "'p': must be displacements"),
        (text(boundary='<bc type="rigid" node_set="left"/>'), "'rigid' is not read"),
        (text(loads='<Loads><surface_load type="pressure"/></Loads>'), "'pressure' is not read"),
        (text(extra="<Step><step/></Step>"), "Step: this section is not read"),
        (text().replace("7,3,2", "7,3,99"), "no node 99"),
        (text().replace("hex8", "penta6"), "penta6"),
        (curved("<extend>REPEAT</extend>", 10), "load_controller 1: extend REPEAT is not read"),
        (curved("<extend>REPEAT OFFSET</extend>", 10), "extend REPEAT OFFSET is not read"),
        (curved("<interpolate>STEP</interpolate>", 3), "load_controller 1: interpolate STEP is not read"),
        (curved("<interpolate>SMOOTH</interpolate>", 3), "interpolate SMOOTH is not read"),
        (text().replace('r id="1"', 'r id="1" type="math"'), "load_controller 1: type 'math' is not read"),
        (text().replace("<pt>1,1</pt>", "<pt>1,1</pt><pt>1,0</pt>"), "two points at one time"),
        (text().replace("<points>", "<relative/><points>"), "load_controller 1: relative is not read"),
        (text().replace("<time_steps>", "<analysis>DYNAMIC</analysis><time_steps>"), "analysis 'DYNAMIC' is not read"),
        (text().replace("<time_steps>", '<analysis type="dynamic"/><time_steps>'), "analysis 'dynamic' is not read"),
        (text().replace("<time_steps>", "<final_time>3</final_time><time_steps>"), "Control: final_time is not read"),
        (text().replace("<time_steps>5<", "<time_steps>0<"), "time_steps = 0"),
        (text().replace("</Control>", SOLVER.format('type="explicit-solid"', 0)), "'explicit-solid' is not read"),
        (text().replace("</Control>", SOLVER.format("", 1)), "arc_length is not read"),
        (text().replace('type="solid"', 'type="biphasic"'), "Module: type 'biphasic' is not read"),
        (text(extra="<Globals><Variables/></Globals>"), "Globals: Variables is not read"),
        (text(extra="<MeshData><ElementData/></MeshData>"), "MeshData: ElementData is not read"),
        (text(extra="<Include>more.feb</Include>"), "Include: this section is not read"),
        (text(extra="<Boundary/>"), "Boundary: a section must be there once"),
        (text(extra='<Loads from="more.feb"/>'), "Loads: a section must be there once, and whole"),
        (text(boundary=SLIDING + "<rigid/>"), "Boundary: rigid is not read"),
        (text(NEO_HOOKEAN.replace("<E>", '<E lc="1">')), "Material: E: a load curve of it is not read"),
        (text(NEO_HOOKEAN.replace("<E>", "<mat_axis/><E>")), r"material m \(id 1\): mat_axis is not read"),
        (text().replace("<SolidDomain", "<ShellDomain/><SolidDomain"), "MeshDomains: ShellDomain is not read"),
        (text().replace("<SolidDomain", '<SolidDomain type="udg-hex"'), "SolidDomain part: type 'udg-hex' is not read"),
        (text().replace("<SolidDomain", '<SolidDomain elem_type="HEX8G1"'), "elem_type 'HEX8G1' is not read"),
        (
            text(boundary=SLIDING + PRESCRIBED.replace("</bc>", "<shell_bottom>1</shell_bottom></bc>")),
            "shell_bottom is",
        ),
        (text(loads=FORCE.replace("</nodal", "<relative>1</relative></nodal")), "relative = 1: only 0 is read"),
        (text(loads=FORCE.replace("</nodal", "<shell_bottom/></nodal")), "nodal_load None: shell_bottom is not read"),
        (text(boundary=SLIDING + TIED.replace("</bc>", "<offset>1</offset></bc>")), "offset = 1: only 0 is read"),
        (text(boundary=SLIDING + TIED.replace("<value>", '<value lc="1">')), "linear constraint: a load curve"),
        (text(boundary=SLIDING + TIED.replace("<value>", "<scale/><value>")), "child_dof: scale is not read"),
    ],
)
def test_what_is_not_covered_is_refused_by_its_name(tmp_path, content, said):
    with pytest.raises(InputError, match=said):
        read(tmp_path, content)


@pytest.mark.parametrize(
    ("words", "steps", "share"),
    [
        ("", 3, 0.6),
        ("", 6, 1.0),
        ("<interpolate>LINEAR</interpolate><extend>CONSTANT</extend>", 6, 1.0),
        ("<extend>EXTRAPOLATE</extend>", 6, 1.2),
        ("<interpolate>STEP</interpolate><extend>REPEAT</extend>", 5, 1.0),  # at its last point no word acts
    ],
)
def test_a_load_curve_is_read_at_the_end(tmp_path, words, steps, share):
    found = read(tmp_path, curved(words, steps)).solved()
    np.testing.assert_allclose(found[0, 4:], -0.4 * share, rtol=1e-12)


def test_before_its_first_point_a_curve_is_that_point_or_extrapolated(tmp_path):
    for words, share in (("", 1.0), ("<extend>EXTRAPOLATE</extend>", 0.6)):
        late = curved(words, 3).replace("<pt>0,0</pt><pt>1,1</pt>", "<pt>1,1</pt><pt>2,2</pt>")
        np.testing.assert_allclose(read(tmp_path, late).solved()[0, 4:], -0.4 * share, rtol=1e-12)


def test_what_does_not_act_is_passed_over(tmp_path):
    more = "<Globals><Constants><T>0</T></Constants></Globals><Output><plotfile/></Output>"
    content = text(NEO_HOOKEAN.replace("<E>", "<density>1</density><E>"), extra=more).replace(
        "</Control>",
        "<analysis>STATIC</analysis><adaptor_re_solve>1</adaptor_re_solve>"
        '<time_stepper><dtmax lc="1">1</dtmax></time_stepper>'
        '<solver type="solid"><dtol>0.1</dtol></solver></Control>',
    )
    content = content.replace("<SolidDomain", '<SolidDomain type="elastic-solid" elem_type="HEX8G8"')
    assert read(tmp_path, content).norm() == read(tmp_path, text()).norm()


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


@pytest.mark.parametrize(
    ("kind", "constants", "words"),
    [
        ("neo-Hookean", "<E>-3</E><v>0.3</v>", "E = -3: Young's modulus must be above 0"),
        ("Ogden", "<c1>6</c1><m1>0</m1><k>30</k>", "m1 = 0 with c1 = 6: must not be zero"),
        ("Ogden", "<c1>6</c1><m1>3</m1><c2>2</c2><m2>0</m2><k>30</k>", "m2 = 0 with c2 = 2: must not be zero"),
        ("Ogden", "<c1>6</c1><m1>-1e5</m1><k>30</k>", r"m1 = -100000: must be -1000 to 1000"),
        ("Ogden", "<c1>6</c1><m1>3</m1><c2>-6</c2><m2>3</m2><k>30</k>", "half the sum of c1, c2, ... = 0: .* above 0"),
        ("Mooney-Rivlin", "<c1>-2</c1><c2>1</c2><k>2</k>", r"2 \(c1 \+ c2\) = -2: .* must be above 0"),
        ("Mooney-Rivlin", "<c1>0</c1><c2>0</c2><k>0</k>", r"2 \(c1 \+ c2\) = 0: .* must be above 0"),
        (
            "Mooney-Rivlin",
            "<c1>2</c1><c2>1</c2><k>-2</k>",
            "k = -2: the bulk modulus must be above 0 and at most 29998",
        ),
        ("Ogden", "<c1>6</c1><m1>3</m1><k>0</k>", "k = 0: the bulk modulus must be above 0 and at most 14999"),
    ],
)
def test_constants_without_a_stiffness_are_refused_by_their_names(tmp_path, kind, constants, words):
    with pytest.raises(InputError, match=rf"case.feb: material m \(id 1\): {words}"):
        read(tmp_path, text(f'<material id="1" name="m" type="{kind}">{constants}</material>'))


def test_a_node_of_no_element_stays_where_it_is(tmp_path):
    """It keeps its number; nothing acts on it, and it is not counted."""
    stray = text(boundary="", loads=FORCE).replace("<Nodes>", '<Nodes><node id="99">5,5,5</node>')
    stray = stray.replace("<Boundary>", f"<Boundary>{SLIDING}").replace(
        '<NodeSet name="right">', '<NodeSet name="right"><n id="99"/>'
    )
    case, plain = read(tmp_path, stray), read(tmp_path, text(boundary=SLIDING, loads=FORCE))
    np.testing.assert_allclose(case.solved(), np.insert(plain.solved(), 0, 0.0, axis=1), atol=1e-14)
    assert case.norm() == pytest.approx(plain.norm())
