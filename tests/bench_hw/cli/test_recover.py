"""`recover`: kept and lost, and nothing touched."""

import json


def test_the_json_of_a_recovery(run, cut_file, tmp_path):
    before = cut_file.read_bytes()
    ran = run("recover", cut_file, "--out", tmp_path / "new.mcap", "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    result = json.loads(ran.stdout)
    assert set(result) == {"schema", "out", "whole", "reason", "kept", "lost_bytes"}
    assert result["whole"] is False
    assert "stops without its end" in result["reason"]
    assert result["kept"]["force"] > 0
    assert result["lost_bytes"] > 0
    assert cut_file.read_bytes() == before
    again = json.loads(run("inspect", tmp_path / "new.mcap", "--json").stdout)
    assert again["complete"] is False
    assert again["channels"]["force"]["rows"] == result["kept"]["force"]


def test_a_sound_trial_is_whole(run, trial_file, tmp_path):
    result = json.loads(run("recover", trial_file, "--out", tmp_path / "new.mcap", "--json").stdout)
    assert (result["whole"], result["reason"], result["lost_bytes"]) == (True, "", 0)
    assert result["kept"] == {"force": 1996, "depth": 200, "camera": 10}
    assert json.loads(run("inspect", tmp_path / "new.mcap", "--json").stdout)["complete"] is True


def test_the_text(run, trial_file, cut_file, tmp_path):
    assert "whole, nothing is lost" in run("recover", trial_file, "--out", tmp_path / "a.mcap").stdout
    text = run("recover", cut_file, "--out", tmp_path / "b.mcap").stdout
    assert "lost: " in text
    assert "stops without its end" in text
    assert run("recover", cut_file, "--out", tmp_path / "c.mcap", "--quiet").stdout == ""


def test_nothing_kept_is_exit_two_and_no_file(run, trial_file, tmp_path):
    begun = tmp_path / "begun.mcap.part"
    begun.write_bytes(trial_file.read_bytes()[:500])
    out = tmp_path / "new.mcap"
    ran = run("recover", begun, "--out", out, "--json")
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert "nothing" in ran.stderr
    assert not out.exists()


def test_an_existing_file_is_not_overwritten(run, trial_file, cut_file):
    before = trial_file.read_bytes()
    ran = run("recover", cut_file, "--out", trial_file)
    assert ran.exit_code == 2
    assert "not overwritten" in ran.stderr
    assert trial_file.read_bytes() == before


def test_the_name_of_the_recording_is_kept_for_it(run, cut_file):
    ran = run("recover", cut_file, "--out", cut_file.with_suffix(""))
    assert ran.exit_code == 2
    assert "no trial_002.mcap is written beside this recording; give another name" in ran.stderr
