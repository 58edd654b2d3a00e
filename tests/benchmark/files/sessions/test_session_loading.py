import os
from pathlib import Path

import numpy as np
import pytest

from bench_hw.storage.folder_lock import locked
from bench_hw.trial_file import ForceRecord, PositionRecord, TrialHeader, open_trial
from bench_hw.trial_file.recovery import recover_trial
from bench_hw.trial_file.scan import scan_trial
from benchmark.errors import InputError
from benchmark.files import load_session, load_tissue
from benchmark.files.load import Load
from benchmark.files.sessions.proposal import propose, write_proposal
from benchmark.files.tool import Support, Tool
from tests.instruments.samples import jpk, press, rows

DATA = os.environ.get("TISSUEBENCH_DATA")


def refusal(*arguments, **keywords):
    with pytest.raises(InputError) as error:
        load_session(*arguments, **keywords)
    said = str(error.value)
    assert "\n" not in said
    return said


def test_a_session_file(session_folder):
    session = load_session(session_folder)
    assert (session.name, session.folder, session.drive) == ("two presses", session_folder, "depth")
    assert (session.synthetic, session.camera, session.specimen_assumed) == (False, None, False)
    assert session.specimen == load_tissue("skin_forearm")
    assert [(trial.name, trial.condition) for trial in session.trials] == [("one", "slow"), ("two", "fast")]
    assert session.conditions == ("slow", "fast")
    assert session.trials[0].tool == session.tool == Tool(radius=5e-3, contact="rigid_bonded")
    assert session.trials[0].support == session.support == Support()
    assert len(session.trials[0].table.time) == 30
    assert len(session.warnings) == 4


def test_plain_files(tmp_path, write_trial):
    for name in ("one.csv", "two.csv"):
        write_trial(tmp_path / "day" / name)
    session = load_session(tmp_path / "day")
    assert (session.name, session.conditions) == ("day", ("day",))
    assert session.specimen_assumed
    assert session.specimen.thickness == 8e-3
    assert len(session.warnings) == 5
    assert any("the specimen is not given" in warning for warning in session.warnings)
    said = " ".join(session.warnings)
    assert all(f"--set {key}=" in said for key in ("tool.radius", "tool.contact", "support.kind", "specimen.thickness"))


def test_a_tool_that_no_bench_has_is_asked_about(session_folder):
    said = load_session(session_folder, {"tool.radius": "4 m"}).warnings
    assert [each for each in said if "more than any bench has" in each] == [
        'tool.radius is 4 m, more than any bench has (500 mm): is another unit meant, such as "4 mm"?'
    ]


def test_a_recording_that_was_cut_off_beside_trials_is_said_to_be_left_aside(session_folder):
    part = session_folder / "trial_003.mcap.part"
    before = load_session(session_folder).warnings
    part.write_bytes(b"half")
    (said,) = set(load_session(session_folder).warnings) - set(before)
    assert said == (
        "trial_003.mcap.part is a recording that was cut off and is left aside; save what is whole in it: "
        f"python -m bench_hw recover {part} --out NEW.mcap"
    )
    with locked(session_folder, "capture"):
        assert "trial_003.mcap.part is still being recorded and is left aside" in load_session(session_folder).warnings
    assert not any("trial_003" in each for each in load_session(session_folder / "one.csv").warnings)


def test_a_cut_recording_of_a_condition_is_seen(tmp_path, write_trial):
    write_trial(tmp_path / "day" / "slow" / "one.csv")
    (tmp_path / "day" / "slow" / "two.mcap.part").write_bytes(b"half")
    assert any(each.startswith("two.mcap.part is a recording") for each in load_session(tmp_path / "day").warnings)


def test_plain_files_without_a_gap(tmp_path, write_trial):
    session = load_session(write_trial(tmp_path / "one.csv", gap=None))
    assert session.specimen.thickness == 10e-3


def test_a_folder_of_native_trials_is_as_synthetic_as_they_are(tmp_path, write_native_trial):
    write_native_trial(tmp_path / "day" / "one.mcap", synthetic=False)
    assert not load_session(tmp_path / "day").synthetic
    write_native_trial(tmp_path / "day" / "two.mcap", synthetic=True)
    session = load_session(tmp_path / "day")
    assert session.synthetic
    assert [trial.name for trial in session.trials] == ["one", "two"]


ENDED = "two.mcap was ended by a fault (force_limit at 2.950 s: force of 6.1 N) and is "


def test_a_trial_that_a_fault_ended_is_left_aside_where_nobody_listed_it(tmp_path, write_native_trial):
    write_native_trial(tmp_path / "day" / "one.mcap", synthetic=False)
    write_native_trial(tmp_path / "day" / "two.mcap", synthetic=False, fault="force of 6.1 N")
    session = load_session(tmp_path / "day")
    assert [trial.name for trial in session.trials] == ["one"]
    assert f"{ENDED}left aside; where it is wanted, list it in a session.toml" in session.warnings
    assert propose(tmp_path / "day").warnings == tuple(each for each in session.warnings if each.startswith(ENDED))
    (tmp_path / "day" / "one.mcap").unlink()
    assert f"no file holds a trial; allowed: tables with time, depth and force. {ENDED}left aside" in refusal(
        tmp_path / "day"
    )


def test_a_trial_that_a_fault_ended_is_used_and_told_where_it_is_asked_for(tmp_path, write_native_trial):
    alone = write_native_trial(tmp_path / "two.mcap", synthetic=False, fault="force of 6.1 N")
    assert f"{ENDED}used as it is" in load_session(alone).warnings
    listed = 'schema = 1\nname = "one"\n[[trials]]\nfile = "two.mcap"\ncondition = "press"\n'
    (tmp_path / "session.toml").write_text(listed)
    session = load_session(tmp_path)
    assert len(session.trials) == 1
    assert f"{ENDED}used as it is" in session.warnings


def test_a_trial_that_was_recovered_is_told(tmp_path, write_native_trial):
    whole = write_native_trial(tmp_path / "whole.mcap", synthetic=False)
    cut = tmp_path / "cut.mcap.part"
    cut.write_bytes(whole.read_bytes()[: scan_trial(whole).chunks[-1].end])
    recover_trial(cut, tmp_path / "day" / "saved.mcap")
    (said,) = [each for each in load_session(tmp_path / "day").warnings if each.startswith("saved.mcap")]
    assert said.startswith("saved.mcap was recovered from a recording that had lost something (bytes ")
    assert len(load_session(tmp_path / "day").trials) == 1


def test_everything_can_be_given_on_the_command_line(tmp_path, write_trial):
    write_trial(tmp_path / "day" / "one.csv")
    given = {
        "tool.radius": "3 mm",
        "tool.contact": "rigid_bonded",
        "support.kind": "hole",
        "support.hole_radius": "30 mm",
        "dermis.youngs_modulus": "120 kPa",
        "synthetic": "true",
        "drive.channel": "force",
        "name": "mine",
    }
    session = load_session(tmp_path / "day", given, specimen="skin_forearm")
    assert session.warnings == ()
    assert session.trials[0].tool.radius == 3e-3
    assert session.trials[0].support == Support(kind="hole", hole_radius=30e-3)
    assert session.specimen.layer("dermis").youngs_modulus == 120e3
    assert (session.synthetic, session.drive, session.name, session.specimen_assumed) == (True, "force", "mine", False)
    assert load_session(tmp_path / "day", {**given, "specimen": "skin_forearm"}).specimen == session.specimen


def test_the_assumed_layer_can_be_changed(tmp_path, write_trial):
    session = load_session(write_trial(tmp_path / "one.csv"), {"specimen.thickness": "12 mm"})
    assert session.specimen.thickness == 12e-3
    assert session.specimen_assumed


def test_a_condition_has_its_own_tool(session_folder):
    path = session_folder / "session.toml"
    path.write_text(path.read_text() + '[tool]\nradius = "4 mm"\n[conditions.fast.tool]\nradius = "2 mm"\n')
    session = load_session(session_folder)
    assert [trial.tool.radius for trial in session.trials] == [4e-3, 2e-3]
    assert session.tool.radius == 4e-3
    session = load_session(session_folder, {"tool.radius": "3 mm", "conditions.slow.tool.radius": "1 mm"})
    assert [trial.tool.radius for trial in session.trials] == [1e-3, 2e-3]


def test_a_condition_whose_name_has_a_dot_can_be_set(tmp_path, write_trial):
    write_trial(tmp_path / "s" / "1.5mm" / "a.csv")
    session = load_session(tmp_path / "s", {"conditions.1.5mm.tool.radius": "1 mm"})
    assert session.trials[0].tool.radius == 1e-3


def test_markers_need_a_camera(session_folder, change):
    markers = session_folder / "markers.csv"
    rows = [f"{0.1 * row:.1f},{marker},{marker},0" for row in range(30) for marker in range(3)]
    markers.write_text("time_s,marker,x_mm,y_mm\n" + "\n".join(rows) + "\n")
    change(session_folder / "session.toml", 'condition = "slow"', 'condition = "slow"\nmarkers = "markers.csv"')
    session = load_session(session_folder)
    assert session.trials[0].markers is None
    assert any("[camera] does not give their layout" in warning for warning in session.warnings)
    grid = {"camera.marker_rows": "2", "camera.marker_columns": "2", "camera.marker_spacing": "1 mm"}
    session = load_session(session_folder, grid)
    assert session.trials[0].markers.marker.max() == 2
    assert session.trials[1].markers is None
    assert session.camera.marker_spacing == 1e-3
    assert any("one: the middle of the markers is at (1, 0) mm" in warning for warning in session.warnings)
    said = refusal(session_folder, {**grid, "camera.marker_spacing": "1 inch"})
    assert (
        "markers.csv: x_mm, y_mm: markers at rest are 1 mm apart, camera.marker_spacing tells 25.4 mm (inch?)" in said
    )


def test_the_fingerprint_covers_every_file(session_folder, tissue_file, change):
    (session_folder / "mine.toml").write_text(tissue_file.read_text())
    change(session_folder / "session.toml", '"skin_forearm"', '"mine.toml"')
    seen = {load_session(session_folder).fingerprint}
    for name in ("one.csv", "session.toml", "mine.toml"):
        (session_folder / name).write_text((session_folder / name).read_text().replace("\n", " \n", 1))
        seen.add(load_session(session_folder).fingerprint)
    assert len(seen) == 4
    assert load_session(session_folder, {"tool.radius": "3 mm"}).fingerprint in seen


def test_settings_of_scenarios_are_checked_and_handed_on(session_folder):
    session = load_session(session_folder, {"fem.mesh": "coarse", "tool.radius": "3 mm"})
    assert session.settings == {"fem.mesh": "coarse"}
    press = session.scenario(session.specimen, session.tool, session.support, Load(peak=2.0))
    assert (press.name, press.tissue, press.tool.radius) == ("two presses", session.specimen, 3e-3)
    assert (press.fem.mesh, press.load.peak) == ("coarse", 2.0)
    assert "--set fem.mesh: 'cors' is not allowed" in refusal(session_folder, {"fem.mesh": "cors"})
    assert "--set wave.windw: this key is not known" in refusal(session_folder, {"wave.windw": "1 mm"})


def test_a_tool_that_no_press_can_have_is_refused_at_once(session_folder):
    rubbing = {"conditions.fast.tool.contact": "rigid_frictional"}
    assert "physics.friction_coefficient" in refusal(session_folder, rubbing)
    session = load_session(session_folder, {**rubbing, "physics.friction_coefficient": "0.3"})
    assert session.trials[1].tool.contact == "rigid_frictional"


def test_a_touching_tool_without_an_edge_gets_one_and_the_session_says_so(session_folder):
    session = load_session(session_folder, {"conditions.fast.tool.contact": "rigid_frictionless"})
    slow, fast = session.trials[0].tool, session.trials[1].tool
    assert slow.edge_radius is None
    assert fast.edge_radius == pytest.approx(0.1 * fast.radius)
    assert any("assumed rounded" in each for each in session.warnings)


def test_a_specimen_without_an_end_needs_a_half_space(session_folder, tissue_file, change):
    change(tissue_file, 'thickness = "10 mm"\n', "")
    assert "the last layer 'fat' has no thickness" in refusal(session_folder, specimen=tissue_file)
    session = load_session(session_folder, {"support.kind": "half_space"}, specimen=tissue_file)
    assert session.trials[0].support.kind == "half_space"


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"tol.radius": "3 mm"}, "--set tol.radius: this key is not known; did you mean tool.radius"),
        ({"tool.radius": "3 kPa"}, "--set tool.radius: '3 kPa' is a pressure"),
        ({"tool.radus": "3 mm"}, "--set tool.radus: this key is not known; did you mean radius"),
        ({"dermi.thickness": "1 mm"}, "--set dermi.thickness: this key is not known; did you mean dermis.thickness"),
        ({"dermis.thickness": "-1 mm"}, "--set dermis.thickness: '-1 mm' is outside"),
        ({"conditions.slow.tool.radius": "0 mm"}, "--set conditions.slow.tool.radius: '0 mm' is outside"),
        ({"conditions.slo.tool.radius": "1 mm"}, "no trial has this condition; did you mean slow"),
        ({"specimen": "skin_forarm"}, "did you mean skin_forearm"),
        ({"trials": "5"}, "--set trials: 5 is no list"),
    ],
)
def test_a_bad_override_names_its_key(session_folder, overrides, says):
    assert says in refusal(session_folder, overrides)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("schema = 1", "schema = 2", "line 1, schema: 2 is not a schema"),
        ("schema = 1", "", "the key schema is missing; a session file begins with schema = 1"),
        ('"one.csv"', '"../press.csv"', "line 6, trials[#1].file: '../press.csv' is outside the session's folder"),
        ('"one.csv"', '"none.csv"', "line 6, trials[#1].file: there is no file 'none.csv'"),
        ('"skin_forearm"', '"skin_forarm"', "line 3, specimen: no tissue 'skin_forarm' ships"),
        ('"skin_forearm"', '"../slab.toml"', "line 3, specimen: '../slab.toml' is outside the session's folder"),
        ('"skin_forearm"', '"none.toml"', "line 3, specimen: there is no file 'none.toml'"),
        ("[[trials]]", "[[trial]]", "this key is not known; did you mean trials?"),
    ],
)
def test_a_bad_session_file_is_refused_with_line_and_key(session_folder, change, old, new, says):
    assert says in refusal(change(session_folder / "session.toml", old, new))


def test_one_bad_trial_refuses_the_session(session_folder, write_trial):
    write_trial(session_folder / "two.csv", rows=3)
    assert "two.csv: the table has 3 rows" in refusal(session_folder)


def test_a_missing_camera_file_is_refused(session_folder):
    grid = {"camera.marker_rows": "2", "camera.marker_columns": "2", "camera.marker_spacing": "1 mm"}
    assert "there is no file 'camera.toml'" in refusal(session_folder, {**grid, "camera.file": "camera.toml"})


def test_a_file_listed_twice_is_said(session_folder, change):
    change(session_folder / "session.toml", '"two.csv"', '"one.csv"')
    session = load_session(session_folder)
    assert [trial.name for trial in session.trials] == ["one.csv #1", "one.csv #2"]
    assert any("more than one trial: one.csv" in warning for warning in session.warnings)


def test_copies_of_one_trial_are_said(tmp_path, write_trial):
    for name in ("one.csv", "one - copy.csv"):
        write_trial(tmp_path / "day" / name)
    write_trial(tmp_path / "day" / "other.csv", rows=31)
    (said,) = (text for text in load_session(tmp_path / "day").warnings if "the same numbers" in text)
    assert "one - copy, one;" in said
    assert "other" not in said


def turned(path, force="-", depth=""):
    lines = (f"{0.1 * n:.1f},{depth}{0.05 * n:.2f},{force}{0.01 * n:.2f}" for n in range(30))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(["time_s,depth_mm,force_N", *lines]) + "\n")
    return path


def test_what_is_said_of_a_column_holds_for_the_benchs_own_table(tmp_path):
    """It was passed over without a word."""
    turned(tmp_path / "day" / "one.csv")
    (trial,) = load_session(tmp_path / "day", {"import.force": "-force_N:N"}).trials
    np.testing.assert_allclose(trial.table.force, 0.01 * np.arange(30), atol=1e-12)
    np.testing.assert_allclose(trial.table.depth, 0.05e-3 * np.arange(30), atol=1e-12)
    assert "no column is called so" not in str(load_session(tmp_path / "day", {"import.force": "Load:N"}).warnings)


def test_rows_without_a_number_are_left_out_of_the_benchs_own_table_where_told(tmp_path, write_trial):
    path = write_trial(tmp_path / "day" / "one.csv")
    path.write_text(path.read_text().replace("0.5,0.25,0.05,", "0.5,0.25,NaN,"))
    assert "one.csv (row 7, column 'force_N', value 'NaN')" in refusal(tmp_path / "day")
    (trial,) = load_session(tmp_path / "day", {"import.drop_empty": "true"}).trials
    assert trial.table.time.size == 29
    assert trial.table.depth[0] == 0.0


def test_a_depth_that_is_never_positive_is_no_question_of_the_tool(tmp_path):
    turned(tmp_path / "day" / "one.csv", force="", depth="-")
    said = refusal(tmp_path / "day")
    assert "the depth is never above zero (down to -1.45 mm)" in said
    assert "--set import.depth" in said


def test_a_recording_that_ended_before_the_touch_is_not_to_be_turned(tmp_path):
    header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", 0.0, synthetic=True)
    with open_trial(tmp_path / "trial_001.mcap", header, background=False) as writer:
        for number in range(100):
            writer.write_force(ForceRecord(number / 100, number, number, 0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
            writer.write_position(PositionRecord(number / 100, -2e-3 + 1e-5 * number))
    said = refusal(tmp_path)
    assert "the depth is never above zero (down to -2 mm)" in said
    assert "ended before its tool touched" in said
    assert "import.depth" not in said


@pytest.mark.skipif(DATA is None, reason="measured data: set TISSUEBENCH_DATA to the folder that holds pig_indentation")
@pytest.mark.parametrize(("day", "trials"), [("2023-03-27", 17), ("2023-03-31", 49), ("2023-04-03", 29)])
def test_measured_tissue_loads(day, trials):
    session = load_session(Path(str(DATA)) / "pig_indentation" / day)
    assert len(session.trials) == trials
    assert session.conditions == (day,)
    assert 10e-3 < session.specimen.thickness < 25e-3
    assert not session.synthetic


@pytest.mark.skipif(DATA is None, reason="measured data: set TISSUEBENCH_DATA to the folder that holds pig_indentation")
def test_days_of_measured_tissue_are_conditions():
    session = load_session(Path(str(DATA)) / "pig_indentation")
    assert session.conditions == ("2023-03-27", "2023-03-31", "2023-04-03")
    assert len({trial.name for trial in session.trials}) == len(session.trials) == 95


def test_an_instruments_file_is_a_session(tmp_path):
    """Two tests side by side in one file are two trials; the header's probe is the tool; nothing is asked."""
    from tests.instruments.samples import exponent_text

    session = load_session(exponent_text(tmp_path))
    assert [trial.name for trial in session.trials] == ["exponent 1", "exponent 2"]
    assert {trial.tool.radius for trial in session.trials} == {5e-3}
    assert any("Probe: P/10 10mm DIA CYLINDER" in text for text in session.warnings)
    assert any("Force from" in line or "force from Force [g]" in line for line in session.shown)
    assert not any("radius is not given" in text for text in session.warnings)


def test_notes_beside_trials_are_left_aside_and_said(tmp_path):
    from tests.instruments.samples import cellscale

    cellscale(tmp_path)
    (tmp_path / "notes.txt").write_text("gel from Tuesday\n")
    session = load_session(tmp_path)
    assert [trial.name for trial in session.trials] == ["cellscale"]
    assert any("notes.txt holds no rows of numbers" in text for text in session.warnings)
    assert session.specimen.layers[0].thickness == pytest.approx(12e-3, rel=0.01)


def test_a_stray_table_says_what_may_be_done_with_it(tmp_path, write_trial):
    write_trial(tmp_path / "day" / "one.csv")
    (tmp_path / "day" / "summary.csv").write_text("trial,peak\none,1.5\n")
    said = refusal(tmp_path / "day")
    assert "summary.csv" in said
    assert "Where it is no trial, keep it elsewhere, or list the trials in session.toml." in said


def test_columns_are_named_by_options_of_the_session(tmp_path, write_trial):
    lines = (f"{n / 50:.2f},{n / 500:.4f},{-max(n - 20, 0) / 300:.5f}" for n in range(100))
    (tmp_path / "odd.csv").write_text("\n".join(["a,b,c", *lines]))
    with pytest.raises(InputError, match=r'no column is the force.*--set import.force="COLUMN:N"'):
        load_session(tmp_path)
    told = {"import.time": "a:s", "import.depth": "b:mm", "import.force": "-c:N"}
    (trial,) = load_session(tmp_path, told).trials
    assert trial.table.force.max() == pytest.approx(79 / 300, abs=1e-5)


def test_the_tool_of_an_atomic_force_curve_is_asked_for(tmp_path):
    pytest.importorskip("afmformats")
    curve = jpk(tmp_path)
    with pytest.raises(InputError, match=r"condition curve: pressed 2 um deep.*--set tool\.radius"):
        load_session(curve)
    told = load_session(
        curve, {"tool.radius": "5 um", "tool.edge_radius": "5 um", "tool.contact": "rigid_frictionless"}
    )
    assert told.tool.radius == 5e-6


def test_a_trial_that_is_added_but_not_listed_is_told_of(session_folder, write_trial):
    """It was passed over without a word."""
    assert not any("not listed" in each for each in load_session(session_folder).warnings)
    for name in ("three.csv", ".four.csv", "~$one.csv", "one_markers.csv", "notes.txt"):
        write_trial(session_folder / name)
    (said,) = [each for each in load_session(session_folder).warnings if "not listed" in each]
    assert said.startswith("not listed in session.toml and left aside: three.csv; ")


def test_a_film_that_no_trial_names_is_told_of(tmp_path, write_trial):
    """A folder of forces, a film and a camera's file was proposed, and fitted, without a word of the film."""
    write_trial(tmp_path / "one.csv")
    (tmp_path / "film.MP4").write_bytes(b"")
    for warnings in (load_session(tmp_path).warnings, propose(tmp_path).warnings):
        (said,) = [each for each in warnings if "film" in each]
        assert said.startswith("films that no trial names are left aside: film.MP4; ")
        assert 'film = "film.MP4" in the [[trials]] it belongs to' in said
    assert not any("film" in each for each in load_session(tmp_path / "one.csv").warnings)


def test_what_a_proposal_assumed_is_told_until_somebody_says_it(tmp_path, write_trial):
    """With the proposed files in the folder nothing was said to be assumed any more."""
    write_trial(tmp_path / "one.csv")
    write_proposal(tmp_path, propose(tmp_path))
    (said,) = [each for each in load_session(tmp_path).warnings if "still assumed" in each]
    assert said.endswith(": tool.radius, tool.contact, support.kind, the specimen (specimen.toml)")
    text = (tmp_path / "session.toml").read_text().replace('radius = "5 mm"', 'radius = "4 mm"')
    (tmp_path / "session.toml").write_text(text)
    told = {"support.kind": "half_space"}
    (said,) = [each for each in load_session(tmp_path, told, "skin_forearm").warnings if "still assumed" in each]
    assert said.endswith(": tool.contact")


def test_a_stated_tool_settles_what_headers_tell_otherwise(tmp_path):
    """The refusal of two tools named `--set tool.radius`, which was refused in the same words."""
    one = press()
    lines = rows(one.time, one.depth, one.force, digits=(3, 5, 6))
    for name, diameter in (("a", 8), ("b", 10)):
        head = f"Punch diameter,{diameter},mm\n\nTime (s),Distance (mm),Force (N)"
        (tmp_path / f"{name}.csv").write_text("\n".join([head, *lines]))
    assert "different tools (4 mm, 5 mm)" in refusal(tmp_path)
    session = load_session(tmp_path, {"tool.radius": "5 mm +/- 1 %"})
    assert session.tool.radius == 5e-3
    (said,) = [each for each in session.warnings if "another tool" in each]
    assert said.endswith("which is used: a.csv: 4 mm, stated 5 mm +/- 1 %")
