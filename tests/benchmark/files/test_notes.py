import pytest

from benchmark.files import load_scenario, scenario_notes


def notes(**overrides):
    return scenario_notes(load_scenario("skin-5N", {key.replace("__", "."): value for key, value in overrides.items()}))


def test_the_shipped_scenario_has_nothing_to_note():
    assert notes() == ()


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"dermis__hyperelastic": '{ law = "yeoh", c10 = "20 kPa" }'}, "layer dermis: its yeoh law begins"),
        ({"load__observations": "25"}, "25 observations, an odd number"),
        ({"load__hold": "3 s"}, "load.hold has no effect: the shape is triangle"),
        ({"support__hole_radius": "30 mm"}, "support.hole_radius has no effect: the support is bonded"),
        ({"physics__friction_coefficient": "0.3"}, "physics.friction_coefficient has no effect"),
    ],
)
def test_what_is_easily_misread_is_said(overrides, says):
    (note,) = notes(**overrides)
    assert note.startswith(says)


def test_a_law_that_agrees_with_the_moduli_is_not_noted():
    assert notes(dermis__hyperelastic='{ law = "yeoh", c10 = "0.162162 MPa", c20 = "1 kPa" }') == ()
