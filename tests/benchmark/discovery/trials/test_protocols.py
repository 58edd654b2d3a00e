"""Which trials of a condition belong together: dwells that show in some, specimens of different height, odd ones."""

import numpy as np
import pytest

from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.trials.preparing import prepare
from benchmark.errors import InputError
from benchmark.files import load_session

SESSION = 'schema = 1\nname = "mixed"\n[tool]\nradius = "5 mm"\ncontact = "rigid_bonded"\n[support]\nkind = "bonded"\n'


@pytest.fixture
def session(tmp_path):
    """A session of trials, each (time s, depth mm, force N, height mm or None)."""

    def make(trials, conditions=None, drive="depth"):
        lines = [f'{SESSION}[drive]\nchannel = "{drive}"\n']
        for number, (time, depth, force, height) in enumerate(trials):
            name = f"trial_{number:02d}.csv"
            columns, header = [time, depth, force], "time_s,depth_mm,force_N"
            if height is not None:
                columns, header = [*columns, height - depth], f"{header},gap_mm"
            np.savetxt(tmp_path / name, np.column_stack(columns), delimiter=",", header=header, comments="")
            condition = "slow" if conditions is None else conditions[number]
            lines.append(f'[[trials]]\nfile = "{name}"\ncondition = "{condition}"\n')
        (tmp_path / "session.toml").write_text("\n".join(lines))
        return load_session(tmp_path)

    return make


def press(peak, *, speed=1.0, dwell=0.0, height=None, stiffness=1.0, rate=25.0):
    """A press to a peak (mm) at a speed (mm/s), a dwell (s) and the way back, from 0.3 mm above the surface."""
    knots = np.cumsum([0.0, 0.5, (peak + 0.3) / speed, max(dwell, 1e-6), (peak + 0.3) / speed, 0.5])
    time = np.arange(0.0, knots[-1], 1.0 / rate)
    depth = np.interp(time, knots, [-0.3, -0.3, peak, peak, -0.3, -0.3])
    return time, depth, stiffness * np.maximum(depth, 0.0) ** 1.5, height


def test_a_short_dwell_that_shows_in_some_trials_refuses_none(session) -> None:
    peaks = np.linspace(2.0, 4.6, 12)
    made = session([press(peak, dwell=0.3) for peak in peaks])
    study = prepare(made, 100)
    assert study.trial_count == 12
    assert not any("left out" in text for text in study.warnings)
    deepest = [depth.max() for depth in study.conditions[0].depth]
    assert 1e3 * np.array(deepest) == pytest.approx(peaks, abs=0.1)


def paused(pause, peak=3.0, rate=25.0):
    """A press at 1 mm/s that pauses at 1 mm for so many seconds, with a hold of 2 s."""
    knots = np.cumsum([0.0, 1.3, max(pause, 1e-6), 2.0, 2.0, 3.3])
    time = np.arange(0.0, knots[-1], 1.0 / rate)
    depth = np.interp(time, knots, [-0.3, 1.0, 1.0, peak, peak, -0.3])
    return time, depth, np.maximum(depth, 0.0) ** 1.5, None


def holds(study):
    return int((np.diff(study.conditions[0].phase == PHASES.index("hold"), prepend=0) == 1).sum())


def test_a_pause_of_all_presses_is_a_hold(session) -> None:
    assert holds(prepare(session([paused(8.0)] * 6), 100)) == 2


def test_a_pause_that_shows_in_some_trials_refuses_none(session) -> None:
    study = prepare(session([paused(0.45, peak) for peak in np.linspace(2.0, 5.0, 12)]), 100)
    assert study.trial_count == 12
    assert holds(study) == 1


def test_a_long_hold_of_single_trials_is_another_motion(session) -> None:
    made = session([*(press(3.0) for _ in range(8)), press(3.0, dwell=6.0)])
    study = prepare(made, 100)
    assert study.trial_count == 8
    assert any("another motion than the others': trial_08" in text for text in study.warnings)


def test_depth_over_height_is_compared_where_specimens_differ(session) -> None:
    heights = np.linspace(4.0, 16.0, 8)
    trials = [press(0.3 * h, speed=0.1 * h, height=h, stiffness=20.0 / (0.3 * h) ** 4) for h in heights]
    assert prepare(session(trials), 100).trial_count == 8
    unknown = prepare(session([(*trial[:3], None) for trial in trials]), 100)
    assert unknown.trial_count == 6
    assert any("others': trial_00, trial_01" in text for text in unknown.warnings)


def test_heights_that_fall_apart_are_conditions_with_a_base_of_their_own(session) -> None:
    """Cylinders of 8, 12 and 16 mm stood against one base of 12."""
    heights = (16.0, 8.0, 12.0, 8.05, 12.0, 15.8, 16.1)
    study = prepare(session([press(2.0, height=height) for height in heights]), 100)
    assert [each.name for each in study.conditions] == ["slow_8.025mm", "slow_12mm", "slow_16mm"]
    assert [each.trials for each in study.conditions][2] == ("trial_00", "trial_05", "trial_06")
    thick = [1e3 * each.specimen.thickness for each in study.conditions]
    assert thick == pytest.approx([8.025, 12.0, 16.0], rel=1e-2)
    assert [1e3 * each.around.thickness for each in study.conditions] == pytest.approx(thick)
    assert any("of several heights, and taken for slow_8.025mm (2 trials)" in each for each in study.warnings)


def test_a_height_of_a_single_trial_stays_with_the_others_and_is_said(session) -> None:
    made = session([press(2.0, height=height) for height in (8.0, 8.0, 8.1, 8.0, 12.0)])
    study = prepare(made, 100)
    assert [each.name for each in study.conditions] == ["slow"]
    assert study.conditions[0].specimen == made.specimen
    assert "condition slow: its specimens are 8 to 12 mm high, and all held against one base" in study.warnings


@pytest.mark.parametrize("speed", [8.0, 0.2])
def test_a_single_trial_of_another_speed_is_set_aside_by_name(session, speed) -> None:
    made = session([press(3.0), press(3.1), press(2.9), press(3.0, speed=speed), press(3.0)])
    study = prepare(made, 100)
    assert study.trial_count == 4
    assert any("trial_03" in text for text in study.warnings)


def test_two_protocols_in_one_condition_are_taken_apart(session) -> None:
    study = prepare(session([press(3.0, speed=speed, rate=200.0) for speed in (1.0, 9.0) * 3]), 100)
    assert [each.name for each in study.conditions] == ["slow_1mm_s_to_3mm", "slow_9mm_s_to_3mm"]
    assert [each.numbers.tolist() for each in study.conditions] == [[0, 2, 4], [1, 3, 5]]
    assert any("several protocols" in text and "slow_9mm_s_to_3mm (3 trials)" in text for text in study.warnings)


def test_trials_that_each_move_in_their_own_way_are_refused(session) -> None:
    made = session([press(3.0, speed=speed) for speed in (1.0, 2.0, 4.0, 9.0, 0.5, 0.2)])
    with pytest.raises(InputError, match=r"different protocols \(6 trials; peak depth 2.88 to 3 mm, speed .* mm/s\)"):
        prepare(made, 100)


@pytest.mark.parametrize(("column", "reason"), [(1, "no motion"), (2, "force_N does not change")])
def test_a_single_trial_that_tells_nothing_is_set_aside_by_name(session, column, reason) -> None:
    still = list(press(3.0))
    still[column] = np.full_like(still[0], 0.5)
    study = prepare(session([press(3.0), tuple(still), press(3.0), press(3.0)]), 100)
    assert study.trial_count == 3
    assert any("trial_01" in text and reason in text for text in study.warnings)


def test_a_condition_whose_trials_all_tell_nothing_is_left_out(session) -> None:
    trials = [press(3.0) for _ in range(7)]
    time, depth, _, _ = press(3.0)
    trials.append((time, depth, np.zeros_like(time), None))
    study = prepare(session(trials, ["slow"] * 7 + ["off"]), 100)
    assert [condition.name for condition in study.conditions] == ["slow"]
    assert any("trial_07" in text for text in study.warnings)


def test_specimens_are_told_apart_by_their_height_and_taken_for_one_without(session) -> None:
    heights = [10.0, 12.0, 10.02, 14.0, 12.01, 10.03]
    made = session([press(3.0, height=height) for height in heights])
    assert prepare(made, 100).conditions[0].specimens.tolist() == [0, 1, 0, 2, 1, 0]
    plain = session([press(3.0) for _ in heights])
    assert prepare(plain, 100).conditions[0].specimens.tolist() == [0] * 6


def weighed(number, *, steps=(1.0, 2.0, 3.0), low=0.1, scatter=5e-3, rate=10.0, rise=0.0):
    """Weights (N) put on one by one, 4 s each, at moments of their own between two rows, on a gel that creeps.

    The depth (mm) scatters by `scatter`, its answer differs by a tenth from trial to trial.
    """
    rng = np.random.default_rng([number, 7])
    fine = np.arange(0.0, 4.0 * len(steps) + 8.0, 0.01)
    put = 2.0 + 4.0 * np.arange(len(steps)) + rng.uniform(0.0, 1.0 / rate, len(steps))
    rises = np.clip((fine[:, None] - put) / max(rise, 0.01), 0.0, 1.0)
    force = low + rises @ np.diff([0.0, *steps])
    force = np.where(fine > put[-1] + 4.0, low, force)
    slow = np.zeros(fine.size)
    for k in range(1, fine.size):
        slow[k] = slow[k - 1] + 0.01 * (force[k - 1] - low - slow[k - 1])
    depth = (0.1 + 0.01 * rng.normal()) * (force - low + 0.5 * slow)
    rows = slice(None, None, round(100.0 / rate))
    read = depth[rows] + scatter * rng.normal(size=fine[rows].size)
    return fine[rows], read, force[rows] + 2e-3 * rng.normal(size=fine[rows].size), None


def test_equal_weights_are_one_protocol_whatever_depth_answers(session) -> None:
    """By the depth their speeds differ up to fivefold: noise tells where its steps begin and end."""
    study = prepare(session([weighed(number) for number in range(8)], drive="force"), 100)
    assert study.trial_count == 8
    assert not any("left out" in text for text in study.warnings)
    assert holds(study) >= 3  # the steps, and the gel that recovers while it is no hold in air


def test_a_depth_that_differs_threefold_under_one_force_is_one_protocol(session) -> None:
    made = [weighed(number) for number in range(6)]
    made = [(time, (1.0 + number) * depth, force, None) for number, (time, depth, force, _) in enumerate(made)]
    assert prepare(session(made, drive="force"), 100).trial_count == 6


def test_forces_that_rise_at_other_rates_are_taken_apart_by_the_force(session) -> None:
    fast = [weighed(number, steps=(3.0,)) for number in range(4)]
    slow = [weighed(number, steps=(3.0,), rise=3.5) for number in range(4)]
    study = prepare(session([*fast, *slow], drive="force"), 100)
    assert sorted(condition.size for condition in study.conditions) == [4, 4]
    assert any("N_s_to_3N" in text for text in study.warnings)


def test_forces_of_protocols_that_no_other_trial_has_are_told_in_newtons(session) -> None:
    made = [weighed(number, steps=(4.0**number,)) for number in range(5)]
    with pytest.raises(InputError, match=r"different protocols .*; force up to .* N, at .* N/s"):
        prepare(session(made, drive="force"), 100)


@pytest.mark.parametrize(("drive", "said"), [("depth", 'say [drive] channel = "force"'), ("force", "as at that depth")])
def test_a_depth_that_scatters_asks_what_was_prescribed(session, drive, said) -> None:
    """Tissue that does not creep shows nothing else that tells: force and depth stand together."""
    rng, (time, depth, force, _) = np.random.default_rng(2), press(3.0, speed=0.3)
    made = [
        (time, depth + 0.02 * rng.normal(size=time.size), force + 1e-3 * rng.normal(size=time.size), None)
        for _ in range(4)
    ]
    study = prepare(session(made, drive=drive), 100)
    assert any(said in text for text in study.warnings)
    force = study.conditions[0].signals[..., 0]
    assert drive == "depth" or np.median(force.std(axis=0)) > 5e-3  # the depth's scatter is the force's noise
