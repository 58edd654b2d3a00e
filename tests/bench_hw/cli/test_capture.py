"""`capture` on the command line."""

import json
import shutil
import tomllib
from importlib.metadata import EntryPoint

import pytest

QUICK = """
schema = 1
name = "quick"
[[segments]]
kind = "approach"
touch_force = "0.05 N"
speed = "5 mm/s"
max_depth = "15 mm"
[[segments]]
kind = "move"
depth = "1 mm"
speed = "5 mm/s"
[[segments]]
kind = "retract"
depth = "-2 mm"
speed = "10 mm/s"
"""
RIG = """
schema = 1
name = "simulated"
[force]
kind = "simulated"
{force}
[actuator]
kind = "simulated"
stroke = "50 mm"
contact = "5 mm"
{actuator}
[safety]
travel = ["0 mm", "20 mm"]
{safety}
"""


@pytest.fixture
def quick(tmp_path):
    path = tmp_path / "quick.toml"
    path.write_text(QUICK)
    return path


@pytest.fixture
def rig(tmp_path):
    def write(force="", actuator="", safety=""):
        path = tmp_path / "rig.toml"
        path.write_text(RIG.format(force=force, actuator=actuator, safety=safety))
        return path

    return write


def test_a_session(run, quick, rig, tmp_path):
    out = tmp_path / "s"
    ran = run("capture", quick, "--rig", rig(), "--out", out, "--trials", 2, "--fast", "--json",
              "--condition", "slow", "--specimen", "rtv3498_sheet", "--set", 'tool.radius="5 mm"')  # fmt: skip
    assert (ran.exit_code, ran.stderr) == (0, "")
    answer = json.loads(ran.stdout)
    assert (answer["schema"], answer["complete"], answer["fault"]) == (1, True, None)
    assert answer["trials"] == [str(out / "trial_001.mcap"), str(out / "trial_002.mcap")]
    listed = tomllib.loads((out / "session.toml").read_text())
    assert (listed["specimen"], listed["tool"]) == ("rtv3498_sheet", {"radius": "5 mm"})
    assert listed["trials"][1] == {"file": "trial_002.mcap", "condition": "slow"}


TISSUE = 'schema = 1\nname = "mine"\n[[layers]]\nname = "gel"\n'


@pytest.fixture
def tissues(monkeypatch):
    """A program that reads sessions and says which tissues it ships."""
    point = EntryPoint("reader", "reader:tissues", "tissuebench.tissues")
    monkeypatch.setattr(EntryPoint, "load", lambda self: lambda: {"skin_forearm": 1, "rtv3498_sheet": 2})
    monkeypatch.setattr("bench_hw.capture.session_keys.entry_points", lambda group: [point])


@pytest.mark.parametrize(
    "given", [("--specimen", "skin_forarm"), ("--set", "specimen=skin_forarm"), ("--set", 'specimen="skin_forarm"')]
)
def test_a_specimen_that_there_is_not_is_refused_before_anything_moves(run, quick, rig, tmp_path, tissues, given):
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast", *given)
    assert ran.exit_code == 2
    assert ran.stderr == (
        "error: --specimen skin_forarm: there is no such tissue; did you mean skin_forearm? allowed is a shipped "
        "tissue (rtv3498_sheet, skin_forearm) or a tissue file that exists\n"
    )
    assert not (tmp_path / "s").exists()


def test_a_specimens_file_must_be_there_and_be_one(run, quick, rig, tmp_path):
    for name, says in (("none.toml", "there is no such tissue"), ("rig.toml", "this file has no [[layers]]")):
        file = tmp_path / name
        ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast", "--specimen", file)
        assert ran.exit_code == 2
        assert f"--specimen {file}: {says}" in ran.stderr
        assert not (tmp_path / "s").exists()


def test_a_specimens_file_is_copied_into_the_session(run, quick, rig, tmp_path):
    mine, out = tmp_path / "mine.toml", tmp_path / "s"
    mine.write_text(TISSUE)
    arguments = ("capture", quick, "--rig", rig(), "--out", out, "--fast", "--quiet", "--specimen", mine)
    assert run(*arguments).exit_code == 0
    assert tomllib.loads((out / "session.toml").read_text())["specimen"] == "mine.toml"
    assert (out / "mine.toml").read_text() == TISSUE
    assert run(*arguments, "--append").exit_code == 0
    other = tmp_path / "other.toml"
    other.write_text(TISSUE)
    ran = run(*arguments[:-1], other, "--append")
    assert ran.exit_code == 2
    assert f"--specimen {other}: this session's is mine.toml" in ran.stderr


def test_keys_that_would_be_passed_over_are_refused_where_trials_are_appended(run, quick, rig, tmp_path):
    out = tmp_path / "s"
    arguments = ("capture", quick, "--rig", rig(), "--out", out, "--fast", "--quiet")
    assert run(*arguments, "--set", 'tool.radius="4 mm"').exit_code == 0
    before = (out / "session.toml").read_text()
    for given, its in (("tool.radius=5 mm", "'4 mm'"), ("tool.tilt=1 deg", "none")):
        ran = run(*arguments, "--append", "--set", given)
        assert ran.exit_code == 2
        assert f"--set {given}: {out / 'session.toml'} has {its}, which stays with --append" in ran.stderr
    assert (out / "session.toml").read_text() == before
    assert run(*arguments, "--append", "--set", "tool.radius=4 mm").exit_code == 0
    assert len(tomllib.loads((out / "session.toml").read_text())["trials"]) == 2


def test_a_specimen_that_is_told_comes_before_the_rigs(run, quick, tmp_path):
    arguments = ("--rig", "simulated_phantom", "--out", tmp_path / "s", "--fast", "--quiet")
    assert run("capture", quick, *arguments, "--specimen", "skin_forearm").exit_code == 0
    assert tomllib.loads((tmp_path / "s" / "session.toml").read_text())["specimen"] == "skin_forearm"


def test_progress_is_lines_where_there_is_no_terminal(run, quick, rig, tmp_path):
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast")
    assert ran.exit_code == 0
    assert "trial 1/1" in ran.stderr
    assert "depth" in ran.stderr
    assert "1 trial(s) in" in ran.stdout


def test_quiet_says_nothing(run, quick, rig, tmp_path):
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast", "--quiet")
    assert (ran.exit_code, ran.stdout, ran.stderr) == (0, "", "")


def test_the_dry_run_needs_no_rig_and_moves_nothing(run):
    ran = run("capture", "paper_press", "--dry-run", "--trials", 10)
    assert ran.exit_code == 0
    assert "8.0 s a trial, 10 trial(s): 80.0 s in all" in ran.stdout
    assert "*" in ran.stdout


def test_a_picture_of_the_motion_belongs_to_the_dry_run(run, quick, rig, tmp_path):
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast", "--plot", tmp_path / "plan.svg")
    assert ran.exit_code == 2
    assert "is drawn by --dry-run" in ran.stderr
    assert not (tmp_path / "s").exists()


def test_the_dry_run_as_json_and_as_a_picture(run, tmp_path):
    ran = run("capture", "paper_press", "--dry-run", "--json", "--plot", tmp_path / "plan.svg")
    answer = json.loads(ran.stdout)
    assert (answer["duration_s"], answer["protocol"]) == (8.0, "paper_press")
    assert (tmp_path / "plan.svg").read_text().lstrip().startswith("<?xml")


@pytest.mark.parametrize(
    ("changes", "code", "says"),
    [
        ({"force": 'serial = "FT9"'}, 5, "the rig asks for 'FT9'"),
        ({"actuator": 'serial = "LAC9"'}, 5, "the rig asks for 'LAC9'"),
        ({"force": "colour = 1"}, 2, "colour: is unknown here"),
        ({"actuator": 'max_speed = "6 mm/s"'}, 2, "a speed of 10 mm/s"),
    ],
)
def test_a_wrong_rig_is_one_paragraph_and_no_folder(run, quick, rig, tmp_path, changes, code, says):
    out = tmp_path / "s"
    ran = run("capture", quick, "--rig", rig(**changes), "--out", out, "--fast")
    assert ran.exit_code == code
    assert says in ran.stderr
    assert ran.stderr.count("\n") == 1
    assert not out.exists()


def test_a_wrong_address_is_exit_5_and_nothing_made(run, quick, tmp_path):
    rig = tmp_path / "rig.toml"
    rig.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "netft"\nhost = "127.0.0.1"\nhttp_port = 9\n'
        '[actuator]\nkind = "simulated"\nstroke = "50 mm"\ncontact = "5 mm"\n'
    )
    ran = run("capture", quick, "--rig", rig, "--out", tmp_path / "s")
    assert ran.exit_code == 5
    assert "no answer" in ran.stderr
    assert not (tmp_path / "s").exists()


def test_a_fault_is_exit_5_and_named(run, quick, rig, tmp_path):
    out = tmp_path / "s"
    ran = run("capture", quick, "--rig", rig(safety='force_limit = "0.3 N"'), "--out", out, "--fast", "--json")
    assert ran.exit_code == 5
    assert json.loads(ran.stdout)["fault"]["kind"] == "force_limit"
    assert "the tool was sent back" in ran.stderr
    assert [path.name for path in out.glob("*.mcap")] == ["trial_001.mcap"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["capture", "paper_press"], "needs --rig and --out"),
        (["capture", "no_such", "--dry-run"], "shipped are"),
        (["capture", "paper_press", "--rig", "no_such", "--out", "x"], "shipped are simulated"),
    ],
)
def test_usage(run, arguments, says):
    ran = run(*arguments)
    assert ran.exit_code == 2
    assert says in ran.stderr


def test_a_folder_that_is_not_empty_is_left_alone(run, quick, rig, tmp_path):
    (tmp_path / "s").mkdir()
    (tmp_path / "s" / "mine.txt").write_text("mine")
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast")
    assert ran.exit_code == 2
    assert [path.name for path in (tmp_path / "s").iterdir()] == ["mine.txt"]


def test_a_place_that_cannot_be_written_is_exit_2(run, quick, rig, tmp_path):
    (tmp_path / "file").write_text("")
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "file" / "s", "--fast")
    assert ran.exit_code == 2
    assert f"{tmp_path / 'file'} is a file where a folder is needed" in ran.stderr


def test_a_full_disk_leaves_no_empty_folder(run, quick, rig, tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: shutil._ntuple_diskusage(1 << 40, 1 << 40, 0))
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast")
    assert ran.exit_code == 2
    assert "0 MB free on that disk" in ran.stderr
    assert not (tmp_path / "s").exists()


def test_what_a_person_must_do_first_is_said(run, quick, rig, tmp_path):
    quick.write_text(QUICK.replace('name = "quick"\n', 'name = "quick"\n[setup]\ntool_radius = "8 mm"\n', 1))
    ran = run("capture", quick, "--rig", rig(), "--out", tmp_path / "s", "--fast")
    assert ran.exit_code == 0
    assert "to be done by hand first: tool_radius = 8 mm" in ran.stderr
