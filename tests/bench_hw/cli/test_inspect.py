"""`inspect` on sound, cut and foreign files."""

import json

import pytest

from bench_hw.cli.inspect import _figure


def test_the_json_of_a_sound_trial(run, trial_file):
    ran = run("inspect", trial_file, "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    result = json.loads(ran.stdout)
    assert (result["schema"], result["complete"], result["faults"]) == (1, True, [])
    force = result["channels"]["force"]
    assert (force["rows"], force["lost"], force["gaps"]) == (1996, 4, 2)
    assert (force["first_time_s"], force["last_time_s"]) == (0.0, 1.999)
    assert abs(force["rate_hz"] - 1000) < 1e-6
    assert set(result["channels"]) == {"force", "depth", "camera"}
    for channel in result["channels"].values():
        assert {"rows", "first_time_s", "last_time_s", "rate_hz", "lost", "gaps"} <= channel.keys()


def test_a_cut_trial_is_not_complete_and_no_error(run, cut_file):
    ran = run("inspect", cut_file, "--json")
    assert ran.exit_code == 0
    result = json.loads(ran.stdout)
    assert result["complete"] is False
    assert result["faults"]
    assert 0 < result["channels"]["force"]["rows"] < 1996


def test_the_text_says_synthetic_and_what_is_wrong(run, trial_file, cut_file):
    text = run("inspect", trial_file).stdout
    assert "complete, synthetic (simulated devices)" in text
    assert "force: rows 1996" in text
    assert "lost 4" in text
    assert "NOT complete" in run("inspect", cut_file).stdout
    assert run("inspect", cut_file, "--quiet").stdout == ""


def test_a_jitter_is_shown_as_far_as_it_means_something(run, trial_file):
    text = run("inspect", trial_file).stdout
    assert "jitter_ms 0," in text
    assert "e-" not in text


@pytest.mark.parametrize(("jitter", "shown"), [(0.0, "0"), (3e-6, "below 0.001"), (0.25, "0.25"), (None, "-")])
def test_times_below_a_microsecond_are_said_to_be_so(jitter, shown):
    assert _figure("jitter_ms", jitter) == shown


def test_what_is_no_trial_is_exit_two_and_one_paragraph(run, tmp_path):
    garbage = tmp_path / "garbage.mcap"
    garbage.write_bytes(b"no trial at all" * 100)
    for path, reason in (
        (garbage, "nothing in this file is a trial"),
        (tmp_path / "none.mcap", "No such file"),
        (tmp_path, "it is a folder; allowed is a regular file"),
    ):
        ran = run("inspect", path, "--json")
        assert (ran.exit_code, ran.stdout) == (2, "")
        assert reason in ran.stderr
        assert str(path) in ran.stderr
        assert "allowed" in ran.stderr
        assert ran.stderr.count("\n") == 1


def test_a_traceback_only_with_debug(run, tmp_path):
    assert "Traceback" not in run("inspect", tmp_path / "none.mcap").stderr
    assert "Traceback" in run("inspect", tmp_path / "none.mcap", "--debug").stderr
