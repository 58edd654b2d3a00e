import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wavemodel import DiscTool, LayeredWave, NotCoveredError, WaveError, WaveLayer
from wavemodel.layered import body_options
from wavemodel.layered.body_options import contact_of
from wavemodel.layered.finite_strain.modal_body import StackBody, disc_modes, thickness_of
from wavemodel.layered.finite_strain.sliding_contact import RoundedTool
from wavemodel.layered.press import prepare
from wavemodel.layered.window import WaveDiscretisation

TOOL, ROUGH = DiscTool(5e-3, "rigid_frictionless", 1e-3), DiscTool(5e-3, "rigid_frictional", 1e-3, 0.3)
FORCE = 0.8


def contact_and_linear(layers, tool):
    press = prepare(layers, tool.at_first_touch, "bonded", WaveDiscretisation())
    body = StackBody(disc_modes(0.75 * press.field.domain.width, 12.0 / 5e-3), thickness_of(press.stack))
    contact = contact_of(press, tool, body)
    return contact, body.answer(contact.load)


@pytest.fixture(scope="module")
def touched(skin):
    """A contact and amplitudes at which a part of a millimetre has entered the tool."""
    contact, linear = contact_and_linear(skin(), TOOL)
    return contact, FORCE * linear + 2e-6 * np.random.default_rng(3).normal(size=linear.shape)


@pytest.mark.parametrize(
    ("radius", "height", "deep"),
    [
        (0.0, 1e-4, 1e-4),  # under the face
        (3e-3, -2e-4, -2e-4),
        (4.6e-3, 0.2e-3, 0.0),  # on the edge: 0.6, 0.8, 1 mm
        (4.3e-3, 0.6e-3, 0.5e-3),
        (4.9e-3, 3e-3, 0.1e-3),  # beside the wall
        (5.2e-3, 3e-3, -0.2e-3),
    ],
)
def test_how_deep_a_point_is_in_a_rounded_tool(radius, height, deep):
    found = RoundedTool(5e-3, 1e-3).entered(np.array([radius]), np.array([height]))
    assert found[0, 0] == pytest.approx(deep, abs=1e-12)


@given(st.floats(3e-3, 5.3e-3), st.floats(-4e-4, 8e-4))
def test_slopes_and_bends_are_those_of_the_depth(radius, height):
    tool, step = RoundedTool(5e-3, 1e-3), 1e-8
    assume(abs(radius - tool.face) > 1e-6)  # where the bend jumps
    at = tool.entered(np.array([radius]), np.array([height]))[:, 0]
    for way, (first, one, two) in (((1.0, 0.0), (1, 3, 4)), ((0.0, 1.0), (2, 4, 5))):
        forth, back = (
            tool.entered(np.array([radius + sign * step * way[0]]), np.array([height + sign * step * way[1]]))[:, 0]
            for sign in (1.0, -1.0)
        )
        np.testing.assert_allclose((forth[:3] - back[:3]) / (2.0 * step), at[[first, one, two]], rtol=1e-4, atol=1e-3)


def test_the_springs_carry_the_force(touched):
    contact, amplitude = touched
    points = contact.state(amplitude, FORCE).points
    assert points.push.size > 5
    assert points.push @ points.slope[1] == pytest.approx(FORCE, rel=1e-9)


def test_forces_are_the_slope_of_the_potential_and_their_change_that_of_the_forces(touched):
    contact, amplitude = touched
    change = np.random.default_rng(4).normal(size=amplitude.shape)
    here, step = contact.state(amplitude, FORCE), 1e-9
    forth, back = (contact.state(amplitude + sign * step * change, FORCE) for sign in (1.0, -1.0))
    assert (here.forces * change).sum() == pytest.approx((forth.potential - back.potential) / (2 * step), rel=1e-5)
    slope = (forth.forces - back.forces) / (2 * step)
    np.testing.assert_allclose(here.change(change), slope, atol=1e-3 * np.abs(slope).max())


def test_nothing_is_held_before_a_force(touched):
    contact, amplitude = touched
    rest = contact.state(amplitude, 0.0)
    assert not rest.forces.any()
    assert not rest.change(amplitude).any()
    assert rest.relieve(amplitude) is amplitude


@pytest.fixture
def coarse(monkeypatch):
    """A third of the resolution and no way on from the first force without equilibrium: a tenth of the time."""
    monkeypatch.setattr(body_options, "SLIDING", 20.0)
    monkeypatch.setattr(body_options, "SHORTEST_SLIDING", 1.0)


def test_a_small_press_is_that_of_the_flat_face(coarse):
    layer = [WaveLayer("gel", 20e-3, 1000.0, 5e4, 0.45)]
    wave = LayeredWave(layer, DiscTool(5e-3, "rigid_frictionless", 1e-3))
    flat = LayeredWave(layer, DiscTool(4e-3, "rigid_frictionless"), large_press="linear")
    assert wave.law.compliance == pytest.approx(flat.law.compliance, rel=1e-12)
    assert wave.law.large.followed > 0.2 * 20e-3


def test_a_sharper_edge_sinks_in_less_under_the_same_force(coarse):
    layer = [WaveLayer("gel", 20e-3, 1000.0, 5e4, 0.45)]
    depth = [
        float(LayeredWave(layer, DiscTool(5e-3, "rigid_frictionless", edge)).law.depth_at(np.array(0.5)))
        for edge in (0.25e-3, 1e-3, 3e-3)
    ]
    assert depth[0] < depth[1] < depth[2]


@pytest.mark.parametrize("edge", [0.0, 4.5e-3])
def test_a_sharp_edge_and_a_ball_are_refused(skin, edge):
    with pytest.raises(NotCoveredError, match="edge_radius"):
        LayeredWave(skin(), DiscTool(5e-3, "rigid_frictionless", edge), large_press="corrected")


@given(st.floats(3e-3, 5.2e-3), st.floats(-4e-4, 8e-4))
def test_the_way_along_the_profile_goes_as_its_slopes_say(radius, height):
    tool, step = RoundedTool(5e-3, 1e-3), 1e-8
    assume(abs(radius - tool.face) > 1e-6)
    at = tool.along(np.array([radius]), np.array([height]))[:, 0]
    for way, slope in (((step, 0.0), at[1]), ((0.0, step), at[2])):
        forth, back = (
            tool.along(np.array([radius + sign * way[0]]), np.array([height + sign * way[1]]))[0, 0]
            for sign in (1.0, -1.0)
        )
        assert (forth - back) / (2.0 * step) == pytest.approx(slope, rel=1e-5, abs=1e-5)


@pytest.fixture(scope="module")
def gripping(skin, touched):
    """A contact with friction, by what points push there, which they did not a moment ago."""
    contact, amplitude = contact_and_linear(skin(), ROUGH)[0], touched[1]
    return contact.after(0.97 * amplitude, FORCE).again(amplitude, FORCE), amplitude


def test_friction_is_no_more_than_its_share_of_the_push(gripping, touched):
    contact, amplitude = gripping
    pushed = touched[0].state(amplitude, FORCE).points.push
    dragged = np.abs(contact.state(amplitude, FORCE).points.push[pushed.size :])
    assert 0.0 < dragged.max() <= 0.3 * pushed.max() * 1.05
    assert 0.1 * 0.3 * pushed.sum() < dragged.sum() <= 0.3 * pushed.sum() * 1.05


def test_with_friction_the_forces_are_the_slope_of_the_potential(gripping):
    contact, amplitude = gripping
    change, step = np.random.default_rng(5).normal(size=amplitude.shape), 1e-10
    here = contact.state(amplitude, FORCE)
    forth, back = (contact.state(amplitude + sign * step * change, FORCE) for sign in (1.0, -1.0))
    assert (here.forces * change).sum() == pytest.approx((forth.potential - back.potential) / (2 * step), rel=1e-4)


def test_an_equilibrium_is_found_again_until_its_friction_stays(gripping):
    contact, amplitude = gripping
    for _ in range(5):
        later = contact.again(amplitude, FORCE)
        if later is None:
            return
        contact = later
    raise AssertionError("the friction does not settle")


def test_friction_holds_a_tool_up(coarse):
    layer = [WaveLayer("gel", 10e-3, 1000.0, 5e4, 0.45)]
    tools = [
        DiscTool(5e-3, "rigid_frictionless", 1e-3),
        DiscTool(5e-3, "rigid_frictional", 1e-3, 0.0),
        DiscTool(5e-3, "rigid_frictional", 1e-3, 0.2),
        DiscTool(5e-3, "rigid_frictional", 1e-3, 1.0),
        DiscTool(5e-3, "rigid_bonded"),
    ]
    free, none, some, much, stuck = (float(LayeredWave(layer, tool).law.depth_at(np.array(1.0))) for tool in tools)
    assert none == free
    assert free > 1.005 * some > 1.005 * much > stuck


def test_friction_belongs_to_a_tool_that_has_some():
    with pytest.raises(WaveError, match=r"friction = 0\.3 is not allowed with 'rigid_frictionless'"):
        DiscTool(5e-3, "rigid_frictionless", 1e-3, 0.3)


def test_a_ball_is_that_of_small_strain_where_it_may_be(skin):
    ball = LayeredWave(skin(), DiscTool(5e-3, "rigid_frictionless", 5e-3))
    flat = LayeredWave(skin(), DiscTool(5e-3, "rigid_frictionless"), large_press="linear")
    assert ball.law.large is None
    assert ball.law.compliance == flat.law.compliance
