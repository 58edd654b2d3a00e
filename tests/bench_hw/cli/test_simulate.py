"""`simulate` on the command line."""

import json
import re
import signal
import socket
import subprocess
import sys
import time

import cv2
import pytest

from bench_hw.devices.rdt import parse_records

PORTS = re.compile(r"http://127\.0\.0\.1:(\d+)/.*RDT on UDP (\d+)")


@pytest.fixture
def start():
    """Start `simulate ...` as a process and read its announcement."""
    processes = []

    def run(*arguments):
        command = [sys.executable, "-m", "bench_hw", "simulate", *map(str, arguments)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        processes.append(process)
        return process, process.stderr.readline()

    yield run
    for process in processes:
        if process.poll() is None:
            process.kill()
            process.communicate()


def test_a_box_until_sigterm(start):
    process, said = start("netft", "--rate-hz", 1000, "--drop", "20-22,50", "--seed", 3, "--json")
    rdt = int(PORTS.search(said)[2])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.settimeout(5.0)
        client.sendto(bytes.fromhex("12 34 00 02 00 00 00 00"), ("127.0.0.1", rdt))
        numbers = [int(parse_records(client.recv(2048))["rdt_sequence"][0]) for _ in range(100)]
        client.sendto(bytes.fromhex("12 34 00 00 00 00 00 00"), ("127.0.0.1", rdt))
        client.settimeout(0.3)
        try:
            while True:
                numbers.append(int(parse_records(client.recv(2048))["rdt_sequence"][0]))
        except TimeoutError:
            pass
    process.send_signal(signal.SIGTERM)
    out, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    assert json.loads(out) == {"schema": 1, "sent": len(numbers), "dropped": 4}
    assert set(range(1, numbers[-1] + 1)) - set(numbers) == {20, 21, 22, 50}


def test_a_box_ends_at_its_duration(start):
    began = time.monotonic()
    process, _ = start("netft", "--duration-s", 0.5, "--json")
    out, _ = process.communicate(timeout=20)
    assert (process.returncode, json.loads(out)["sent"]) == (0, 0)
    assert time.monotonic() - began >= 0.5


def test_a_camera_as_a_stream(start):
    process, said = start("camera", "--size", "64x48", "--rate-hz", 50, "--duration-s", 20, "--json")
    capture = cv2.VideoCapture(said.split()[-1])
    pictures = [capture.read() for _ in range(5)]
    capture.release()
    assert all(good and picture.shape[:2] == (48, 64) for good, picture in pictures)
    process.send_signal(signal.SIGTERM)
    out, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    assert json.loads(out)["sent"] >= 5


def test_a_camera_as_files(run, tmp_path):
    ran = run("simulate", "camera", "--size", "64x48", "--images", tmp_path / "p", "--frames", 3, "--json")
    assert ran.exit_code == 0
    assert json.loads(ran.stdout) == {"schema": 1, "sent": 3, "dropped": 0}
    assert len(list((tmp_path / "p").glob("frame_*.png"))) == 3


@pytest.mark.parametrize(
    "fault", [("--loss", "0.5"), ("--drop", "1-3"), ("--freeze", "4"), ("--jitter-s", "0.1"), ("--duration-s", "2")]
)
def test_files_take_no_fault_of_the_stream(run, tmp_path, fault):
    ran = run("simulate", "camera", "--size", "64x48", "--images", tmp_path / "p", *fault)
    assert ran.exit_code == 2
    assert f"error: {fault[0]} {fault[1]}" in ran.stderr
    assert "allowed with --images are" in ran.stderr
    assert not (tmp_path / "p").exists()


def test_a_stream_takes_no_number_of_pictures(run):
    ran = run("simulate", "camera", "--frames", 3, "--duration-s", 0.1)
    assert ran.exit_code == 2
    assert "--frames 3" in ran.stderr


def test_pictures_replace_and_join_nothing(run, tmp_path):
    mine = tmp_path / "p" / "frame_00001.png"
    mine.parent.mkdir()
    mine.write_bytes(b"mine")
    for place in (mine.parent, mine):
        ran = run("simulate", "camera", "--size", "64x48", "--images", place, "--frames", 2)
        assert ran.exit_code == 2
        assert "allowed: a folder that is new or empty" in ran.stderr
    assert [(path.name, path.read_bytes()) for path in mine.parent.iterdir()] == [("frame_00001.png", b"mine")]


@pytest.mark.parametrize("wrong", [("--port", 80_000), ("--port", -1), ("--duration-s", -1), ("--duration-s", "inf")])
def test_a_camera_that_cannot_be_is_a_usage_error(run, wrong):
    ran = run("simulate", "camera", *wrong)
    assert ran.exit_code == 2
    assert f"Invalid value for '{wrong[0]}'" in ran.stderr


def test_a_session(run, tmp_path):
    ran = run("simulate", "session", "--out", tmp_path / "s", "--trials", 1, "--no-camera", "--json", "--seed", 2)
    assert ran.exit_code == 0
    assert json.loads(ran.stdout)["complete"] is True
    assert (tmp_path / "s" / "session.toml").is_file()


def test_a_session_of_the_phantoms_sheet(run, tmp_path):
    arguments = ("--specimen", "phantom", "--no-camera", "--trials", 1, "--rate-hz", 100, "--json")
    ran = run("simulate", "session", "paper_press", "--out", tmp_path / "s", *arguments)
    assert ran.exit_code == 0
    text = (tmp_path / "s" / "session.toml").read_text()
    assert 'kind = "hole"' in text
    assert "synthetic = true" in text


@pytest.mark.parametrize(
    "arguments",
    [
        ["netft", "--drop", "5-3"],
        ["netft", "--loss", "1.5"],
        ["netft", "--rate-hz", "0"],
        ["camera", "--size", "big"],
        ["session", "no_such", "--out", "x"],
        ["session", "--specimen", "nobody", "--out", "x"],
    ],
)
def test_usage(run, arguments):
    ran = run("simulate", *arguments)
    assert ran.exit_code == 2
    assert ran.stderr
