"""A user's model on a scenario: what it gets, what becomes of its answer, and what is refused."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import Drive, UncoveredError, prepare, scenario_drive

SPRINGS = """
import numpy as np
NAME = "springs"
def deform(layers, tool, support, time, force):
    share = np.arange(len(layers), 0, -1) / len(layers)
    return 1e-3 * np.outer(force, share)
"""
TENSOR = "type('Tensor', (), {'__array__': lambda self, *_, **__: [][0]})()"
"""An array of another library that refuses to become one of NumPy, as those on a graphics card do."""


def answer(scenario, file):
    return prepare("wave", scenario, own=file).run(scenario_drive(scenario))


def returning(expression: str, function: str = "deform") -> str:
    extra = "" if function == "deform" else SPRINGS
    more = {"profile": ", radii", "deform": "", "press": ""}[function]
    last = "depth" if function == "press" else "force"
    signature = f"{function}(layers, tool, support, time, {last}{more})"
    return f"import numpy as np\n{extra}\ndef {signature}:\n    return {expression}\n"


def test_deflections_come_through(scenario, user_file) -> None:
    found = answer(scenario, user_file(SPRINGS))
    drive = scenario_drive(scenario)
    np.testing.assert_allclose(found.top_deflection, 1e-3 * np.outer(drive.value, [1, 2 / 3, 1 / 3]))
    np.testing.assert_array_equal(found.depth, found.top_deflection[:, 0])
    assert found.layers == ("epidermis", "dermis", "subcutaneous_fat")
    assert found.unknowns is None
    assert np.isnan(found.profile).all()
    assert any("no profile" in warning for warning in found.warnings)


def test_the_function_gets_the_scenario_in_si(scenario, user_file) -> None:
    text = """
import numpy as np
def deform(layers, tool, support, time, force):
    first = layers[0]
    assert (first.name, first.thickness, first.density) == ("epidermis", 1e-4, 1150.0)
    assert (first.youngs_modulus, first.poisson_ratio, first.relaxation) == (1.5e6, 0.48, ())
    assert (tool.radius, tool.contact, tool.edge_radius) == (5e-3, "uniform_pressure", None)
    assert (support.kind, support.hole_radius) == ("bonded", None)
    assert time.shape == force.shape == (6,) and force.max() == 0.5
    force[:] = 0.0
    return np.zeros((6, 3))
"""
    drive = scenario_drive(scenario)
    prepare("wave", scenario, own=user_file(text)).run(drive)
    assert drive.value.max() == 0.5, "the user's function must not reach our arrays"


def test_the_function_is_told_of_the_law(user_file) -> None:
    yeoh = {"law": "yeoh", "c10": 8.4e3, "c20": 2.5e3, "c30": 0.0}
    given = 'law = "yeoh", c10 = "8.4 kPa", c20 = "2.5 kPa"'
    scenario = load_scenario("skin-5N", {"dermis.hyperelastic": f"{{ {given} }}", "load.observations": "6"})
    text = f"""
def deform(layers, tool, support, time, force):
    assert layers[0].hyperelastic == {{"law": "neo_hookean"}}
    assert layers[1].hyperelastic == {yeoh}
    return [[0.0] * 3] * 6
"""
    assert not answer(scenario, user_file(text)).top_deflection.any()


def test_a_data_frame_with_the_layers_downwards_will_do(scenario, user_file) -> None:
    frame = returning("__import__('pandas').DataFrame(np.ones((6, 3)), columns=[l.name for l in layers])")
    assert answer(scenario, user_file(frame)).top_deflection.shape == (6, 3)


def test_set_up_happens_once_and_is_handed_on(scenario, user_file) -> None:
    text = """
import numpy as np
calls = []
def set_up(layers, tool, support):
    calls.append(1)
    return 2e-3
def deform(layers, tool, support, time, force, prepared):
    assert len(calls) == 1
    return prepared * np.outer(force, np.ones(len(layers)))
"""
    model = prepare("wave", scenario, own=user_file(text))
    first, second = (model.run(scenario_drive(scenario)) for _ in range(2))
    assert first.top_deflection.max() == second.top_deflection.max() == pytest.approx(1e-3)


def test_a_profile_is_taken_at_the_peak(scenario, user_file) -> None:
    text = (
        SPRINGS
        + """
def profile(layers, tool, support, time, force, radii):
    assert force[-1] == force.max() and len(time) == 3
    return np.where(radii < 4 * tool.radius, 1e-3 * force[-1], np.nan) * np.array([[1], [2 / 3], [1 / 3]])
"""
    )
    found = answer(scenario, user_file(text))
    assert found.profile.shape == (3, found.profile_radii.size)
    assert found.profile[0, 0] == pytest.approx(5e-4)
    assert np.isnan(found.profile[:, -1]).all()
    assert not found.warnings


def test_depth_control_needs_press(user_file) -> None:
    scenario = load_scenario("skin-5N", {"load.control": "depth", "load.peak": "1 mm", "load.observations": "4"})
    with pytest.raises(UncoveredError, match="press"):
        prepare("wave", scenario, own=user_file(SPRINGS))
    found = answer(
        scenario, user_file(SPRINGS + "\ndef press(layers, tool, support, time, depth):\n    return 1e3 * depth\n")
    )
    np.testing.assert_allclose(found.force, [0.5, 1.0, 0.5, 0.0])
    np.testing.assert_allclose(found.depth, found.top_deflection[:, 0])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = 1\n", ["deform", "no such function", "time, force"]),
        ("deform = 5\n", ["deform", "no such function"]),
        (returning("np.zeros((6, 2))"), ["line 3", "deform", "(6, 2)", "(6, 3)", "one column a layer"]),
        (returning("np.zeros(6)"), ["(6,)", "(6, 3)"]),
        (returning("None"), ["NoneType"]),
        (returning(TENSOR), ["line 3", "a Tensor that NumPy cannot read (IndexError: ", "in m"]),
        (returning("[[1, 2], [3]]"), ["list", "(6, 3)"]),
        (returning("np.zeros((6, 3), complex)"), ["complex numbers; allowed: real numbers of shape (6, 3)", "in m"]),
        (returning("np.ma.masked_less(np.ones((6, 3)), 2.0)"), ["nan at [0, 0]", "finite"]),
        (
            returning("__import__('pandas').DataFrame(np.zeros((6, 3)), columns=[l.name for l in layers][::-1])"),
            ["line 3", "subcutaneous_fat, dermis, epidermis; allowed", "epidermis, dermis, subcutaneous_fat"],
        ),
        (returning("np.full((6, 3), np.nan)"), ["nan at [0, 0]", "finite"]),
        (returning("np.array([[0, 0, 0]] * 5 + [[0, np.inf, 0]])"), ["inf at [5, 1]"]),
        (returning("time / 0 + missing"), ["line 4", "NameError", "missing"]),
        (returning("np.zeros((3, 4))", "profile"), ["profile", "(3, 4)", "one column a radius"]),
        (returning("np.full((3, len(radii)), np.inf)", "profile"), ["profile", "inf"]),
    ],
)
def test_what_cannot_be_used_is_refused(scenario, user_file, text: str, words: list[str]) -> None:
    with pytest.raises(InputError) as caught, np.errstate(all="ignore"):
        answer(scenario, user_file(text))
    for word in ["my_model.py", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("named", "function"),
    [
        ("deform(layers, tool, support, force, time)", "deform"),
        ("deform(layers, support, tool, *_)", "deform"),
        ("profile(layers, tool, support, time, radii, force)", "profile"),
        ("press(layers, tool, support, _depth, _time)", "press"),
        ("press(layers, tool, support, time, force)", "press"),
        ("set_up(tool, layers, support)", "set_up"),
    ],
)
def test_arguments_named_in_another_order_are_refused(scenario, user_file, named: str, function: str) -> None:
    """Times were taken for forces without a word."""
    text = ("" if function == "deform" else SPRINGS) + f"\ndef {named}:\n    return np.zeros((6, 3))\n"
    with pytest.raises(InputError, match=rf"line \d+, {function}: its arguments are .*; they are given by place: "):
        answer(scenario, user_file(text))


def test_names_of_ones_own_for_the_arguments_are_taken(scenario, user_file) -> None:
    text = (
        "import numpy as np\ndef deform(bed, probe, _support, t, f, *, prepared=None):\n    return np.zeros((6, 3))\n"
    )
    assert not answer(scenario, user_file(text)).top_deflection.any()


def test_a_profile_that_is_not_the_deflection_on_the_axis_is_pointed_out(scenario, user_file) -> None:
    text = (
        SPRINGS
        + "\ndef profile(layers, tool, support, time, force, radii):\n    return {0} * np.ones((3, len(radii)))\n"
    )
    same = "deform(layers, tool, support, time, force)[-1][:, None]"
    assert not answer(scenario, user_file(text.format(same))).warnings
    for other in (f"1e3 * {same}", f"0.8 * {same}"):
        (warning,) = answer(scenario, user_file(text.format(other))).warnings
        assert "its profile of epidermis is" in warning
        assert "where its deform is 0.5 mm at the same load" in warning


def test_slips_of_sign_and_unit_are_pointed_out(scenario, user_file) -> None:
    upwards = answer(scenario, user_file(SPRINGS.replace("1e-3", "-1e-3")))
    assert any("out of the tissue" in warning for warning in upwards.warnings)
    millimetres = answer(scenario, user_file(SPRINGS.replace("1e-3", "1.0")))
    assert any("deflections are in m" in warning for warning in millimetres.warnings)


def test_options_the_function_is_not_told_of_are_declined(user_file) -> None:
    scenario = load_scenario("skin-5N", {"physics.pretension": "2 kPa"})
    with pytest.raises(UncoveredError, match="pretension"):
        prepare("wave", scenario, own=user_file(SPRINGS))


def test_the_drive_may_be_another_than_the_scenarios(scenario, user_file) -> None:
    drive = Drive("force", np.array([1.0, 2.0]), np.array([3.0, 4.0]))
    assert prepare("wave", scenario, own=user_file(SPRINGS)).run(drive).top_deflection.shape == (2, 3)
