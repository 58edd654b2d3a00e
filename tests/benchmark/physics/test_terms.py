"""Each effect changes what it should, by hand-checkable amounts."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery.base.base_shape import Shape, ShapedTable
from benchmark.physics import SLUGS, Motion, TrialContext, catalogue
from benchmark.physics.body.pretension import added_stiffness
from benchmark.physics.effect import LowerFaceMotion, PressHistory
from benchmark.response import ElasticTable, SeparableField, SetupDerivative, TrialPipeline
from benchmark.response.setup_change import RADIUS
from wavemodel import DiscTool, LayeredWave, WaveLayer

STIFFNESS = 200.0
PEAK = 5e-3
REST = np.array([[6e-3, 0.0], [0.0, 6e-3], [-6e-3, 0.0], [0.0, -6e-3]])
AROUND = TrialContext(5e-3, 10e-3, PEAK, STIFFNESS * PEAK, 10.0, 6e-3, REST)
BY_SLUG = {effect.slug: effect for effect in catalogue()}


TENSE = 1e3
ADDED = added_stiffness(TENSE, AROUND)
SLIP = {"slip_force": 0.5, "slip_share": 0.0, "marker_share": 1.0, "return_share": 0.0}


def linear_table() -> ShapedTable:
    """F = k d; the lower face moves outwards by a tenth of the depth at all radii and sinks by half of it."""
    depth = np.linspace(0.0, 2 * PEAK, 200)
    flat = np.ones((1, 2))
    outward, sink, none = (SeparableField(share * depth[None], flat) for share in (0.1, 0.5, 0.0))
    by = {RADIUS: SetupDerivative(np.zeros((2, depth.size)), (none,))}
    return ShapedTable(ElasticTable(depth, STIFFNESS * depth, np.array([0.0, 0.05]), outward, sink, by), Shape(), PEAK)


def press(hold: float = 2.0) -> Motion:
    """From -1 mm to 5 mm at 2 mm/s, hold, back, twice; 50 rows a second."""
    knots = [(0.0, -1e-3)]
    for _ in range(2):
        for target in (PEAK, PEAK, -1e-3):
            t, d = knots[-1]
            knots.append((t + (abs(target - d) / 2e-3 or hold), target))
    time = np.arange(0.0, knots[-1][0], 0.02)
    depth = np.interp(time, *np.array(knots).T)
    return Motion(time, depth, np.zeros_like(time))


def readings(motion: Motion, **values):
    effects = tuple(BY_SLUG[slug] for slug in values)
    pipeline = TrialPipeline(AROUND, effects)
    return pipeline.readings(linear_table(), values, motion)


MOTION = press()
PLAIN = readings(MOTION)
DEEP = np.flatnonzero(MOTION.depth > PEAK - 1e-9)
AIR = MOTION.depth < -0.2e-3


def test_the_plain_base_is_its_law():
    assert PLAIN.force == pytest.approx(STIFFNESS * np.maximum(MOTION.depth, 0.0), abs=1e-9)
    moved = np.hypot(*np.moveaxis(PLAIN.markers, -1, 0)) - 6e-3
    assert moved[:, 0] == pytest.approx(0.1 * np.maximum(MOTION.depth, 0.0), abs=1e-9)


@pytest.mark.parametrize("slug", SLUGS)
def test_every_description_is_complete_and_its_starts_change_a_reading(slug):
    effect = BY_SLUG[slug]
    description = effect.description
    assert description.slug == slug
    assert description.sentence.endswith(".")
    assert description.source
    assert effect.amplitude in effect.names
    for parameter in description.parameters:
        assert parameter.low < parameter.high
        assert all(parameter.low <= start <= parameter.high for start in parameter.start)
        assert parameter.low > 0.0 or not parameter.logarithmic
    motion = replace(MOTION, acceleration=np.gradient(np.gradient(MOTION.depth, 0.02), 0.02))
    for values in effect.first_values(AROUND):
        made = readings(motion, **{slug: values})
        changed = np.abs(made.force - PLAIN.force).max() / 1.0 + np.abs(made.markers - PLAIN.markers).max() / PEAK
        assert changed > 1e-4, values
        if effect.needs_markers:
            assert made.force == pytest.approx(PLAIN.force)


def test_stiffening_multiplies_the_force():
    made = readings(MOTION, strain_stiffening={"b_1": 0.4, "b_2": 0.0})
    assert made.force[DEEP] == pytest.approx(STIFFNESS * PEAK * 1.2)


def test_relaxation_decays_in_the_hold_to_its_long_term():
    motion = press(hold=60.0)
    made = readings(motion, viscoelastic_relaxation={"g_1": 0.3, "tau_1": 0.5})
    last = np.flatnonzero(motion.depth > PEAK - 1e-9)[-2]
    assert made.force[last] == pytest.approx(0.7 * STIFFNESS * PEAK, rel=1e-4)


@pytest.mark.parametrize("terms", [2, 3])
def test_a_further_term_fades_what_those_before_leave(terms):
    motion = press(hold=60.0)
    form = BY_SLUG["viscoelastic_relaxation"].forms[terms - 1]
    values = {"g_1": 0.2, "tau_1": 0.2, "g_2": 0.3, "tau_2": 2.0, "g_3": 0.4, "tau_3": 1.0}
    made = TrialPipeline(AROUND, (form,)).readings(
        linear_table(), {form.slug: {name: values[name] for name in form.names}}, motion
    )
    last = np.flatnonzero(motion.depth > PEAK - 1e-9)[-2]
    left = 0.8 * 0.7 * (0.6 if terms == 3 else 1.0)
    assert made.force[last] == pytest.approx(left * STIFFNESS * PEAK, rel=1e-3)


def test_damping_adds_with_speed_and_not_in_the_hold():
    made = readings(MOTION, viscous_damping={"damping_time": 0.1, "drag": 0.0, "power": 1.0})
    rising = (MOTION.depth > 1e-3) & (MOTION.depth < 4e-3) & (np.gradient(MOTION.depth) > 0.0)
    assert (made.force - PLAIN.force)[rising] == pytest.approx(0.1 * STIFFNESS * 2e-3)
    assert (made.force - PLAIN.force)[DEEP[2:5]] == pytest.approx(0.0, abs=1e-9)


def test_drag_is_the_same_at_all_depths_once_the_contact_has_formed():
    made = readings(MOTION, viscous_damping={"damping_time": 0.0, "drag": 20.0, "power": 0.5})
    rising = (MOTION.depth > 1e-3) & (MOTION.depth < 4e-3) & (np.gradient(MOTION.depth) > 0.0)
    assert (made.force - PLAIN.force)[rising] == pytest.approx(20.0 * 1e-3 * np.sqrt(2.0))
    assert made.force[AIR] == pytest.approx(0.0)


def test_drag_grows_with_the_force_as_in_hunt_and_crossleys_contact():
    growing = {"damping_time": 0.0, "drag": 0.0, "drag_growth": 25.0, "power": 0.5}
    made = readings(MOTION, viscous_damping=growing)
    rate = np.gradient(MOTION.depth, MOTION.time) / 1e-3
    inner = (MOTION.depth > 1e-3) & (MOTION.depth < 4e-3)
    added = 25.0 * 1e-3 * PLAIN.force * np.sign(rate) * np.sqrt(np.abs(rate))
    assert (made.force - PLAIN.force)[inner] == pytest.approx(added[inner])
    without = readings(MOTION, viscous_damping={"damping_time": 0.0, "drag": 0.0, "power": 0.5})
    assert without.force == pytest.approx(PLAIN.force)  # an older model file has no growth


def test_stiffening_in_its_richer_form_is_fungs_exponential():
    richer = BY_SLUG["strain_stiffening"].richer
    values = {richer.slug: {"b_1": 0.5, "b_2": 2.0, "b_3": 3.0}}
    made = TrialPipeline(AROUND, (richer,)).readings(linear_table(), values, MOTION)
    x = np.maximum(MOTION.depth, 0.0) / AROUND.thickness
    factor = 1.0 + (0.5 * x + 2.0 * x**2) * np.exp(3.0 * x**2)
    assert made.force == pytest.approx(PLAIN.force * factor, rel=1e-9)


def test_softening_spares_the_first_loading():
    made = readings(MOTION, stress_softening={"softening": 0.2, "softening_width": 0.5})
    first = np.arange(MOTION.time.size) < DEEP[0]
    second = (MOTION.time > 8.5) & (MOTION.depth > 1e-3) & (MOTION.depth < 4e-3)
    assert made.force[first] == pytest.approx(PLAIN.force[first], abs=1e-9)
    assert (made.force[second] < 0.95 * PLAIN.force[second]).all()


def test_set_leaves_the_surface_and_the_markers():
    made = readings(MOTION, permanent_set={"permanent_set": 0.1, "permanent_set_onset": 0.0, "marker_share": 1.0})
    after = AIR & (MOTION.time > 5.0)
    assert made.force[after] == pytest.approx(0.0, abs=1e-12)
    assert made.markers[after, 0, 0] == pytest.approx(6e-3 + 0.1 * 0.1 * PEAK)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_late_set_moves_the_markers_as_it_sinks(share):
    values = {"permanent_set": 0.2, "permanent_set_onset": 0.0, "marker_share": share, "permanent_set_delay": 1.0}
    made = readings(MOTION, permanent_set=values)
    after = AIR & (MOTION.time > 12.0)
    assert np.ptp(made.markers[after, 0, 0]) < 1e-12
    assert made.markers[after, 0, 0].max() - 6e-3 == pytest.approx(0.1 * share * 0.2 * PEAK, rel=0.3)
    sinks = np.diff(made.force[DEEP]) / STIFFNESS
    np.testing.assert_allclose(np.diff(made.markers[DEEP, 0, 0]), 0.1 * (1.0 - share) * sinks, atol=1e-9)
    assert sinks.min() < -1e-5


def test_drainage_goes_faster_under_a_smaller_tool():
    values = {"poroelastic_drainage": {"drainage_share": 0.4, "drainage_diffusivity": 5e-6}}
    effect = BY_SLUG["poroelastic_drainage"]

    def left(radius: float) -> float:
        pipeline = TrialPipeline(replace(AROUND, tool_radius=radius), (effect,))
        return float(pipeline.readings(linear_table(), values, MOTION).force[DEEP[50]])

    assert left(2.5e-3) < left(5e-3) < PLAIN.force[DEEP[50]]


def test_drainage_follows_the_contact_of_a_ball_and_not_of_a_bonded_tool():
    values = {"poroelastic_drainage": {"drainage_share": 0.4, "drainage_diffusivity": 5e-7}}

    def left(contact: str, depth: float) -> float:
        around = replace(AROUND, contact=contact, edge_radius=AROUND.tool_radius)
        press = Motion(np.arange(0.0, 8.0, 0.02), np.full(400, depth), np.zeros(400))
        force = TrialPipeline(around, (BY_SLUG["poroelastic_drainage"],)).readings(linear_table(), values, press).force
        return float(force[-1] / force[0])

    assert left("rigid_frictionless", 1e-3) < 0.97 * left("rigid_frictionless", 4e-3)
    assert left("rigid_bonded", 1e-3) == pytest.approx(left("rigid_bonded", 4e-3), rel=1e-9)


def test_anisotropy_moves_x_and_y_apart():
    made = readings(MOTION, anisotropy={"log_ratio": 0.2})
    x, y = made.markers[DEEP[0], 0, 0] - 6e-3, made.markers[DEEP[0], 1, 1] - 6e-3
    assert x / y == pytest.approx(np.exp(-0.1), rel=1e-6)


def test_pretension_adds_its_stiffness():
    made = readings(MOTION, pretension={"pretension": TENSE, "field": 0.5})
    assert (made.force - PLAIN.force)[DEEP] == pytest.approx(ADDED * PEAK)
    assert made.markers == pytest.approx(PLAIN.markers)


@pytest.mark.parametrize(("share", "field", "passed"), [(0.3, 1.0, 0.7), (0.3, 2.0, 0.4), (0.8, 2.0, 0.0)])
def test_a_tension_changes_the_lower_face_by_up_to_twice_its_share_and_never_by_more_than_all(share, field, passed):
    around = TrialContext(5e-3, 4e-3, 2e-3, 1.0, 10.0, hole_radius=30e-3)
    depth, force, none = np.array([0.0, 2e-3]), np.array([0.0, 1.0]), np.zeros(2)
    press = PressHistory(none, depth, depth, force, force, depth > 0.0)
    values = {"pretension": share / 2e-3 / added_stiffness(1.0, around), "field": field}
    face = BY_SLUG["pretension"].lower_face(values, LowerFaceMotion(depth, np.ones(2)), press, around)
    np.testing.assert_allclose(face.passed, [1.0, passed], atol=1e-9)


def test_pretension_over_a_hole_moves_the_lower_face_as_a_membrane_does():
    around = replace(AROUND, hole_radius=30e-3)
    pipeline = TrialPipeline(around, (BY_SLUG["pretension"],))
    made = pipeline.readings(
        linear_table(), {"pretension": {"pretension": 50.0 / added_stiffness(1.0, around), "field": 1.0}}, MOTION
    )
    share = 50.0 / (STIFFNESS + 50.0)
    membrane = 0.5 * 10e-3 * PEAK / (6e-3 * np.log(6.0))
    moved = made.markers[DEEP[0], 0, 0] - 6e-3
    assert moved == pytest.approx((1.0 - share) * 0.1 * PEAK + share * membrane, rel=1e-3)


def test_a_membrane_under_tension_over_a_hole_has_its_stiffness():
    around = replace(AROUND, hole_radius=30e-3)
    assert added_stiffness(2e3, around) == pytest.approx(2.0 * np.pi * 2e3 * 10e-3 / np.log(6.0))


def test_a_base_under_tension_is_as_stiff_as_its_layers_are_in_the_wave():
    layers = (WaveLayer("skin", 1e-3, 1000.0, 5e5, 0.48), WaveLayer("fat", 9e-3, 1000.0, 3e4, 0.48))
    around = replace(AROUND, layers=layers, contact="uniform_pressure")
    tool, depth = DiscTool(5e-3, "uniform_pressure"), np.array([2e-3])
    bare, tense = (
        LayeredWave(layers, tool, support="bonded", pretension=s, large_press="linear").law(depth) for s in (None, 5e3)
    )
    assert added_stiffness(5e3, around) * 2e-3 == pytest.approx(float((tense - bare)[0]), rel=5e-3)


def test_slip_can_show_in_the_markers_alone():
    made = readings(MOTION, interface_slip=SLIP)
    assert made.force == pytest.approx(PLAIN.force)
    assert made.markers[DEEP[0], 0, 0] - 6e-3 == pytest.approx(0.5 * 0.1 * PEAK, rel=1e-6)


def test_the_floor_is_met_at_its_depth():
    made = readings(MOTION, bottoming_out={"floor_depth": 4e-3, "floor_stiffness": 100.0, "power": 1.0})
    assert (made.force - PLAIN.force)[DEEP] == pytest.approx(0.1)
    assert made.force[MOTION.depth < 4e-3] == pytest.approx(PLAIN.force[MOTION.depth < 4e-3])


def test_friction_changes_sign_on_reversal():
    made = readings(MOTION, dry_friction={"friction_force": 0.05, "friction_length": 1e-4, "friction_share": 0.0})
    extra = made.force - PLAIN.force
    rate = np.gradient(MOTION.depth)
    middle = (MOTION.depth > 2e-3) & (MOTION.depth < 4e-3)
    assert extra[middle & (rate > 0)] == pytest.approx(0.05, rel=1e-3)
    assert extra[middle & (rate < 0)] == pytest.approx(-0.05, rel=1e-3)


def test_adhesion_pulls_before_it_lets_go():
    made = readings(MOTION, adhesion={"tear": 0.0, "reach": 1e-3, "adhesion_force": 0.1})
    assert made.force.min() == pytest.approx(-0.1, abs=0.01)
    assert made.force[MOTION.depth < -0.6e-3] == pytest.approx(0.0, abs=1e-12)


def test_a_tearing_bond_pulls_as_far_as_it_reaches():
    made = readings(MOTION, adhesion={"tear": 0.1, "reach": 0.5e-3, "adhesion_force": 0.0})
    extra = made.force - PLAIN.force
    assert -0.1 <= extra.min() < -0.05
    assert extra[MOTION.depth >= 0.0] == pytest.approx(0.0)
    assert extra[MOTION.depth < -0.5e-3] == pytest.approx(0.0)


def test_a_bond_may_pull_most_just_before_it_lets_go():
    made = readings(MOTION, adhesion={"tear": 0.1, "reach": 0.5e-3, "rise": 0.9, "adhesion_force": 0.0})
    extra, held = made.force - PLAIN.force, np.clip(-MOTION.depth, 0.0, None)
    rising = (held > 0.0) & (held < 0.45e-3) & (extra < 0.0)
    assert rising.any()
    assert extra[rising] == pytest.approx(-0.1 * held[rising] / 0.45e-3)
    assert extra[held > 0.5e-3] == pytest.approx(0.0)


def test_gap_shifts_the_depth():
    made = readings(MOTION, contact_gap={"gap": 0.5e-3})
    assert made.force[DEEP] == pytest.approx(STIFFNESS * 4.5e-3)


def test_off_centre_field_goes_round_its_own_axis():
    made = readings(MOTION, off_centre_load={"x_0": 1e-3, "y_0": 0.0})
    moved = made.markers[DEEP[0]] - REST
    assert moved[1] == pytest.approx(0.1 * PEAK * np.array([-1.0, 6.0]) / np.sqrt(37.0))


def test_compliance_gives_the_tissue_less_depth():
    made = readings(MOTION, machine_compliance={"compliance": 1e-3})
    assert made.force[DEEP] == pytest.approx(STIFFNESS * PEAK / 1.2, rel=1e-4)


def test_a_rig_may_give_way_by_a_power_of_the_force():
    made = readings(MOTION, machine_compliance={"compliance": 1e-3, "power": 2.0})
    lost = PEAK - made.force[DEEP] / STIFFNESS
    assert lost == pytest.approx(1e-3 * made.force[DEEP] ** 2, rel=1e-4)


def test_backlash_is_lost_on_the_chosen_side():
    for side, loading, unloading in ((1.0, 0.0, 0.2e-3), (0.0, -0.2e-3, 0.0)):
        made = readings(MOTION, backlash={"width": 0.2e-3, "side": side})
        extra = (made.force - PLAIN.force) / STIFFNESS
        rate = np.gradient(MOTION.depth)
        middle = (MOTION.depth > 1e-3) & (MOTION.depth < 4e-3)
        assert extra[middle & (rate > 0)] == pytest.approx(loading, abs=1e-9)
        assert extra[middle & (rate < 0)] == pytest.approx(unloading, abs=1e-9)


def test_inertia_reads_the_acceleration():
    motion = replace(MOTION, acceleration=np.linspace(-1.0, 1.0, MOTION.time.size))
    made = readings(motion, tool_inertia={"mass": 0.2})
    assert made.force - PLAIN.force == pytest.approx(0.2 * motion.acceleration)


def test_drift_settles():
    made = readings(MOTION, force_drift={"rate": 0.01, "tau": 2.0})
    extra = made.force - PLAIN.force
    assert extra[0] == 0.0
    assert extra[100] == pytest.approx(0.02 * (1.0 - np.exp(-1.0)))


def test_saturation_stops_at_its_limit():
    made = readings(MOTION, force_saturation={"limit": 0.7, "softness": 0.001})
    assert made.force.max() == pytest.approx(0.7, rel=1e-6)
    low = PLAIN.force < 0.6
    assert made.force[low] == pytest.approx(PLAIN.force[low])


def test_late_frames_show_the_past():
    made = readings(MOTION, camera_latency={"latency": 0.1})
    assert made.markers[60:] == pytest.approx(PLAIN.markers[55:-5], abs=1e-9)
    assert made.force == pytest.approx(PLAIN.force)


def test_perspective_magnifies_what_came_nearer():
    made = readings(MOTION, perspective={"nearness": 4.0})
    assert made.markers[DEEP[0]] == pytest.approx(PLAIN.markers[DEEP[0]] / (1.0 - 4.0 * 0.5 * PEAK))


def test_a_scale_error_shows_at_rest():
    made = readings(MOTION, marker_scale_error={"error": 0.02})
    assert made.markers == pytest.approx(1.02 * PLAIN.markers)


def test_any_number_compose():
    made = readings(
        MOTION,
        pretension={"pretension": TENSE, "field": 0.0},
        contact_gap={"gap": 1e-3},
        force_drift={"rate": 0.0, "tau": 1.0},
        force_saturation={"limit": 0.9, "softness": 0.001},
    )
    assert made.force[DEEP] == pytest.approx(0.9, rel=1e-6)
    middle = np.flatnonzero(np.isclose(MOTION.depth, 3e-3))[0]
    assert made.force[middle] == pytest.approx((STIFFNESS + ADDED) * 2e-3)
