from dataclasses import replace

import numpy as np
import pytest

from benchmark.models import UncoveredError
from benchmark.physics import DepthRecord, Motion, TrialContext, catalogue
from benchmark.response.pipeline import ForceAlone, TrialPipeline, trial_force
from wavemodel import WaveError

TIME = np.linspace(0.0, 20.0, 400)
DEPTH = np.minimum(TIME / 0.5, 1.0) * 2e-3
AROUND = TrialContext(5e-3, 1e-2, 2e-3, 2.0, 20.0)
BY_SLUG = {effect.slug: effect for effect in catalogue()}


def _law(depth):
    return 1000.0 * depth


def test_without_effects_it_is_the_law() -> None:
    assert np.allclose(trial_force(_law, (), TIME, DEPTH, AROUND), 2.0 * DEPTH / 2e-3)


def test_body_rig_and_sensor_act_together() -> None:
    added = [
        (BY_SLUG["viscoelastic_relaxation"], {"g_1": 0.3, "tau_1": 1.0}),
        (BY_SLUG["machine_compliance"], {"compliance": 1e-4}),
        (BY_SLUG["force_drift"], {"rate": 0.01, "tau": 1e5}),
    ]
    force = trial_force(_law, added, TIME, DEPTH, AROUND)
    held = 2e-3 * 700.0 / (1.0 + 1e-4 * 700.0)
    assert force[-1] == pytest.approx(held + 0.01 * 20.0, rel=0.02)


def test_the_rig_gives_way_to_the_body_with_its_stiffening() -> None:
    stiff, soft = (
        (BY_SLUG["strain_stiffening"], {"b_1": 0.5, "b_2": 0.0}),
        (
            BY_SLUG["machine_compliance"],
            {"compliance": 3e-4},
        ),
    )
    force = trial_force(_law, (stiff, soft), TIME, DEPTH, AROUND)
    given = DEPTH[-1] - 3e-4 * force[-1]
    alone = trial_force(_law, (stiff,), TIME, np.minimum(DEPTH, given), AROUND)
    assert force[-1] == pytest.approx(alone[-1], rel=1e-3)
    assert alone[-1] > 1.02 * _law(given)


def test_a_depth_beyond_the_law_is_uncovered() -> None:
    def law(depth):
        if depth.max() > 1e-3:
            raise WaveError("1 mm at most")
        return _law(depth)

    with pytest.raises(UncoveredError, match="1 mm at most"):
        trial_force(law, (), TIME, DEPTH, AROUND)


BORDERS = np.linspace(0.0, 3.0, 61)


def _swung(time):
    """A sinus of 1 Hz, m."""
    return 1e-3 * (1.2 - np.cos(2.0 * np.pi * time))


@pytest.mark.parametrize(
    ("given", "exact"),
    [
        ({"damping_time": 0.02, "drag": 0.0}, 0.02 * np.diff(_law(_swung(BORDERS))) / 0.05),
        ({"damping_time": 0.0, "drag": 20.0}, 20.0 * np.diff(_swung(BORDERS)) / 0.05),
    ],
)
def test_the_damping_of_rows_that_are_means_is_the_mean_of_the_damping(given, exact):
    raw = np.arange(0.0, 3.001, 0.001)
    record = DepthRecord(raw, _swung(raw), BORDERS)
    motion = Motion(0.5 * (BORDERS[1:] + BORDERS[:-1]), record.means(0.0), np.zeros(60), record)
    pipeline = TrialPipeline(AROUND, (BY_SLUG["viscous_damping"],))
    values = {"viscous_damping": given | {"drag_growth": 0.0, "power": 1.0}}
    size, exact = exact.max(), np.maximum(_law(record.means(0.0)) + exact, 0.0)
    found = pipeline.readings(ForceAlone(_law), values, motion).force
    np.testing.assert_allclose(found[1:-1], exact[1:-1], atol=5e-3 * size)
    between = pipeline.readings(ForceAlone(_law), values, replace(motion, record=None)).force
    assert np.abs(between - exact)[1:-1].max() > 1e-2 * size


def _lifted(time):
    """Pressed by 1 mm and lifted to 1 mm above within 2 s, m, and kept there."""
    return np.where(time < 2.0, 1e-3 * np.cos(0.5 * np.pi * time), -1e-3)


@pytest.mark.parametrize("pull", np.linspace(0.3, 0.6, 31))
@pytest.mark.parametrize("damping", [None, 1e-9])
def test_a_tissue_that_lets_go_within_a_row_pulls_in_its_part_before(pull, damping):
    """Against the means of a record in steps of 10 us."""
    fine = np.arange(0.0, 3.0, 1e-5)
    exact = np.where(_lifted(fine) > -pull / 1000.0, _law(_lifted(fine)), 0.0)
    sums = np.concatenate([[0.0], np.cumsum(exact)])
    edges = np.round(BORDERS / 1e-5).astype(int)
    means = np.diff(sums[edges]) / np.diff(edges)
    raw = np.arange(0.0, 3.001, 0.001)
    record = DepthRecord(raw, _lifted(raw), BORDERS)
    motion = Motion(0.5 * (BORDERS[1:] + BORDERS[:-1]), record.means(0.0), np.zeros(60), record)
    values = {"adhesion": {"tear": 0.0, "reach": 1e-3, "rise": 0.1, "adhesion_force": float(pull)}}
    if damping:
        values["viscous_damping"] = {"damping_time": damping, "drag": 0.0, "drag_growth": 0.0, "power": 1.0}
    pipeline = TrialPipeline(AROUND, tuple(effect for effect in catalogue() if effect.slug in values))
    found = pipeline.readings(ForceAlone(_law), values, motion).force
    np.testing.assert_allclose(found[:-1], means[:-1], atol=0.02 * pull)
    alone = pipeline.readings(ForceAlone(_law), values, replace(motion, record=None)).force
    assert set(np.flatnonzero(alone < 0.0)) <= set(np.flatnonzero(_law(motion.depth) > -pull))


@pytest.mark.parametrize(
    ("depth", "row"),
    [([1.0, 0.0, 0.0, -1.0, -2.0, -3.0], 3), ([1.0, 0.5, 0.0, -0.2, -0.4, -0.6], 5)],
    ids=["jump", "end"],
)
def test_where_nothing_tells_how_it_lets_go_the_rows_stay(depth, row):
    """A tool that stood before, and a trial that ends there."""
    depth = 1e-3 * np.array(depth)
    time = np.arange(depth.size, dtype=np.float64)
    record = DepthRecord(time, depth, np.append(time - 0.5, time[-1] + 0.5))
    values = {"adhesion": {"tear": 0.0, "reach": 1e-3, "rise": 0.1, "adhesion_force": 0.5}}
    pipeline = TrialPipeline(AROUND, (BY_SLUG["adhesion"],))
    motion = Motion(time, depth, np.zeros(depth.size), record)
    plain = pipeline.readings(ForceAlone(_law), values, replace(motion, record=None)).force
    assert plain[row] == 0.0
    np.testing.assert_array_equal(pipeline.readings(ForceAlone(_law), values, motion).force, plain)


class Sheet:
    """An elastic answer whose lower face moves by the depth over the distance from the tool's axis."""

    def __init__(self, shown=1.0):
        self.shown = shown

    def force(self, depth):
        return _law(depth)

    def lower_face(self, spread, rest):
        away = rest - np.asarray(spread.centre)
        sunk = self.shown * (spread.depth * spread.passed)[:, None] / (1.0 + np.hypot(*away.T) * spread.ratio)
        if spread.dent is not None:
            sunk = sunk + spread.dent[0][:, None] / max(spread.dent[1], 1e-3)
        return rest + sunk[..., None] * away, sunk


@pytest.mark.parametrize(
    "added",
    [
        {},
        {"off_centre_load": {"x_0": 1e-3, "y_0": 0.0}},
        {"pretension": {"pretension": 100.0, "field": 0.5}},
        {"perspective": {"nearness": 7.0}, "viscous_damping": {"damping_time": 0.2, "drag": 0.0, "power": 1.0}},
        {"permanent_set": {"permanent_set": 0.3, "permanent_set_onset": 0.0, "marker_share": 0.5}},
    ],
)
def test_several_trials_at_once_are_each_as_by_itself(added) -> None:
    around = replace(
        AROUND, markers=np.array([[1e-3, 0.0], [0.0, 2e-3], [-3e-3, 1e-3]]), spacing=1e-3, hole_radius=1e-2
    )
    pipeline = TrialPipeline(around, tuple(BY_SLUG[slug] for slug in added), 0.1)
    ways = [(1.0, 0.0, 0.0), (1.3, 0.05, 1e-4), (0.8, -0.02, -2e-4)]
    lengths = (400, 300, 350)
    motions = [Motion(TIME[:n], DEPTH[:n] * (1.0 + 0.1 * k), np.zeros(n)) for k, n in enumerate(lengths)]
    sheet, other = Sheet(), Sheet(2.0)
    for elastics in ([sheet] * 3, [sheet, other, sheet]):
        together = pipeline.of_several(elastics, added, motions, ways)
        for elastic, motion, way, found in zip(elastics, motions, ways, together, strict=True):
            alone = pipeline.readings(elastic, added, motion, *way)
            np.testing.assert_array_equal(found.force, alone.force)
            np.testing.assert_allclose(found.markers, alone.markers, rtol=1e-14)
            np.testing.assert_allclose(found.sink, alone.sink, rtol=1e-14)


@pytest.mark.parametrize(
    "moved",
    [
        lambda face, deep: replace(face, centre=(deep, 0.0)),
        lambda face, deep: replace(face, ratio=1.0 + 100.0 * deep),
        lambda face, deep: replace(face, dent=(1e-6 * face.depth, 2.0 * deep)),
        lambda face, deep: face if deep < 2.1e-3 else replace(face, dent=(1e-6 * face.depth, 1e-3)),
    ],
    ids=["centre", "ratio", "dent", "some dents"],
)
def test_an_effect_that_moves_each_trials_face_otherwise_is_followed_trial_by_trial(moved) -> None:
    markers = np.array([[1e-3, 0.0], [0.0, 2e-3], [-3e-3, 1e-3]])
    own = replace(
        BY_SLUG["off_centre_load"],
        lower_face=lambda values, face, press, around: moved(face, float(press.depth.max())),
    )
    pipeline, values = TrialPipeline(replace(AROUND, markers=markers), (own,)), {own.slug: {"x_0": 0.0, "y_0": 0.0}}
    motions = [Motion(TIME, DEPTH * (1.0 + 0.1 * k), np.zeros(TIME.size)) for k in range(3)]
    sheet = Sheet()
    together = pipeline.of_several([sheet] * 3, values, motions, [(1.0, 0.0, 0.0)] * 3)
    for motion, found in zip(motions, together, strict=True):
        np.testing.assert_allclose(found.markers, pipeline.readings(sheet, values, motion).markers, rtol=1e-14)


REMEMBERED = {
    "viscoelastic_relaxation": {"g_1": 0.3, "tau_1": 2.0},
    "stress_softening": {"softening": 0.4, "softening_width": 0.5},
    "permanent_set": {"permanent_set": 0.2, "permanent_set_onset": 0.0, "marker_share": 0.5},
    "dry_friction": {"friction_force": 0.1},
    "backlash": {"width": 2e-4, "side": 0.0},
    "machine_compliance": {"compliance": 1e-4},
    "viscous_damping": {"damping_time": 0.05, "drag": 0.0, "drag_growth": 0.0, "power": 1.0},
    "force_drift": {"rate": 0.01, "tau": 1e5},
}


@pytest.mark.parametrize("slug", REMEMBERED)
@pytest.mark.parametrize("markers", [None, np.array([[4e-3, 0.0], [0.0, 7e-3]])])
def test_a_press_cut_from_a_record_remembers_what_was_before_it(slug, markers):
    effect, raw, first = BY_SLUG[slug], np.arange(0.0, 3.001, 0.001), 40
    values = {p.name: p.start[0] for p in effect.description.parameters} | REMEMBERED[slug]
    borders = 0.98 * BORDERS
    whole = DepthRecord(raw, 1e-3 * (np.exp(-raw) * 2.0 - np.cos(2.0 * np.pi * raw)), borders)
    after = DepthRecord(raw, whole.depth, borders, first)
    pipeline = TrialPipeline(replace(AROUND, markers=markers), (effect,), 0.2)

    def read(record):
        motion = Motion(0.5 * (borders[1:] + borders[:-1]), record.given, np.zeros(60), record)
        return pipeline.readings(Sheet(), {slug: values}, motion, 1.1, 2e-4, 1e-5)

    long, cut = read(whole), read(after)
    drifted = 0.01 * 0.049 * first if slug == "force_drift" else 0.0  # a drift counts from the trial's own beginning
    np.testing.assert_allclose(cut.force, long.force[first:] - drifted, rtol=1e-9, atol=1e-6)
    if markers is not None:
        np.testing.assert_allclose(cut.markers, long.markers[first:], rtol=1e-12)
