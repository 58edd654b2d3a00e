from dataclasses import replace

import numpy as np
import pytest

from bench_hw.tables import MarkerTable, TrialTable, write_trial_csv
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.description import Camera
from benchmark.files.sessions.doubts import (
    EITHER_WAY,
    check_markers,
    doubtful_forces,
    doubtful_kinds,
    doubtful_markers,
    doubtful_times,
    force_driven,
    pressed_negative,
)
from tests.benchmark.files.sessions.replicates import replicate


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
    assert EITHER_WAY in said


@pytest.mark.parametrize(("air", "power"), [(0.3e-3, 1.5), (0.0, 1.0), (0.0, 1.5)])
def test_a_press_whose_signs_are_surely_both_turned_is_read_as_with_the_right_ones(tmp_path, air, power) -> None:
    """It was used as it is, which gave 45.4 kPa (43.9 to 46.9) for 50.2."""
    one = replicate(3, air=air)
    one = replace(one, force=1.2 * np.sign(one.depth) * abs(one.depth / 2e-3) ** power * (one.depth > 0.0))
    rows = np.arange(len(one.time)) >= 200
    lifted = {name: values[rows] for name, values in (("depth", one.depth), ("force", one.force))}
    for sign, force in ((1, one.force), (-1, -one.force)):
        write_trial_csv(tmp_path / f"{sign}.csv", replace(one, depth=sign * one.depth, force=force))
    turned, right = load_session(tmp_path).trials
    assert turned.table.depth == pytest.approx(right.table.depth)
    assert turned.table.force == pytest.approx(right.table.force)
    assert not pressed_negative(replace(one, time=one.time[rows], **lifted))  # begins pressed, ends in air


def test_a_long_hold_whose_noise_is_deepest_at_its_end_is_no_slow_press():
    """A relaxation of 400 s by a row a second was asked whether its times are milliseconds."""
    time = np.arange(400.0)
    depth = 4e-4 * np.interp(time, [0.0, 2.0], [0.0, 1.0])
    depth[-1] += 1e-6
    assert doubtful_times(["relaxation"], [TrialTable(time, depth, 1e3 * depth, {}, "a.csv", {})]) == []


def test_times_in_milliseconds_are_asked_for():
    """A press of 5 s was one of an hour and a half, and its relaxation a thousand times as slow, without a word."""
    one = press()
    thousandfold, slow = (
        TrialTable(factor * one.time, one.depth, one.force, {}, "b.csv", {}) for factor in (1000.0, 20.0)
    )
    (said,) = doubtful_times(["seconds", "thousandfold", "slow"], [one, thousandfold, slow])
    assert said.endswith("where seconds are read: thousandfold (20 s from row to row, 4780 s in all)")


def test_what_a_turned_table_is_answered_by_reads_each_file_its_own_way(tmp_path):
    """Turning all by name, as was advised, left out the others; the numbers are those of the press positive."""
    tables = [replicate(seed, air=0.3e-3) for seed in range(4)]
    ways = [(1, 1), (1, -1), (-1, -1), (-1, -1)]
    for number, (table, (down, push)) in enumerate(zip(tables, ways, strict=True)):
        write_trial_csv(tmp_path / f"t{number}.csv", replace(table, depth=down * table.depth, force=push * table.force))
    (said,) = (text for text in load_session(tmp_path).warnings if "only fall" in text)
    assert said == "in 2 of 4 trials force and depth only fall as the tool presses: both are turned (t2.csv, t3.csv)"
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


@pytest.mark.parametrize(
    ("times", "said"),
    [
        ((1.0, 1.02, 1.6, 1.62), True),
        ((1.0, 1.02, 1.2, 1.22), False),  # specimens scatter so
        ((1.0, 1.15, 1.6, 1.75), False),  # no gap beside the spread
        ((1.0, 1.6, 1.62, 1.64), False),  # one odd trial is no kind
    ],
)
def test_trials_that_move_alike_under_two_tools_are_told_of(times, said):
    tables = [press(lambda force, fold=fold: fold * force) for fold in times]
    names = ["a", "b", "c", "d"]
    assert bool(doubtful_kinds(names, tables, ["slow"] * 4)) is said
    assert not doubtful_kinds(names, tables, ["slow", "slow", "wide", "wide"])


CAMERA = Camera(marker_rows=3, marker_columns=6, marker_spacing="8 mm")


def markers(x=1.0, y=1.0, clock=1.0, at=(0.0, 0.0), pictures=60):
    """Of a grid of 3 x 6 that is printed 2 % too large, in pictures over the first 4.8 s."""
    column, row = (each.ravel() for each in np.meshgrid(np.arange(6) - 2.5, np.arange(3) - 1.0))
    time, number = np.repeat(0.08 * clock * np.arange(pictures), 18), np.tile(np.arange(18), pictures)
    places = [1e-3 * origin + 8.16e-3 * factor * each for origin, factor, each in ((at[0], x, column), (at[1], y, row))]
    return MarkerTable(time, number, *(each[number] for each in places), source="a_markers.csv")


def test_markers_in_another_unit_or_at_other_times_are_refused_by_file() -> None:
    """Pixels, inches and milliseconds were fitted, or left out, without a word; discover ended by an IndexError."""
    check_markers(press(), markers(), CAMERA)
    wrong = {
        "at rest are 75.89 mm apart, camera.marker_spacing tells 8 mm (pixels, or another grid?)": (9.3, 1.0),
        "at rest are 0.3213 mm apart, camera.marker_spacing tells 8 mm (inch?); allowed: x_mm and": (0.03937, 1.0),
        "(cm?)": (0.1, 1.0),
        "from 0 to 4720 s, the trial from 0 to 4.78 s: 1 of 60 pictures lie within it (millisec": (1.0, 1000.0),
    }
    for said, (scale, clock) in wrong.items():
        with pytest.raises(InputError, match=r"^a_markers\.csv: ") as refused:
            check_markers(press(), markers(scale, scale, clock), CAMERA)
        assert said in str(refused.value)
    later = markers()
    later.time[:] += 100.0
    with pytest.raises(InputError, match=r"0 of 60 pictures lie within it \(another clock\?"):
        check_markers(press(), later, CAMERA)
    own_clock = CAMERA.model_copy(update={"clock": "press"})
    check_markers(press(), later, own_clock)
    with pytest.raises(InputError, match=r"\(milliseconds\?\)"):
        check_markers(press(), markers(clock=1000.0), own_clock)
    check_markers(press(), markers(pictures=3), CAMERA)


def test_markers_of_another_origin_or_a_mirrored_grid_are_told() -> None:
    tables = [markers(), markers(at=(34.0, 26.0)), markers(y=-1.0), markers(at=(3.0, 3.0)), markers(-1.0, -1.0)]
    corner, mirrored = doubtful_markers(["as told", "corner", "up", "off centre", "turned"], tables, CAMERA)
    assert corner.startswith("corner: the middle of the markers is at (34, 26) mm, so that the origin of x_mm and y_mm")
    assert mirrored.startswith("up: the markers' grid is mirrored")


def held(seed, *, by_force=True, tau=2.0, share=0.4, follows=0.0, limit=np.inf, plateau=False, scatter=3e-6):
    """A gel held for 10 s under a force, or at a depth under which its force decays; its depth scatters (m)."""
    rng, time = np.random.default_rng([seed, 3]), np.arange(0.0, 16.0, 0.05)
    ramp = np.clip((time - 1.0) / 0.5, 0.0, 1.0) - np.clip((time - 11.5) / 0.5, 0.0, 1.0)
    slow = np.zeros(time.size)
    for row in range(1, time.size):
        slow[row] = slow[row - 1] + 0.05 / tau * (ramp[row] - slow[row - 1])
    depth, force = (ramp + share * slow, ramp + follows * slow) if by_force else (ramp, ramp - share * slow)
    if plateau:  # a foam that gives way at one force, pressed at one speed
        depth = np.clip((time - 1.0) / 10.0, 0.0, 1.0) - np.clip((time - 11.5) / 0.5, 0.0, 1.0)
        force = np.minimum(8.0 * depth, 0.8)
    read = 4e-4 * depth + scatter * rng.normal(size=time.size)
    return TrialTable(time, read, 0.09 * np.minimum(force, limit) + 3e-4 * rng.normal(size=time.size), {}, "a.csv", {})


@pytest.mark.parametrize(
    ("options", "driven"),
    [
        ({}, True),
        ({"tau": 5.0}, True),
        ({"by_force": False}, False),
        ({"by_force": False, "share": 0.0}, False),  # elastic: both stand, whichever was prescribed
        ({"share": 0.0}, False),
        ({"share": 0.05, "scatter": 3e-8}, True),
        ({"share": 0.05, "scatter": 3e-8, "follows": 0.008}, False),  # a stage creeps to its target, the force along
        ({"by_force": False, "share": 0.2, "limit": 0.6}, False),  # a sensor at its end
        ({"by_force": False, "plateau": True}, False),
    ],
)
def test_a_prescribed_force_is_told_by_a_depth_that_creeps_on_while_it_stands(options, driven):
    assert force_driven([held(seed, **options) for seed in range(4)]) is driven


def test_a_force_that_stands_over_creep_in_some_trials_is_asked_for():
    some = [held(0), held(1), held(2, by_force=False, share=0.0), held(3, by_force=False, share=0.0)]
    assert force_driven(some) is None
    assert force_driven([held(0), held(1)]) is None


@pytest.mark.parametrize(("told", "drive"), [(None, "force"), ("depth", "depth"), ("force", "force")])
def test_a_session_is_driven_by_force_where_its_trials_show_it_and_nobody_says_else(tmp_path, told, drive):
    for seed in range(3):
        write_trial_csv(tmp_path / f"{seed}.csv", held(seed))
    trials = "".join(f'[[trials]]\nfile = "{seed}.csv"\ncondition = "held"\n' for seed in range(3))
    channel = "" if told is None else f'[drive]\nchannel = "{told}"\n'
    (tmp_path / "session.toml").write_text(f'schema = 1\nname = "weights"\n{channel}{trials}')
    session = load_session(tmp_path)
    assert session.drive == drive
    assert any('say [drive] channel = "force"' in text for text in session.warnings) is (told is None)
