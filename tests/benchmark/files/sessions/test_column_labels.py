from dataclasses import replace

import numpy as np
import pytest

from bench_hw.tables import write_trial_csv
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.column_labels import check_labels
from benchmark.files.sessions.description import ImportTable, TrialEntry
from benchmark.files.sessions.recordings import Recording
from tests.benchmark.files.sessions.replicates import replicate


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
