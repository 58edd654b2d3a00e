"""What `session new` proposes: conditions by motion, tool and thickness from the files, and what a person must say."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmark.cli.folders.shipped import session
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.proposal import SPECIMEN_FILE, Motion, motion_of, propose, write_proposal
from benchmark.files.sessions.recordings import _ranged
from benchmark.files.shipped import shipped_sessions
from tests.instruments import samples


def write(path, press):
    lines = samples.rows(press.time, 12.0 - press.depth, press.force, digits=(3, 5, 6))
    path.write_text("\n".join(["Time (s),Gap (mm),Force (N)", *lines]) + "\n")


@pytest.fixture
def folder(tmp_path):
    """Two protocols by their depth and hold, two trials each."""
    for number in (1, 2):
        write(tmp_path / f"shallow_{number}.csv", samples.press(peak=1.0, hold=0.0, seed=number))
        write(tmp_path / f"deep_{number}.csv", samples.press(peak=2.0, hold=2.0, seed=number))
    return tmp_path


def test_conditions_are_found_from_how_the_tool_moved(folder):
    proposal = propose(folder)
    for name, text in proposal.texts.items():
        (folder / name).write_text(text)
    session = load_session(folder)
    assert len(session.conditions) == 2
    shared = {
        trial.condition: {other.name[:4] for other in session.trials if other.condition == trial.condition}
        for trial in session.trials
    }
    assert sorted(map(sorted, shared.values())) == [["deep"], ["shal"]]
    assert session.specimen.layers[0].thickness == pytest.approx(12e-3, rel=0.01)


def test_speed_depth_and_hold_are_measured(folder):
    session = load_session(folder / "deep_1.csv")
    motion = motion_of(session.trials[0].table)
    assert motion.speed == pytest.approx(1e-3, rel=0.03)
    assert motion.depth == pytest.approx(2e-3, rel=0.02)
    assert motion.hold == pytest.approx(2.0, abs=0.1)


def test_tools_that_headers_tell_of_are_proposed_for_each_condition(tmp_path):
    """One radius of 5 mm was proposed for all, which then came before what the files tell."""
    press = samples.press(peak=1.0, hold=0.0, seed=1)
    for name, diameter in (("narrow", 6.0), ("wide one", 10.0)):
        (tmp_path / name).mkdir()
        for number in (1, 2):
            lines = samples.rows(press.time, 12.0 - press.depth, press.force, digits=(3, 5, 6))
            head = [f"Indenter diameter (mm),{diameter}", "Time (s),Gap (mm),Force (N)"]
            (tmp_path / name / f"press_{number}.csv").write_text("\n".join([*head, *lines]) + "\n")
    proposal, found = accepted(tmp_path)
    assert "tool.radius" not in proposal.to_say
    radii = {trial.condition: trial.tool.radius for trial in found.trials}
    assert radii == {"narrow": pytest.approx(3e-3), "wide one": pytest.approx(5e-3)}
    assert not any("radius" in each for each in found.warnings)


def test_sheets_of_one_file_are_trials_each(tmp_path):
    """Those that a proposal lists were called one trial listed twice."""
    pytest.importorskip("python_calamine")
    samples.zwick_xlsx(tmp_path)
    _, found = accepted(tmp_path)
    assert len(found.trials) == 2
    assert not any("listed as more than one trial" in each for each in found.warnings)
    file = tmp_path / "session.toml"
    text = file.read_text()
    file.write_text(text + text[text.index("\n[[trials]]") :])
    assert any("listed as more than one trial: zwick.xlsx" in each for each in load_session(tmp_path).warnings)


def test_a_proposal_says_what_is_odd_about_the_numbers(tmp_path):
    """Files whose presses are negative were proposed as conditions of no depth, without a word."""
    press = samples.press(peak=1.0, hold=0.0, seed=1)
    for name in ("a", "b"):
        rows = samples.rows(press.time, -press.depth, -press.force, digits=(3, 5, 6))
        (tmp_path / f"{name}.csv").write_text("\n".join(["time_s,depth_mm,force_N", *rows]) + "\n")
    (said,) = propose(tmp_path).warnings
    assert said == "in 2 of 2 trials force and depth only fall as the tool presses: both are turned"


def test_what_differs_between_files_is_told_from_least_to_most(tmp_path):
    """The first file's number stood for all: touches at 12, 14 and 13 mm of a gap were all at 12."""
    for name, start in (("a", 12.0), ("b", 14.0), ("c", 13.0)):
        press = samples.press(peak=1.0, hold=0.0, seed=1)
        lines = samples.rows(press.time, start - press.depth, press.force, digits=(3, 5, 6))
        (tmp_path / f"{name}.csv").write_text("\n".join(["Time (s),Gap (mm),Force (N)", *lines]) + "\n")
    said = [each for each in load_session(tmp_path).warnings if "depth is counted from" in each]
    assert said == ["in 3 of 3 trials depth is counted from the first touch, at 12 to 14 mm of the file"]


def test_of_two_numbers_that_differ_the_first_files_are_told():
    assert _ranged(["2 rows beyond 4 N", "2 rows beyond 3 N"]) == "2 rows beyond 3 to 4 N"
    assert _ranged(["rows 3, 9", "rows 4, 8"]) == "rows 3, 9"
    assert _ranged(["at -0.5 mm of t1", "at -12 mm of t1"]) == "at -12 to -0.5 mm of t1"
    assert _ranged(["1e-05 N", "0.002 N"]) == "1e-05 to 0.002 N"


def test_a_condition_is_named_without_exponents():
    assert Motion(0.2, 4e-4, 397.0, 1).name == "200mm_s_to_0.4mm_held_400s"


def write_tracks(path, rows, columns, spacing=8.0, order=1):
    """Tracks of a grid that moves a little over three pictures; marker numbers fall along a row where `order` is -1."""
    x = (np.arange(columns)[::order] - 0.5 * (columns - 1)) * spacing
    y = (np.arange(rows) - 0.5 * (rows - 1)) * spacing
    places = [(a, b) for b in y for a in x]
    lines = [
        f"{0.1 * k},{m},{(1 + 0.01 * k) * a:.5f},{b + 0.02:.5f}" for k in range(3) for m, (a, b) in enumerate(places)
    ]
    path.write_text("\n".join(["time_s,marker,x_mm,y_mm", *lines]) + "\n")


def accepted(folder):
    """The proposal, and the session that it makes."""
    proposal = propose(folder)
    write_proposal(folder, proposal)
    return proposal, load_session(folder)


def test_the_marker_grid_is_proposed_from_the_tables(folder):
    for name in ("deep_1", "shallow_2"):
        write_tracks(folder / f"{name}_markers.csv", 3, 6)
    proposal, found = accepted(folder)
    assert (found.camera.marker_rows, found.camera.marker_columns) == (3, 6)
    assert found.camera.marker_spacing == pytest.approx(8e-3)
    assert proposal.to_say[-1] == "camera.marker_spacing"
    assert "2 tables measure 8 mm at rest" in proposal.texts["session.toml"]
    assert sum(trial.markers is not None for trial in found.trials) == 2
    assert not any("[camera]" in warning for warning in found.warnings)


def test_a_camera_file_in_the_folder_is_named(folder):
    write_tracks(folder / "deep_1_markers.csv", 4, 4)
    (folder / "camera.toml").write_bytes((shipped_sessions()["phantom"] / "camera.toml").read_bytes())
    assert accepted(folder)[1].camera.file == "camera.toml"


@pytest.mark.parametrize("tracks", [[(3, 6, 8.0, -1)], [(3, 6), (6, 3)], [(3, 6, 8.0), (3, 6, 10.0)], [(1, 7)]])
def test_markers_on_no_one_grid_leave_a_camera_to_fill_in(folder, tracks):
    for number, one in enumerate(tracks, start=1):
        write_tracks(folder / f"deep_{number}_markers.csv", *one)
    proposal, found = accepted(folder)
    assert found.camera is None
    assert proposal.to_say[-1] == "camera"
    assert "\n# [camera]\n# marker_rows =\n" in proposal.texts["session.toml"]


def test_what_a_person_must_say_is_marked(folder):
    proposal = propose(folder)
    assert proposal.to_say == ("tool.radius", "tool.contact", "support.kind")
    assert proposal.texts["session.toml"].count("SAY:") == 3


def test_tests_of_one_file_are_named_one_by_one(tmp_path):
    samples.exponent_text(tmp_path)
    proposal = propose(tmp_path)
    assert "tool.radius" not in proposal.to_say
    for name, text in proposal.texts.items():
        (tmp_path / name).write_text(text)
    session = load_session(tmp_path)
    assert [trial.name for trial in session.trials] == ["exponent.txt #1", "exponent.txt #2"] or len(
        session.trials
    ) == 2
    assert {trial.tool.radius for trial in session.trials} == {5e-3}


def test_a_recording_that_was_cut_off_is_said_to_be_left_aside(folder, capsys):
    (folder / "deep_3.mcap.part").write_bytes(b"half")
    (said,) = propose(folder).warnings
    assert said.startswith("deep_3.mcap.part is a recording that was cut off and is left aside; save what is whole")
    session("new", folder, json=True)
    printed = capsys.readouterr()
    assert json.loads(printed.out)["warnings"] == [said]
    assert "warning: deep_3.mcap.part is a recording that was cut off" in printed.err


def test_nothing_is_replaced(folder):
    (folder / "session.toml").write_text("schema = 1\n")
    with pytest.raises(InputError, match="left as it is"):
        propose(folder)


def test_a_specimen_that_a_kill_left_is_taken_and_another_one_is_not(folder):
    proposal = propose(folder)
    (folder / SPECIMEN_FILE).write_text(proposal.texts[SPECIMEN_FILE], encoding="utf-8")
    assert propose(folder) == proposal
    (folder / SPECIMEN_FILE).write_text("# mine\n")
    with pytest.raises(InputError, match=r"specimen\.toml is there already and is left as it is"):
        propose(folder)


def test_where_the_second_file_cannot_be_written_neither_is_there(folder, monkeypatch):
    proposal, before = propose(folder), sorted(folder.iterdir())
    replace = Path.replace

    def refused(path, target):
        if target.name == "session.toml":
            raise OSError(28, "No space left on device")
        return replace(path, target)

    monkeypatch.setattr(Path, "replace", refused)
    with pytest.raises(InputError, match=r"session\.toml cannot be written: No space left on device"):
        write_proposal(folder, proposal)
    assert sorted(folder.iterdir()) == before


def test_a_link_to_nothing_is_not_replaced(folder):
    (folder / "session.toml").symlink_to(folder / "nothing.toml")
    with pytest.raises(InputError, match="left as it is"):
        propose(folder)


def test_columns_that_are_told_are_read_and_stand_in_the_file(tmp_path):
    depth = np.linspace(0.0, 2.0, 50)
    table = np.column_stack([np.linspace(0.0, 2.0, 50), depth, 40.0 * depth])
    for number in range(3):
        header = "Time (s),Depth (mm),Balance"  # of no instrument
        np.savetxt(tmp_path / f"t{number}.csv", table, delimiter=",", header=header, comments="")
    with pytest.raises(InputError, match=r'name it, --set import\.force="COLUMN:N"'):
        propose(tmp_path)
    write_proposal(tmp_path, propose(tmp_path, {"import.force": "Balance:g"}))
    assert '[import]\nforce = "Balance:g"\n' in (tmp_path / "session.toml").read_text()
    trial = load_session(tmp_path).trials[0]
    assert trial.table.force.max() == pytest.approx(80.0 * 9.80665e-3)


def test_what_is_no_column_is_not_told_of_a_proposal(folder):
    with pytest.raises(InputError, match=r"--set tool\.radius: session new takes import\.KEY alone"):
        propose(folder, {"tool.radius": "3 mm"})
    with pytest.raises(InputError, match=r"^--set import\.forc: this key is not known; did you mean force\?"):
        propose(folder, {"import.forc": "Load:N"})
    for key, value, unit in (("rate", "fast", "Hz"), ("area", "3 mm", r"m\^2")):
        with pytest.raises(InputError, match=rf"^import\.{key}: '{value}' is no .* converts to {unit}"):
            propose(folder, {f"import.{key}": value})


def test_a_scale_reads_a_force(tmp_path):
    depth = np.linspace(0.0, 2.0, 50)
    table = np.column_stack([np.linspace(0.0, 2.0, 50), depth, 40.0 * depth])
    np.savetxt(tmp_path / "t.csv", table, delimiter=",", header="Time (s),Depth (mm),Weight (grams)", comments="")
    write_proposal(tmp_path, propose(tmp_path))
    assert load_session(tmp_path).trials[0].table.force.max() == pytest.approx(80.0 * 9.80665e-3)


def creeping(seed, speed):
    """Time, depth (mm) and force of a gel that creeps under 1 N, put on at a speed (N/s) and held until 10 s."""
    rng, time = np.random.default_rng([seed, 5]), np.arange(0.0, 12.0, 0.05)
    force = np.clip(speed * (time - 1.0), 0.0, 1.0) * (time < 10.0)
    slow = np.zeros(time.size)
    for row in range(1, time.size):
        slow[row] = slow[row - 1] + 0.03 * (force[row] - slow[row - 1])
    depth = (0.5 + 0.1 * rng.random()) * (force + 0.5 * slow) + 3e-3 * rng.normal(size=time.size)
    return np.column_stack([time, depth, force + 2e-3 * rng.normal(size=time.size)])


def test_a_force_that_was_prescribed_is_proposed_as_the_drive_and_tells_the_conditions(tmp_path):
    """By the depth, which is the answer and scatters, each trial had a condition of its own."""
    for number, speed in enumerate([100.0] * 3 + [1.0] * 3):
        name, columns = tmp_path / f"{number}.csv", "time_s,depth_mm,force_N"
        np.savetxt(name, creeping(number, speed), delimiter=",", header=columns, comments="", fmt="%.6f")
    proposal = propose(tmp_path)
    assert '[drive]\nchannel = "force"' in proposal.texts["session.toml"]
    assert any("the force stands while the depth creeps on" in text for text in proposal.warnings)
    write_proposal(tmp_path, proposal)
    session = load_session(tmp_path)
    assert session.drive == "force"
    assert [sum(trial.condition == name for trial in session.trials) for name in session.conditions] == [3, 3]
    assert all("N_s_to_1N_held_" in name for name in session.conditions)
