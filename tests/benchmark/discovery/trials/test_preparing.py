"""Sessions that cannot be used are refused, and those of few trials name nothing."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.trials.preparing import prepare
from benchmark.discovery.trials.rows import depth_step
from benchmark.errors import InputError
from benchmark.files import Camera, Support, load_session
from benchmark.files.tissue import PronyTerm


def rewrite(folder, change):
    for path in sorted(folder.glob("trial_*.csv")):
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        np.savetxt(path, change(table), delimiter=",", header="time_s,depth_mm,force_N", comments="", fmt="%.7f")


@pytest.mark.parametrize("trials", [1, 2])
def test_one_or_two_trials_are_refused(session_of, trials):
    with pytest.raises(InputError, match="at least 3 are needed"):
        prepare(session_of(trials=trials, speeds=(3e-3,)), 100)


def test_few_trials_are_said_to_show_nothing(session_of):
    study = prepare(session_of(trials=4, speeds=(3e-3,)), 100)
    assert any("cannot reach the 5 % level" in text for text in study.warnings)


def test_a_told_relaxation_is_said_to_be_no_part_of_the_base(session_of):
    session = session_of(trials=4, speeds=(3e-3,))
    assert not any("told to have" in text for text in prepare(session, 100).warnings)
    first = session.specimen.layers[0].model_copy(update={"relaxation": (PronyTerm(g=0.3, tau=2.0),)})
    fading = session.specimen.model_copy(update={"layers": (first, *session.specimen.layers[1:])})
    said = prepare(replace(session, specimen=fading), 100).warnings
    assert any(f"the relaxation that {first.name} is told to have is left out" in text for text in said)


@pytest.mark.parametrize(
    ("column", "message"), [(1, "no motion"), (2, "force_N does not change")], ids=["depth", "force"]
)
def test_a_channel_that_stays_is_refused(tmp_path, quick_session, column, message):
    folder = quick_session.write_session(tmp_path / "s", trials=3, speeds=(3e-3,))

    def still(table):
        table[:, column] = 0.5
        return table

    rewrite(folder, still)
    with pytest.raises(InputError, match=message):
        prepare(load_session(folder), 100)


def test_a_tool_in_air_is_refused(tmp_path, quick_session):
    folder = quick_session.write_session(tmp_path / "s", trials=3, speeds=(3e-3,))
    rewrite(folder, lambda table: table - np.array([0.0, 10.0, 0.0]))
    with pytest.raises(InputError, match="never presses"):
        prepare(load_session(folder), 100)


def test_missing_rows_are_said(tmp_path, quick_session):
    folder = quick_session.write_session(tmp_path / "s", trials=3, speeds=(3e-3,))
    rewrite(folder, lambda table: np.delete(table, np.s_[60:80], axis=0))
    study = prepare(load_session(folder), 100)
    assert any("a gap of" in text for text in study.warnings)
    assert np.isfinite(study.conditions[0].depth).all()


def test_one_row_a_second_is_prepared(tmp_path, quick_session):
    folder = quick_session.write_session(tmp_path / "s", trials=3, speeds=(0.2e-3,), hold=10.0)
    rewrite(folder, lambda table: table[::25])
    assert prepare(load_session(folder), 100).conditions[0].size == 3


def test_very_many_rows_are_reduced(tmp_path, quick_session):
    folder = quick_session.write_session(tmp_path / "s", trials=3, speeds=(3e-3,))

    def dense(table):
        time = np.linspace(0.0, table[-1, 0], 40_000)
        return np.column_stack([time, *(np.interp(time, table[:, 0], table[:, k]) for k in (1, 2))])

    rewrite(folder, dense)
    assert prepare(load_session(folder), 100).conditions[0].time.shape[1] < 400


def test_a_long_hold_leaves_a_fast_press_its_rows(tmp_path):
    knots, depths = [0.0, 0.5, 0.85, 120.0], [-0.5, -0.5, 3.0, 3.0]  # s, mm: at 10 mm/s, 1 kHz
    time = np.arange(0.0, 120.0, 1e-3)
    depth = np.interp(time, knots, depths)
    table = np.column_stack([time, depth, np.maximum(depth, 0.0) ** 1.5])
    lines = ['schema = 1\nname = "long hold"\n[tool]\nradius = "5 mm"\n[support]\nkind = "bonded"\n']
    for number in range(3):
        np.savetxt(tmp_path / f"t{number}.csv", table, delimiter=",", header="time_s,depth_mm,force_N", comments="")
        lines.append(f'[[trials]]\nfile = "t{number}.csv"\ncondition = "press"\n')
    (tmp_path / "session.toml").write_text("\n".join(lines))
    condition = prepare(load_session(tmp_path), 220).conditions[0]
    measured, depth = condition.signals[0, :, 0], 1e3 * condition.depth[0]
    assert measured == pytest.approx(np.maximum(depth, 0.0) ** 1.5, abs=0.002 * 3.0**1.5)


@pytest.mark.parametrize(("edge", "expected"), [("", 0.0), ('edge_radius = "2 mm"\n', 2e-3)])
def test_effects_know_the_edge_of_the_tool(tmp_path, quick_session, edge, expected):
    folder = quick_session.write_session(tmp_path / "session")
    file = folder / "session.toml"
    file.write_text(file.read_text().replace('contact = "rigid_bonded"\n', f'contact = "rigid_bonded"\n{edge}'))
    assert {each.around.edge_radius for each in prepare(load_session(folder), 40).conditions} == {expected}


def test_each_trial_keeps_the_record_that_its_rows_are_means_of(tmp_path, quick_session):
    """On the clock of its rows, which begins with the first of them."""
    folder = quick_session.write_session(tmp_path / "session", trials=4, speeds=(3e-3,))
    rewrite(folder, lambda table: table + np.array([7.0, 0.0, 0.0]))
    study = prepare(load_session(folder), 60)
    condition = study.conditions[0]
    for row, record in enumerate(condition.records):
        full = condition.count[row, :, 0] > 1
        assert full.sum() > 10
        assert (record.borders[:-1][full] < condition.time[row][full]).all()
        assert (record.borders[1:][full] > condition.time[row][full]).all()
        np.testing.assert_allclose(
            record.means(0.0)[full], condition.depth[row][full], atol=2e-3 * np.ptp(record.depth)
        )
    assert study.depth_step == pytest.approx(depth_step(condition.records[0].depth), rel=0.5)
    assert study.depth_step > 0.0


def test_a_depth_whose_sensor_scatters_is_prepared_steady(tmp_path, quick_session):
    """Rows, records and the smallest change are those of the steady depth, not of the one that was read."""
    folder = quick_session.write_session(tmp_path / "session", trials=4, speeds=(3e-3,), noise=1e-4)
    smooth = prepare(load_session(folder), 400)
    rng = np.random.default_rng(5)
    rewrite(folder, lambda table: table + 0.02 * rng.normal(size=(len(table), 1)) * np.array([0.0, 1.0, 0.0]))
    study = prepare(load_session(folder), 400)
    (before,), (after,) = smooth.conditions, study.conditions
    assert np.unique(after.phase).tolist() == np.unique(before.phase).tolist()
    for made, known in zip(after.records, before.records, strict=True):
        assert 1e3 * np.std(made.depth - np.interp(made.time, known.time, known.depth)) < 0.01
    assert 1e3 * study.depth_step == pytest.approx(0.02, rel=0.2)
    (said,) = set(study.warnings) - set(smooth.warnings)
    assert re.match(r"the depth of 4 of 4 trials scatters by (19|20|21) um from row to row", said)


def guide(size):
    """A guide's friction, N, beside the elastic force."""
    return lambda time, depth, elastic: elastic + size * np.sign(np.round(np.gradient(depth, time), 6))


def drift(time, depth, elastic):
    return elastic + 0.01 * time


def pull(time, depth, elastic):
    """A surface that holds the tool for 0.2 of the 0.5 mm of its way up."""
    gone = (np.maximum.accumulate(depth) > 0.0) & (depth < 0.0) & (depth > -0.2e-3) & (np.gradient(depth) < 0.0)
    return elastic - 0.1 * gone


def uneven(time, depth, elastic):
    """Three times as much while the tool goes down as while it goes up: no friction, which is as large both ways."""
    speed = np.round(np.gradient(depth, time), 6)
    return elastic + 0.06 * (speed > 0.0) - 0.02 * (speed < 0.0)


SAID = [(guide(0.05), True), (guide(0.0), False), (drift, False), (pull, False), (uneven, False)]


@pytest.mark.parametrize(("force", "said"), SAID)
def test_a_force_in_air_that_goes_with_the_direction_is_the_benchs_own(session_of, force, said):
    study = prepare(session_of(force=force, trials=5, speeds=(0.6e-3,), noise=0.002, seed=4), 100)
    found = [float(size) for text in study.warnings for size in re.findall(r"in air, the force is ([0-9.]+) N", text)]
    assert found == (pytest.approx([0.05], rel=0.15) if said else [])


def filmed(session):
    """A camera, and four markers in all trials that move by 0.1 mm."""
    frames = np.repeat([0.0, 0.5, 1.0], 4)
    places = np.tile([[-3e-3, -3e-3], [3e-3, -3e-3], [-3e-3, 3e-3], [3e-3, 3e-3]], (3, 1))
    number, moved = np.tile(np.arange(4), 3), places + 1e-4 * frames[:, None]
    markers = SimpleNamespace(time=frames, marker=number, x=moved[:, 0], y=moved[:, 1])
    camera = Camera(marker_rows=2, marker_columns=2, marker_spacing=6e-3)
    return replace(session, camera=camera, trials=tuple(replace(trial, markers=markers) for trial in session.trials))


def test_markers_of_a_face_that_is_held_are_left_out(session_of):
    """Also those on its upper face: nothing of a session says so, and as a lower face they cannot be understood."""
    study = prepare(filmed(session_of(trials=6, speeds=(3e-3,))), 100)
    assert study.layout is None
    assert [text for text in study.warnings if "held there" in text]
    assert not [text for text in study.warnings if "no four markers" in text]


def test_markers_of_trials_over_a_hole_stay_beside_others(session_of):
    session = filmed(session_of(trials=3, speeds=(3e-3, 6e-3)))
    first, over = session.trials[0].condition, Support(kind="hole", hole_radius=0.02)
    supported = [replace(each, support=over) if each.condition == first else each for each in session.trials]
    study = prepare(replace(session, trials=tuple(supported)), 100)
    assert [text for text in study.warnings if "held there" in text]
    seen = {each.name: bool((each.count[..., 1:] > 0.0).any()) for each in study.conditions}
    assert seen == {each.name: each.name == first for each in study.conditions}
    assert len(seen) == 2
