"""`devices` on the command line."""

import json
import subprocess
import sys

import pytest


def test_every_kind_is_listed(run):
    ran = run("devices", "--host", "127.0.0.1", "--http-port", 9, "--json")
    assert ran.exit_code == 0
    listed = json.loads(ran.stdout)
    assert listed["schema"] == 1
    assert {device["device"] for device in listed["devices"]} == {"force", "actuator", "camera"}
    assert all(device["found"] or device["fix"] for device in listed["devices"])


def test_what_is_missing_is_shown_with_its_fix(run):
    ran = run("devices", "--host", "127.0.0.1", "--http-port", 9)
    assert "missing  force     netft" in ran.stdout
    assert "fix: " in ran.stdout


def test_a_rig_that_is_whole(run):
    ran = run("devices", "--rig", "simulated")
    assert ran.exit_code == 0
    assert ran.stdout.count("found") == 3


def test_a_rig_with_a_missing_device_is_exit_5(run, tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "netft"\nhost = "127.0.0.1"\nhttp_port = 9\n'
        '[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
    )
    ran = run("devices", "--rig", path, "--json")
    assert ran.exit_code == 5
    assert [device["found"] for device in json.loads(ran.stdout)["devices"]] == [False, True]


def test_a_rig_file_that_is_wrong_is_exit_2(run, tmp_path):
    assert run("devices", "--rig", tmp_path / "gone.toml").exit_code == 2


@pytest.mark.parametrize("host", ["1 .2.3.4", "a/b", "host\n"])
def test_a_host_that_can_be_none_is_exit_2(run, host):
    ran = run("devices", "--host", host)
    assert ran.exit_code == 2
    assert "allowed is the name or address of a host" in ran.stderr


@pytest.mark.parametrize("host", ["..", "\u00fc" * 70])
def test_a_host_that_no_network_has_is_missing(run, host):
    assert "missing  force     netft" in run("devices", "--host", host).stdout


def test_a_missing_webcam_is_said_by_the_bench_alone(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "simulated"\n[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
        '[camera]\nkind = "webcam"\ndevice = 97\n'
    )
    command = [sys.executable, "-m", "bench_hw", "devices", "--rig", str(path)]
    ran = subprocess.run(command, capture_output=True, text=True)
    assert (ran.returncode, ran.stderr) == (5, "")
    assert "fix: webcam 97: cannot be opened" in ran.stdout
