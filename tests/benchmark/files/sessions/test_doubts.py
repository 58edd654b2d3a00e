from dataclasses import replace

import numpy as np
import pytest

from bench_hw.tables import TrialTable, write_trial_csv
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.description import ImportTable, TrialEntry
from benchmark.files.sessions.doubts import EITHER_WAY, check_labels, doubtful_forces, doubtful_times
from benchmark.files.sessions.recordings import Recording


def press(force=None):
    depth = np.concatenate([np.linspace(-0.3, 2.0, 120), np.linspace(2.0, -0.3, 120)]) * 1e-3
    clean = np.clip(1e3 * depth, 0.0, None) ** 1.5 + 1e-3 * np.random.default_rng(1).normal(size=depth.size)
    return TrialTable(0.02 * np.arange(depth.size), depth, clean if force is None else force(clean), {}, "a.csv", {})


def glitch(force):
    return np.where(np.arange(force.size) == 70, 9999.9, force)


def test_a_force_that_no_tissue_makes_is_told():
    """A sensor at its end and a glitch of one row went into the fit without a word."""
    tables = [press(), press(lambda force: np.minimum(force, 1.5)), press(glitch), press(lambda force: force.round(1))]
    end, lone = doubtful_forces(["whole", "end", "lone", "coarse"], tables)
    assert "end: the force stands at 1.5 N" in end
    assert "lone: the force is 9999.9 N at 1.4 s, in a single row" in lone


def test_a_press_upside_down_is_told():
    """Among others it went into the fit as one that touches at its deepest, without a word."""
    one = press()
    turned = TrialTable(one.time, -one.depth, -one.force, {}, "b.csv", {})
    pulled = TrialTable(
        one.time, one.depth, one.force - 0.2 * np.exp(-(((one.time - 4.6) / 0.1) ** 2)), {}, "c.csv", {}
    )
    (said,) = doubtful_forces(["up", "down", "pulled"], [one, turned, pulled])
    assert said.startswith("down: force and depth only fall, to -2.8")
    assert "-2 mm" in said


def test_times_in_milliseconds_are_asked_for():
    """A press of 5 s was one of an hour and a half, and its relaxation a thousand times as slow, without a word."""
    one = press()
    thousandfold, slow = (
        TrialTable(factor * one.time, one.depth, one.force, {}, "b.csv", {}) for factor in (1000.0, 20.0)
    )
    (said,) = doubtful_times(["seconds", "thousandfold", "slow"], [one, thousandfold, slow])
    assert said.endswith("where seconds are read: thousandfold (20 s from row to row, 4780 s in all)")


def replicate(seed, scatter=0.03, deepest=2e-3, air=0.0):
    """A synthetic press of a flat punch, F = k d with 600 N/m (Hayes' linear law), 2 mN of noise, 2 mm and back."""
    random = np.random.default_rng(seed)
    time = np.linspace(0.0, 4.0, 400)
    depth = (deepest + air) * (1.0 - np.abs(time / 2.0 - 1.0)) - air
    stiffness = 600.0 * np.exp(scatter * random.standard_normal())
    force = stiffness * np.clip(depth, 0.0, None) + 2e-3 * random.standard_normal(time.size)
    return TrialTable(time, depth + 5e-7 * random.standard_normal(time.size), force, {}, "", {})


def refusal(tables, told=None, conditions=None, own=None):
    """What `check_labels` says of tables as files t0.csv, t1.csv...; "" where it takes them."""
    names = conditions or ["press"] * len(tables)
    entries = [TrialEntry(file=f"t{k}.csv", condition=name) for k, name in enumerate(names)]
    if own:
        entries[-1] = TrialEntry(file=entries[-1].file, condition=names[-1], **{"import": own})
    read = [Recording(entry, "", table) for entry, table in zip(entries, tables, strict=True)]
    try:
        check_labels(read, ImportTable(**(told or {})), dict.fromkeys(names, "one tool"))
    except InputError as error:
        return str(error)
    return ""


OTHER_UNITS = [
    ("force", 1e3, "force_N:mN"),
    ("force", 101.97, "force_N:gf"),
    ("force", 1.0 / 9.80665, "force_N:kgf"),
    ("force", 1e-3, "force_N:kN"),
    ("depth", 1e-3, "depth_mm:m"),
    ("depth", 1e3, "depth_mm:um"),
    ("depth", 0.1, "depth_mm:cm"),
    ("time", 1e3, "time_s:ms"),
]


@pytest.mark.parametrize(("channel", "factor", "meant"), OTHER_UNITS)
def test_one_trial_of_ten_in_another_unit_is_refused_with_it(channel, factor, meant):
    """One in mN among nine in N went into the fit: 44 kPa (9 to 212) where 22 are true."""
    tables = [replicate(seed) for seed in range(10)]
    odd = replace(tables[-1], **{channel: factor * getattr(tables[-1], channel)})
    assert refusal(tables) == ""
    said = refusal([*tables[:-1], odd])
    assert said.startswith(f"t9.csv: {meant.partition(':')[0]!r} is ")
    assert f'import = {{ {channel} = "{meant}" }}' in said
    assert refusal([*tables[:-1], odd], own={channel: meant}) == ""
    assert refusal([*tables[:-1], odd], told={channel: meant}) == ""


def test_a_trial_in_another_unit_is_refused_in_a_condition_of_its_own():
    """`session new` puts a press of another depth into one; other speeds there are no other unit of time."""
    tables = [replicate(seed) for seed in range(5)]
    conditions = ["press"] * 4 + ["other"]
    assert '"depth_mm:m"' in refusal([*tables[:4], replace(tables[4], depth=1e-3 * tables[4].depth)], None, conditions)
    assert refusal([*tables[:4], replace(tables[4], time=1e3 * tables[4].time)], None, conditions) == ""


def test_what_specimens_may_be_is_no_unit():
    """Scatter, single soft specimens, presses of other depths, empty presses and two trials tell no unit."""
    tables = [replicate(seed) for seed in range(9)]
    soft, empty = (replace(tables[8], force=factor * tables[8].force) for factor in (1.0 / 4.4, 1e-3))
    noise = 2e-3 * np.random.default_rng(1).standard_normal(400)
    assert refusal([*tables[:8], soft]) == ""
    assert refusal([*tables[:8], replace(empty, force=empty.force + noise)]) == ""
    assert refusal([*tables[:8], replicate(8, deepest=0.2e-3)]) == ""
    assert refusal([tables[0], replace(tables[1], force=1e3 * tables[1].force)]) == ""
    wild = [replicate(seed, scatter=0.8) for seed in range(8)]
    assert refusal([*wild, replace(wild[0], force=0.1 * wild[0].force)]) == ""


def exchanged(table):
    """The table with force in the column of the depth (mm) and depth in that of the force."""
    return replace(table, depth=1e-3 * table.force, force=1e3 * table.depth)


def test_exchanged_columns_are_refused():
    """The force is what stands and scatters in air, and what is as large a number as the others' force."""
    tables = [replicate(seed, air=0.3e-3) for seed in range(6)]
    said = refusal([exchanged(table) for table in tables])
    assert said.startswith("t0.csv (and 5 more files): over the first 27 rows the force rises evenly by 0.299 N")
    assert '--set import.depth="force_N:mm" --set import.force="depth_mm:N", or where all is right' in said
    tables = [replicate(seed) for seed in range(6)]
    said = refusal([*tables[:5], exchanged(tables[5])])
    assert "t5.csv: depth to 1.17 mm and force to 1.96 N" in said
    assert "where 5 other trials come to 2 mm and 1.18 N" in said
    assert 'import = { depth = "force_N:mm", force = "depth_mm:N" }' in said
    true = {"depth": "depth_mm:mm", "force": "force_N:N"}
    assert refusal([*tables[:5], exchanged(tables[5])], own=true) == ""


def test_true_columns_with_air_holds_and_coarse_counts_are_taken():
    table = replicate(1, air=0.5e-3)
    counted = replace(table, depth=np.round(table.depth / 5e-5) * 5e-5)
    held = np.clip(table.depth, None, 1e-3)
    relaxing = replace(table, depth=held, force=600.0 * np.clip(held, 0.0, None) * np.exp(-0.1 * table.time))
    for one in (table, counted, relaxing):
        assert refusal([one]) == ""


def test_what_is_told_of_one_file_is_read_so(tmp_path):
    tables = [replicate(seed) for seed in range(5)]
    for number, table in enumerate(tables):
        factor = 1e3 if number == 4 else 1.0
        write_trial_csv(tmp_path / f"t{number}.csv", replace(table, force=factor * table.force))
    with pytest.raises(InputError, match=r"t4\.csv: 'force_N' is 974 times"):
        load_session(tmp_path)
    entries = "".join(f'[[trials]]\nfile = "t{number}.csv"\ncondition = "press"\n' for number in range(5))
    text = f'schema = 1\nname = "s"\n{entries}import = {{ force = "force_N:mN" }}\n'
    (tmp_path / "session.toml").write_text(text, encoding="utf-8")
    session = load_session(tmp_path)
    assert session.trials[4].table.force == pytest.approx(tables[4].force, abs=1e-9)
    assert "in 1 of 5 trials the force is read in mN, as told, where the file says N (t4.csv)" in session.warnings


def test_what_a_turned_table_is_answered_by_reads_each_file_its_own_way(tmp_path):
    """Turning all by name, as was advised, left out the others; the numbers are those of the press positive."""
    tables = [replicate(seed, air=0.3e-3) for seed in range(4)]
    ways = [(1, 1), (1, -1), (-1, -1), (-1, -1)]
    for number, (table, (down, push)) in enumerate(zip(tables, ways, strict=True)):
        write_trial_csv(tmp_path / f"t{number}.csv", replace(table, depth=down * table.depth, force=push * table.force))
    (said,) = (text for text in load_session(tmp_path).warnings if "only fall" in text)
    assert said.startswith("t2: force and depth only fall, to -1.2")
    assert "(so do t3)" in said
    assert EITHER_WAY in said
    session = load_session(tmp_path, {"import.force": "force_N:N", "import.depth": "depth_mm:mm"})
    for trial, table in zip(session.trials, tables, strict=True):
        assert trial.table.force == pytest.approx(table.force, abs=1e-9)
        assert trial.table.depth == pytest.approx(table.depth, abs=1e-9)
    where = "in 3 of 4 trials the force falls as the tool presses: force [N] is turned (t1.csv, t2.csv, t3.csv)"
    assert where in session.warnings


WRITTEN_OTHERWISE = {
    "units in cells": lambda t, d, f: f"{t},{d},{f} N",
    "clocks": lambda t, d, f: f"12:00:{t:06.3f},{d},{f}",
}


@pytest.mark.parametrize("name", WRITTEN_OTHERWISE)
def test_what_a_strict_table_is_answered_by_reads_it(tmp_path, name):
    table = replicate(1)
    rows = zip(table.time.round(3), (1e3 * table.depth).round(6), table.force.round(6), strict=True)
    lines = [WRITTEN_OTHERWISE[name](*row) for row in rows]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["time_s,depth_mm,force_N", *lines]), encoding="utf-8")
    with pytest.raises(InputError, match=r'read by --set import\.force="force_N:N"'):
        load_session(path)
    (trial,) = load_session(path, {"import.force": "force_N:N"}).trials
    assert trial.table.force == pytest.approx(table.force, abs=1e-5)
    lines[7] = "0.070,,"
    path.write_text("\n".join(["time_s,depth_mm,force_N", *lines]), encoding="utf-8")
    with pytest.raises(InputError, match=r"import\.drop_empty=true"):
        load_session(path)
    assert len(load_session(path, {"import.drop_empty": "true"}).trials[0].table.time) == 399
