"""A running capture told to pages: what is in the file, at a rate a page can follow, and only to pages of its own."""

import asyncio
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from bench_hw.trial_file import ForceRecord, FrameRecord, PositionRecord, TrialHeader, open_trial
from bench_hw.trial_file.records import EventRecord
from benchmark.press.live_capture import MOST_SAMPLES, LiveCapture, LiveLine, tell
from benchmark.press.press_server import Served, make_server

TOKEN = "a-token-of-this-test"


def grid_picture():
    """Eighteen dark markers; their centres (18, 2) in pixels."""
    grey = np.full((240, 320), 200, np.uint8)
    centres = [(60 + 40 * column, 80 + 40 * row) for row in range(3) for column in range(6)]
    for centre in centres:
        cv2.circle(grey, centre, 9, 30, -1, cv2.LINE_AA)
    return cv2.imencode(".png", grey)[1].tobytes(), np.array(centres, float)


@pytest.fixture
def writer(tmp_path):
    header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", 10.0, "-z", "press", synthetic=True)
    with open_trial(tmp_path / "trial_001.mcap", header, background=False) as writer:
        yield writer


def record(writer, seconds=1.0, lost=(), missing=(), picture=b""):
    for n in range(int(1000 * seconds)):
        time = 10.0 + n / 1000
        if n not in lost:
            writer.write_force(ForceRecord(time, n, n, 0, (0.0, 0.0, -2.0 if n == 777 else -1.0), (0.0, 0.0, 0.0)))
        if n % 10 == 0:
            writer.write_position(PositionRecord(time, 1e-3))
        if n % 40 == 0 and n // 40 not in missing:
            writer.write_frame(FrameRecord(time, n // 40, picture, "png"))
    writer.write_event(EventRecord(11.0, "segment", "4 of 5: hold"))
    writer._chunks.flush()


def test_a_page_hears_what_is_in_the_file(writer, tmp_path):
    picture, centres = grid_picture()
    record(writer, lost=(100, 101, 500), missing=(7, 8), picture=picture)
    news = LiveCapture(tmp_path).look()
    assert (news["trial"], news["protocol"], news["synthetic"], news["doing"]) == (
        "trial_001.mcap",
        "press",
        True,
        "4 of 5: hold",
    )
    assert news["force_lost"] == 3
    assert len(news["force"]) <= MOST_SAMPLES + 2
    assert max(force for _, force in news["force"]) == 2.0  # a peak between two samples sent is sent, too
    camera = news["camera"]
    assert camera["dropped"] == 2
    assert camera["rate"] == pytest.approx(25.0, rel=0.1)
    found = np.array(camera["markers"])
    assert np.abs(found - centres).max() < 0.2
    assert camera["radius"] == pytest.approx(9.0, abs=0.6)


def test_a_picture_without_markers_says_why(writer, tmp_path):
    record(writer, 0.1, picture=cv2.imencode(".png", np.full((240, 320), 128, np.uint8))[1].tobytes())
    assert "no markers" in LiveCapture(tmp_path).look()["camera"]["why"]


def test_a_picture_that_is_none_does_not_end_the_watch(writer, tmp_path):
    record(writer, 0.1, picture=b"no picture")
    assert LiveCapture(tmp_path).look()["camera"]["why"] == "the picture cannot be decoded"


def test_without_a_capture_it_waits(tmp_path):
    assert LiveCapture(tmp_path).look() == {"waiting": str(tmp_path)}


def test_how_a_trial_ended_stays_while_the_next_is_awaited(writer, tmp_path):
    live = LiveCapture(tmp_path)
    record(writer, 0.5)
    writer.write_event(EventRecord(10.6, "force_limit", "6.1 N; allowed are 6 N", "fault"))
    writer._chunks.flush()
    fault = ["force_limit: 6.1 N; allowed are 6 N"]
    assert [live.look()["faults"], live.look()["faults"]] == [
        fault,
        fault,
    ]  # for a page that missed the first
    writer.close()
    while "last" not in (news := live.look()):
        assert news["trial"] == "trial_001.mcap"
    last = {"trial": "trial_001.mcap", "synthetic": True, "seconds": pytest.approx(0.499), "faults": fault}
    assert news == {"waiting": str(tmp_path), "last": last}


def test_a_recording_that_falls_silent_is_told(writer, tmp_path, monkeypatch):
    now = [100.0]
    monkeypatch.setattr("benchmark.press.live_capture.time.monotonic", lambda: now[0])
    live = LiveCapture(tmp_path)
    record(writer, 0.1)
    silent = []
    for gone in (0.0, 1.0, 6.0):
        now[0] += gone
        silent.append(live.look()["silent_s"])
    record(writer, 0.1)
    assert [*silent, live.look()["silent_s"]] == [0.0, 0.0, 7.0, 0.0]


async def line(port, token=TOKEN, origin=None):
    headers = {"Origin": origin or f"http://127.0.0.1:{port}"}
    return await websocket_connect(HTTPRequest(f"ws://127.0.0.1:{port}/{token}/live", headers=headers))


def watched(place, conversation):
    """Run a conversation with a server that tells of a place."""

    async def go():
        with ThreadPoolExecutor(1) as worker:
            served = Served(TOKEN, b"the page", lambda _: {}, worker)
            server, port = make_server(served, 0, {"live": LiveLine})
            telling = asyncio.create_task(tell(served, LiveCapture(place), priority=0))
            try:
                return await conversation(port)
            finally:
                telling.cancel()
                server.stop()
                await server.close_all_connections()

    return asyncio.run(go())


def test_every_page_of_its_own_is_told(writer, tmp_path):
    import json

    record(writer, 0.1, picture=b"")

    async def talk(port):
        first, second = await line(port), await line(port)
        return [json.loads(await page.read_message())["trial"] for page in (first, second)]

    assert watched(tmp_path, talk) == ["trial_001.mcap"] * 2


@pytest.mark.parametrize(("token", "origin", "code"), [("wrong", None, 404), (TOKEN, "http://evil.example", 403)])
def test_others_are_refused(tmp_path, token, origin, code):
    async def talk(port):
        with pytest.raises(HTTPClientError) as refused:
            await line(port, token, origin)
        return refused.value.code

    assert watched(tmp_path, talk) == code


def test_a_page_that_says_anything_is_let_go(tmp_path):
    async def talk(port):
        page = await line(port)
        await page.write_message("stop the recording")
        while await page.read_message() is not None:
            pass
        return page.close_code

    assert watched(tmp_path, talk) == 1008
