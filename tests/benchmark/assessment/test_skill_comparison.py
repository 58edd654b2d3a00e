"""Records read, measured and compared; the attempts are synthetic: smooth reaches, and the same shaken and astray."""

import json

import numpy as np
import pytest

from benchmark.assessment.attempt_measures import read_attempt
from benchmark.assessment.skill_comparison import assess
from benchmark.cli.app import main
from benchmark.comparison.t_tests import detectable_effect, group_power, group_t_test
from benchmark.errors import InputError
from reports import write_csv

TARGETS = np.array([[10.0, 10.0, 1.0], [30.0, 12.0, 2.0], [20.0, 35.0, 1.5]])


def reach(start, end, seconds):
    """Minimum-jerk positions (n, 3), mm."""
    share = np.linspace(0.0, 1.0, int(100 * seconds))[:, None]
    return start + (end - start) * (10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5)


def write_attempt(path, rng, shake, astray, tools=(0,), *, last=3, names=(0, 1, 2)):
    """An attempt at the targets: in the air to each, down to its depth, up again; it goes on to so many of them."""
    pieces, here, shown = [], np.array([0.0, 0.0, 0.0]), []
    for number in range(len(TARGETS)):
        target = TARGETS[min(number, last - 1)]
        above = target * [1.0, 1.0, 0.0]
        wrong = target + np.array([0.0, 0.0, astray * rng.normal()])
        for goal, seconds in ((above, 1.0 + shake * rng.uniform()), (wrong, 0.5), (above, 0.5)):
            pieces.append(reach(here, goal, seconds))
            shown += [number] * len(pieces[-1])
            here = goal
    position = np.vstack(pieces)
    time = 0.01 * np.arange(len(position))
    position = position + shake * np.sin(2.0 * np.pi * 9.0 * time)[:, None] * [0.3, 0.2, 0.0]
    position[:, 2] = np.maximum(position[:, 2], 0.0)
    columns = {"time_s": time, "x_mm": position[:, 0], "y_mm": position[:, 1], "depth_mm": position[:, 2]}
    columns |= {"force_N": 1.3 * position[:, 2], "target": [names[number] for number in shown]}
    columns |= {
        name: TARGETS[shown, axis] for axis, name in enumerate(("target_x_mm", "target_y_mm", "target_depth_mm"))
    }
    whole = {name: np.tile(values, len(tools)) for name, values in columns.items()}
    write_csv(path, {"tool": np.repeat(tools, len(time)), **whole})
    return position


@pytest.fixture(scope="module")
def groups(tmp_path_factory):
    folder, rng = tmp_path_factory.mktemp("records"), np.random.default_rng(16)
    for group, shake, astray in (("expert", 0.1, 0.02), ("novice", 1.0, 0.3)):
        (folder / group).mkdir()
        for number in range(6):
            write_attempt(folder / group / f"{number}.csv", rng, shake * rng.uniform(0.6, 1.4), astray)
    return folder


def test_an_attempt_is_measured_as_it_was_made(tmp_path):
    position = write_attempt(tmp_path / "one.csv", np.random.default_rng(1), 0.0, 0.0)
    found = read_attempt(tmp_path / "one.csv").measures()
    length = np.linalg.norm(np.diff(position, axis=0), axis=1).sum()
    assert found["path_length_mm"] == pytest.approx(length, rel=1e-6)
    assert found["time_s"] == pytest.approx(0.01 * (len(position) - 1))
    assert found["depth_error_mm"] == pytest.approx(0.0, abs=1e-6)
    assert found["tremor_um"] < 20.0
    assert 0.8 < found["economy_of_motion"] <= 1.0
    assert np.isnan(found["bimanual_correlation"])
    assert np.isnan(found["force_error_N"])


def test_two_tools_that_move_alike_are_one_pair_of_hands(tmp_path):
    write_attempt(tmp_path / "both.csv", np.random.default_rng(1), 0.1, 0.0, tools=(0, 1))
    found = read_attempt(tmp_path / "both.csv").measures()
    assert found["bimanual_correlation"] == pytest.approx(1.0)


def test_shaken_attempts_are_told_from_smooth_ones(groups):
    found = assess([groups / "expert", groups / "novice"])
    tests = {one.measure: one for one in found.tests}
    for measure in ("tremor_um", "depth_error_mm", "log_dimensionless_jerk"):
        assert tests[measure].differs, measure
    assert tests["tremor_um"].test.fem.mean < tests["tremor_um"].test.wave.mean
    assert all(one.adjusted >= one.test.p_value for one in found.tests)
    assert "expert from novice; expert does better in" in found.headline
    row = found.tests_columns()
    assert all(t * difference > 0.0 for t, difference in zip(row["t"], row["difference"], strict=True))


def test_the_better_group_is_named_by_what_the_measure_means(groups):
    tests = {one.measure: one for one in assess([groups / "novice", groups / "expert"]).tests}
    for measure in ("time_s", "tremor_um", "economy_of_motion", "log_dimensionless_jerk"):
        assert tests[measure].better(("novice", "expert")) == "expert"


def test_those_that_leave_targets_out_do_not_do_better_for_it(tmp_path):
    """Five that press all three targets, and five of which four stop after the first."""
    rng = np.random.default_rng(3)
    for group in ("thorough", "hasty"):
        (tmp_path / group).mkdir()
        for number in range(5):
            last = 1 if group == "hasty" and number else 3
            write_attempt(tmp_path / group / f"{number}.csv", rng, 0.2 + 0.1 * rng.uniform(), 0.02, last=last)
    found = assess([tmp_path / "thorough", tmp_path / "hasty"])
    tests = {one.measure: one.test for one in found.tests}
    assert {"tremor_um", "targets_reached"} <= set(tests)
    assert not {"time_s", "path_length_mm", "economy_of_motion"} & set(tests)
    assert "hasty left targets out in 4 of 5 attempts (reached 46.7 %)" in found.headline
    assert "thorough left targets out in 0 of 5 attempts (reached 100 %)" in found.headline
    assert "time, path length and economy of motion are compared without those" in found.headline
    assert ["not pressed" in text for text in found.columns()["warnings"]] == [False] * 6 + [True] * 4
    one = tmp_path / "hasty" / "5.csv"
    write_attempt(one, rng, 0.2, 0.02)
    again = assess([tmp_path / "thorough", tmp_path / "hasty"])
    assert {one.measure: one.test for one in again.tests}["time_s"].wave.observations == 2


def test_groups_of_one_name_stay_two(groups, tmp_path):
    for group in ("expert", "novice"):
        (tmp_path / group / "records").mkdir(parents=True)
        for file in (groups / group).iterdir():
            (tmp_path / group / "records" / file.name).write_bytes(file.read_bytes())
    found = assess([tmp_path / "expert" / "records", tmp_path / "novice" / "records"])
    assert found.groups == ("expert/records", "novice/records")
    assert len(found.tests) > 5
    mixed = assess([groups / "expert", tmp_path / "expert" / "records"])
    assert mixed.groups == ("expert", "records")


@pytest.mark.parametrize("twice", [("expert", "expert"), ("expert", "novice/../expert"), ("expert", "expert/0.csv")])
def test_what_is_given_twice_is_refused(groups, twice, capsys):
    code = main(["assess", *(str(groups / one) for one in twice)])
    said = capsys.readouterr()
    assert code == 2
    assert said.err.count("is given twice") == 1


def test_a_record_ends_with_its_task(tmp_path):
    """What the tool does before the first and after the last target is shown changes no measure."""
    rng, task = np.random.default_rng(1), tmp_path / "task.csv"
    write_attempt(task, rng, 0.1, 0.02)
    head, *rows = task.read_text().splitlines()
    names = head.split(",")
    idle = [row.split(",") for row in rows[:300]]
    for at, row in enumerate(idle):
        row[names.index("time_s")] = f"{0.01 * (at - 300):.6g}"
        row[names.index("target") : names.index("target") + 4] = [""] * 4
    late = [list(row) for row in idle]
    for at, row in enumerate(late):
        row[names.index("time_s")] = f"{0.01 * (len(rows) + at):.6g}"
    whole = tmp_path / "whole.csv"
    whole.write_text("\n".join([head, *map(",".join, idle), *rows, *map(",".join, late)]) + "\n")
    expected, found = read_attempt(task), read_attempt(whole)
    assert found.measures() == pytest.approx(expected.measures(), nan_ok=True, rel=1e-9)
    assert found.warnings == (
        "300 rows (3 s) before the first target left out",
        "300 rows (3 s) after the last target left out",
    )
    assert "Warning: 300 rows (3 s) before" in assess([whole]).headline


def test_targets_may_have_names(tmp_path):
    numbered, named = tmp_path / "numbered.csv", tmp_path / "named.csv"
    write_attempt(numbered, np.random.default_rng(1), 0.1, 0.02)
    write_attempt(named, np.random.default_rng(1), 0.1, 0.02, names=("A", "next one", "B2"))
    found = read_attempt(named)
    np.testing.assert_array_equal(found.target, read_attempt(numbered).target)
    assert found.measures()["targets_reached"] == 1.0
    assert np.isfinite(found.measures()["economy_of_motion"])


def test_one_group_in_two_halves_is_not_told_apart_nor_called_alike(groups, tmp_path):
    for number in range(6):
        half = tmp_path / ("odd" if number % 2 else "even")
        half.mkdir(exist_ok=True)
        (half / f"{number}.csv").write_bytes((groups / "novice" / f"{number}.csv").read_bytes())
    found = assess([tmp_path / "odd", tmp_path / "even"])
    assert not any(one.differs for one in found.tests)
    assert "does not show that they are alike" in found.headline


def test_power_is_that_of_the_t_test():
    """J. Cohen 1988, table 2.3.5: 26 in each group see a large effect four times in five."""
    assert group_power((26, 26)) == pytest.approx(0.807, abs=1e-3)
    assert detectable_effect((26, 26)) == pytest.approx(0.792, abs=2e-3)
    assert group_t_test([1.0, 2.0, 3.0], [2.0, 4.0, 6.0, 8.0]).difference == pytest.approx(3.0)


def test_the_command_writes_tables_and_a_page(groups, tmp_path, capsys):
    code = main(["assess", str(groups / "expert"), str(groups / "novice"), "--out", str(tmp_path / "out"), "--json"])
    said = json.loads(capsys.readouterr().out)
    assert code == 0
    assert len(said["attempts"]) == 12
    assert {one.name for one in (tmp_path / "out").iterdir()} >= {"attempts.csv", "skill.csv", "report.html"}
    assert (tmp_path / "out" / "attempts.csv").read_text().count("\n") == 13


HEAD = "time_s,tool,x_mm,y_mm,depth_mm,force_N\n"
TASK = HEAD.strip() + ",target,target_x_mm,target_y_mm,target_depth_mm\n"


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("time_s,tool\n0,0\n", "x_mm"),
        ("time_s,tool,x_mm,y_mm,depth_mm,force_N\n0,0,1,1,a,0\n", "depth_mm in row 2"),
        ("time_s,tool,x_mm,y_mm,depth_mm,force_N\n0,0,1,1,0,0\n", "at least 20"),
        (HEAD, "no row"),
        (HEAD + "0,0.5,1,1,0,0\n", "tool in row 2 is no whole number"),
        (HEAD + "0,0,1e308,1,0,0\n", "x_mm in row 2"),
        (HEAD + "".join(f"{0.001 * k},0,1,1,0,0\n" for k in range(30)), "time_s spans 0.029 s"),
        (HEAD + "".join(f"{1e6 * k},0,1,1,0,0\n" for k in range(30)), "time_s spans 2.9e.07 s"),
        (
            TASK + "0,0,1,1,0,0,A,1,2,deep\n",
            "target_depth_mm in row 2 is no number up to 1e.09, and target 'A' is shown",
        ),
        (TASK + "0,0,1,1,0,0,,,,\n0,0,1,1,0,0,4,1,,1\n", "target_y_mm in row 3 is no number"),
        (HEAD.strip() + ",target,target_x_mm,target_y_mm\n0,0,1,1,0,0,A,1,1\n", "target_depth_mm is missing"),
        (TASK.strip() + ",target_force_N\n0,0,1,1,0,0,A,1,2,1,strong\n", "target_force_N in row 2 is no number"),
        (
            TASK + "".join(f"{0.1 * k},0,1,1,0,0,{'1,1,1,1' if k < 9 else ',,,'}\n" for k in range(30)),
            "tool 0 has 9 rows while targets are shown; at least 20",
        ),
    ],
)
def test_a_record_that_cannot_be_used_is_refused(tmp_path, text, word):
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(InputError, match=word):
        assess([tmp_path / "bad.csv"])
