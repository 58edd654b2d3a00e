"""The simulated camera's stream as bytes, and its picture files."""

import socket

import cv2
import numpy as np
import pytest

from bench_hw.clock import SimulatedClock
from bench_hw.simulated.camera_server import CameraServer, CameraSettings, write_pictures


def grey(now):
    return np.full((24, 32), int(now * 100) % 256, np.uint8)


@pytest.fixture
def clock():
    return SimulatedClock()


@pytest.fixture
def stream(clock):
    """Connect a bare socket to a server with these settings; gives the server and a reader of all that came."""
    made = []

    def make(**settings):
        server = CameraServer(grey, clock, CameraSettings(**settings), np.random.default_rng(1))
        client = socket.create_connection(("127.0.0.1", server.port), timeout=5.0)
        client.sendall(b"GET / HTTP/1.0\r\n\r\n")
        head = client.recv(4096)
        client.setblocking(False)
        made.append((server, client))
        return server, client, head

    yield make
    for server, client in made:
        client.close()
        server.close()


def drain(client):
    data = b""
    while True:
        try:
            data += client.recv(1 << 20)
        except BlockingIOError:
            return data


def test_the_stream_is_mjpeg_over_http(stream, clock):
    _, client, head = stream(rate=100.0)
    assert head.startswith(b"HTTP/1.0 200 OK\r\n")
    assert b"multipart/x-mixed-replace; boundary=frame" in head
    clock.sleep(0.0105)
    data = drain(client)
    head, _, body = data.partition(b"\r\n\r\n")
    assert head.split(b"\r\n")[:2] == [b"--frame", b"Content-Type: image/jpeg"]
    assert body[:2] == b"\xff\xd8"


def test_frames_come_at_their_rate(stream, clock):
    server, client, _ = stream(rate=50.0)
    clock.sleep(2.0)
    assert drain(client).count(b"--frame") == 100
    assert (server.sent, server.dropped) == (100, 0)


def test_jitter_moves_frames_but_loses_none(stream, clock):
    server, client, _ = stream(rate=50.0, jitter=5e-3)
    clock.sleep(2.0)
    assert drain(client).count(b"--frame") == pytest.approx(100, abs=1)
    assert server.dropped == 0


def test_dropped_frames_leave_a_gap_in_the_numbers(stream, clock):
    server, client, _ = stream(rate=50.0, drop=frozenset([3, 4]))
    clock.sleep(0.13)
    data = drain(client)
    assert [b"X-Frame: %d\r\n" % k in data for k in range(1, 7)] == [True, True, False, False, True, True]
    assert server.dropped == 2


def test_each_part_says_when_it_was_taken(stream, clock):
    _, client, _ = stream(rate=40.0)
    clock.sleep(0.06)
    assert [b"X-Timestamp: %s\r\n" % at in drain(client) for at in (b"0.025000000",)] == [True]


def test_a_frozen_camera_repeats_its_bytes(stream, clock):
    server, client, _ = stream(rate=50.0)
    clock.sleep(0.021)
    first = drain(client).split(b"\r\n\r\n", 1)[1]
    server.freeze()
    clock.sleep(0.02)
    assert drain(client).split(b"\r\n\r\n", 1)[1] == first


def test_picture_files_are_lossless(tmp_path):
    paths = write_pictures(tmp_path / "p", grey, [0.1, 0.2])
    assert [path.name for path in paths] == ["frame_00001.png", "frame_00002.png"]
    assert np.array_equal(cv2.imread(str(paths[1]), cv2.IMREAD_UNCHANGED), grey(0.2))
