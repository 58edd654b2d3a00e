"""Cutting a multipart stream into pictures."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.clock import MonotonicClock, wait_until
from bench_hw.devices.http_camera import HttpCamera, MultipartParser, StreamError, jpeg_size
from bench_hw.errors import DeviceError
from bench_hw.simulated.camera_server import CameraServer, CameraSettings


def part(body, number=None, with_length=True):
    length = f"Content-Length: {len(body)}\r\n" if with_length else ""
    extra = "" if number is None else f"X-Frame: {number}\r\n"
    return f"--frame\r\nContent-Type: image/jpeg\r\n{length}{extra}\r\n".encode() + body + b"\r\n"


@given(
    st.lists(st.binary(max_size=60).filter(lambda b: b"\r\n--frame" not in b), min_size=1, max_size=6),
    st.booleans(),
    st.lists(st.integers(1, 40), min_size=1, max_size=10),
)
def test_any_cut_of_the_stream_gives_the_same_pictures(bodies, with_length, cuts):
    stream = b"".join(part(body, k, with_length) for k, body in enumerate(bodies)) + b"--frame\r\n"
    parser, got, start, turn = MultipartParser("frame"), [], 0, 0
    while start < len(stream):
        size = cuts[turn % len(cuts)]
        got += parser.feed(stream[start : start + size])
        start, turn = start + size, turn + 1
    assert [p.body for p in got] == bodies
    assert [p.header["x-frame"] for p in got] == [str(k) for k in range(len(bodies))]


@pytest.mark.parametrize("with_length", [True, False])
def test_a_picture_had_come_when_its_last_byte_did(with_length):
    """Without a length that is known by the next boundary only, which comes with the next picture."""
    parser, got = MultipartParser("frame"), []
    for k in range(3):
        picture = part(b"abcdefgh", k, with_length)
        got += parser.feed(picture[:-6], k + 0.25) + parser.feed(picture[-6:], k + 0.5)
    got += parser.feed(b"--frame\r\n", 3.0)
    assert [p.arrived for p in got] == [0.5, 1.5, 2.5]


@pytest.mark.parametrize("boundary", ["frame", "--frame", '"frame"'])
def test_boundaries_as_servers_write_them(boundary):
    assert [p.body for p in MultipartParser(boundary).feed(part(b"abc"))] == [b"abc"]


def test_a_body_may_hold_what_looks_like_a_boundary():
    body = b"x\r\n--frame\r\ny"
    assert MultipartParser("frame").feed(part(body))[0].body == body


@pytest.mark.parametrize(
    "stream",
    [
        b"x" * 20_000,
        b"--frame" + b"x" * 20_000,
        b"--frame\r\nContent-Length: many\r\n\r\n",
        b"--frame\r\nContent-Length: -5\r\n\r\n",
    ],
)
def test_what_is_no_such_stream_is_refused_instead_of_filling_memory(stream):
    with pytest.raises(StreamError):
        MultipartParser("frame").feed(stream)


@pytest.fixture
def make_server(clock):
    servers = []

    def make(**settings):
        rng = np.random.default_rng(1)

        def picture(now):
            return rng.integers(0, 255, (48, 64)).astype(np.uint8)

        servers.append(CameraServer(picture, clock, CameraSettings(**settings), np.random.default_rng(2)))
        return servers[-1]

    yield make
    for server in servers:
        server.close()


def collect(camera, clock, duration):
    frames = []
    for _ in range(round(duration / 2e-3)):
        clock.sleep(2e-3)
        frames += camera.read()
    return frames


def test_frames_come_at_their_rate_as_jpeg(make_server, clock):
    server = make_server(rate=30.0)
    with HttpCamera(server.url, rate=30.0, clock=clock) as camera:
        camera.start()
        frames = collect(camera, clock, 1.0)
        assert camera.info.settings["rate"] == "30 Hz"
    assert len(frames) == pytest.approx(30, abs=1)
    assert all(frame.data[:2] == b"\xff\xd8" for frame in frames)
    assert [frame.number for frame in frames] == list(range(len(frames)))
    assert np.diff([frame.time for frame in frames]) == pytest.approx(np.full(len(frames) - 1, 1 / 30), abs=3e-3)


def test_a_stream_on_the_same_clock_is_stamped_when_its_pictures_are_taken(make_server, clock):
    server = make_server(rate=30.0)
    with HttpCamera(server.url, rate=30.0, clock=clock, same_clock=True) as camera:
        camera.start()
        times = np.array([frame.time for frame in collect(camera, clock, 1.0)])
    assert np.diff(times) == pytest.approx(1 / 30, abs=2e-9)
    assert 30.0 * times == pytest.approx(np.round(30.0 * times), abs=1e-6)


@pytest.mark.parametrize("text", ["", "-1", "nan", "1e3", "0x10", "9" * 13, "99999"])
def test_a_time_that_is_none_or_still_to_come_is_not_taken(clock, text):
    camera = HttpCamera("http://127.0.0.1:1/", clock=clock, same_clock=True)
    camera._parser = MultipartParser("frame")
    data = b"--frame\r\nContent-Length: 1\r\nX-Timestamp: " + text.encode() + b"\r\n\r\nx\r\n"
    assert [frame.time for frame in camera._frames(data)] == [clock.now()]


def test_dropped_frames_are_known_by_their_numbers(make_server, clock):
    server = make_server(rate=50.0, drop=frozenset([10, 11, 20]))
    with HttpCamera(server.url, rate=50.0, clock=clock) as camera:
        camera.start()
        frames = collect(camera, clock, 1.0)
        assert (camera.health.dropped, server.dropped) == (3, 3)
    assert len(frames) == camera.health.received


def test_frozen_frames_are_counted(make_server, clock):
    server = make_server(rate=50.0, freeze=frozenset([10, 11]))
    with HttpCamera(server.url, rate=50.0, clock=clock) as camera:
        camera.start()
        collect(camera, clock, 0.5)
        assert camera.health.frozen == 2


def test_a_stream_that_ends_is_an_error(make_server, clock):
    server = make_server()
    with HttpCamera(server.url, clock=clock) as camera:
        camera.start()
        collect(camera, clock, 0.2)
        server.unplug()
        with pytest.raises(DeviceError, match="the stream ended"):
            collect(camera, clock, 0.2)


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (b"HTTP/1.0 404 Not Found\r\n\r\n", "allowed is status 200"),
        (b"HTTP/1.0 200 OK\r\nContent-Type: text/html\r\n\r\n", "no MJPEG stream"),
        (b"", "allowed is status 200"),
    ],
)
def test_what_is_no_stream_is_refused(tcp_server, clock, answer, says):
    def talk(client):
        client.recv(4096)
        client.sendall(answer)

    with pytest.raises(DeviceError, match=says):
        HttpCamera(f"http://127.0.0.1:{tcp_server(talk)}/video", clock=clock).connect()


def test_the_request_is_plain_http(tcp_server, clock):
    heard = []

    def talk(client):
        heard.append(client.recv(4096))

    port = tcp_server(talk)
    with pytest.raises(DeviceError):
        HttpCamera(f"http://127.0.0.1:{port}/a/b?c=d", clock=clock).connect()
    assert heard == [f"GET /a/b?c=d HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode()]


@pytest.mark.parametrize("url", ["ftp://x/y", "not an address", "http:///x"])
def test_other_addresses_are_refused(url):
    with pytest.raises(DeviceError, match="allowed is an address like"):
        HttpCamera(url).connect()


def test_nobody_there(ear):
    with pytest.raises(DeviceError, match="check address"):
        HttpCamera(f"http://127.0.0.1:{ear.port}/", timeout=1.0).connect()


def test_bytes_that_make_no_sense_end_the_stream(tcp_server, clock):
    def talk(client):
        client.recv(4096)
        client.sendall(b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n")
        client.sendall(b"--frame\r\nContent-Length: many\r\n\r\n")
        client.recv(4096)

    real = MonotonicClock()
    with (
        pytest.raises(DeviceError, match="content-length"),
        HttpCamera(f"http://127.0.0.1:{tcp_server(talk)}/", clock=real) as camera,
    ):
        wait_until(real, lambda: camera.read() is None, timeout=5.0)


def test_a_picture_tells_its_size():
    for size in ((48, 64), (481, 1000)):
        for options in ([], [cv2.IMWRITE_JPEG_PROGRESSIVE, 1]):
            data = cv2.imencode(".jpg", np.zeros(size, np.uint8), options)[1].tobytes()
            assert jpeg_size(data) == size[::-1]
            assert jpeg_size(data[:2] + b"\xff" + data[2:]) == size[::-1]  # a marker may be filled up


@given(st.binary(max_size=60))
def test_what_is_no_jpeg_tells_none(data):
    assert jpeg_size(data) is None
    assert jpeg_size(b"\xff\xd8" + data[:8]) is None


def test_a_picture_of_the_size_that_is_asked_for_is_waited_for(make_server, clock):
    with HttpCamera(make_server().url, clock=clock, size=(64, 48)) as camera:
        camera.start()
        assert len(collect(camera, clock, 0.5)) == pytest.approx(15, abs=1)


def test_pictures_of_another_size_are_refused(make_server, clock):
    with (
        HttpCamera(make_server().url, clock=clock, size=(640, 480)) as camera,
        pytest.raises(DeviceError, match=r"gives 64 x 48 pixels; the rig asks for 640 x 480 \(camera\.size\)"),
    ):
        camera.start()


def test_what_is_no_picture_is_no_frame(tcp_server):
    def talk(client):
        client.recv(4096)
        client.sendall(b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n")
        client.sendall(part(b"no picture") * 3)
        client.recv(4096)

    real = MonotonicClock()
    with HttpCamera(f"http://127.0.0.1:{tcp_server(talk)}/", clock=real, size=(64, 48), timeout=0.3) as camera:
        with pytest.raises(DeviceError, match="no JPEG picture within"):
            camera.start()
        assert camera.health.received == 0
