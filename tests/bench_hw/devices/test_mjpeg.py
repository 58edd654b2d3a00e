"""Cutting a multipart stream into pictures."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.devices.mjpeg import MultipartParser, StreamError


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
