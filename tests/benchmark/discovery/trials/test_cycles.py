"""One long record of many presses becomes trials; sessions with enough records, and short ones, stay whole."""

import numpy as np
import pytest

from benchmark.discovery.base.trials_problem import trial_refs
from benchmark.discovery.trials.cycles import by_cycles
from benchmark.discovery.trials.preparing import prepare
from benchmark.errors import InputError
from benchmark.files import load_session

SESSION = 'schema = 1\nname = "long"\n[tool]\nradius = "5 mm"\ncontact = "rigid_bonded"\n[support]\nkind = "bonded"\n'


@pytest.fixture
def session(tmp_path):
    """A session of records of so many presses each (mm, N), 3 mm deep, with a second in air between them."""

    def make(*presses, stiffness=lambda number: 1.0):
        lines = [SESSION]
        for record, count in enumerate(presses):
            knots, depth = [0.0], [-0.3]
            for _ in range(count):
                knots += (knots[-1] + np.cumsum([1.0, 1.5, 0.6, 1.5])).tolist()
                depth += [-0.3, 3.0, 3.0, -0.3]
            time = np.arange(0.0, knots[-1] + 0.5, 0.04)
            way = np.interp(time, knots, depth)
            factor = np.array([stiffness(int(t // 4.6)) for t in time])
            table = np.column_stack([time, way, factor * np.maximum(way, 0.0) ** 1.5])
            np.savetxt(tmp_path / f"r{record}.csv", table, delimiter=",", header="time_s,depth_mm,force_N", comments="")
            lines.append(f'[[trials]]\nfile = "r{record}.csv"\ncondition = "slow"\n')
        (tmp_path / "session.toml").write_text("\n".join(lines))
        return load_session(tmp_path)

    return make


def test_each_press_of_a_long_record_is_a_trial_and_no_row_is_lost(session) -> None:
    made = session(8)
    split, said = by_cycles(made)
    assert [trial.name for trial in split.trials] == [f"r0 press {number}" for number in range(1, 9)]
    rows = np.concatenate([trial.table.force for trial in split.trials])
    np.testing.assert_array_equal(rows, made.trials[0].table.force)
    assert all(trial.table.depth.max() == pytest.approx(3e-3, abs=1e-4) for trial in split.trials)
    assert all(trial.table.depth[0] < 0.0 for trial in split.trials)
    assert "8 presses count as trials" in said[0]
    assert split.trials[0].earlier is None
    before = split.trials[3].earlier
    np.testing.assert_array_equal(before.force, rows[: before.force.size])
    assert before.time[-1] < split.trials[3].table.time[0] == made.trials[0].table.time[before.time.size]


def test_a_press_is_simulated_after_those_before_it(session) -> None:
    study = prepare(session(8), 100)
    refs = trial_refs(study)
    assert refs[0].motion.earlier == 0
    motion, own = refs[5].motion, study.conditions[0]
    before = motion.depth[: motion.earlier]
    assert (np.diff(np.sign(before - 1.5e-3)) > 0).sum() == 5
    assert before.max() == pytest.approx(3e-3, abs=1e-4)
    np.testing.assert_array_equal(motion.read.depth, own.depth[5])
    assert motion.time[motion.earlier - 1] < motion.time[motion.earlier]


def test_presses_are_compared_and_what_one_leaves_to_the_next_stays_in_their_order(session) -> None:
    study = prepare(session(8, stiffness=lambda number: 1.0 - 0.05 * number), 100)
    (condition,) = study.conditions
    assert condition.size == 8
    assert condition.numbers.tolist() == list(range(8))
    peaks = condition.signals[:, :, 0].max(axis=1)
    assert np.all(np.diff(peaks) < 0.0)
    assert any("count as trials" in text for text in study.warnings)


def test_enough_records_stay_whole_and_few_presses_are_still_too_few(session) -> None:
    whole = session(4, 4, 4)
    assert by_cycles(whole) == (whole, ())
    with pytest.raises(InputError, match="at least 3"):
        prepare(session(2), 100)


def test_a_pause_within_a_press_parts_no_trial(tmp_path) -> None:
    knots, depth = [0.0], [-0.3]
    for _ in range(6):
        knots += (knots[-1] + np.cumsum([1.0, 0.7, 5.0, 1.0, 2.0, 1.5])).tolist()
        depth += [-0.3, 1.0, 1.0, 3.0, 3.0, -0.3]
    time = np.arange(0.0, knots[-1] + 0.5, 0.04)
    way = np.interp(time, knots, depth)
    table = np.column_stack([time, way, np.maximum(way, 0.0) ** 1.5])
    np.savetxt(tmp_path / "r.csv", table, delimiter=",", header="time_s,depth_mm,force_N", comments="")
    (tmp_path / "session.toml").write_text(f'{SESSION}[[trials]]\nfile = "r.csv"\ncondition = "slow"\n')
    split, _ = by_cycles(load_session(tmp_path))
    assert len(split.trials) == 6
    assert sum(trial.table.time.size for trial in split.trials) == time.size
