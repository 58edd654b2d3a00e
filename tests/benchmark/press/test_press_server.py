"""The served page: this machine alone, with the token, from its own page; whatever else comes, it lives."""

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from benchmark.press.press_server import LONGEST_MESSAGE, FemOnDemand, Served, make_server

TOKEN = "a-token-of-this-test"


@pytest.fixture
def served(specimen):
    with ThreadPoolExecutor(1) as worker:
        yield Served(TOKEN, b"<!DOCTYPE html>the page", FemOnDemand([specimen]).answer, worker)


def asked(served, conversation):
    """Run a conversation with a server; it must still answer at the end."""

    async def go():
        server, port = make_server(served, 0)
        try:
            found = await conversation(port)
            response = await AsyncHTTPClient().fetch(f"http://127.0.0.1:{port}/{TOKEN}/")
            assert response.body == served.page
        finally:
            server.stop()
            await server.close_all_connections()
        return found

    return asyncio.run(go())


async def code(address, **headers):
    try:
        return (await AsyncHTTPClient().fetch(HTTPRequest(address, headers=headers))).code
    except HTTPClientError as error:
        return error.code


async def line(port, token=TOKEN, origin=None):
    headers = {} if origin == "none" else {"Origin": origin or f"http://127.0.0.1:{port}"}
    return await websocket_connect(HTTPRequest(f"ws://127.0.0.1:{port}/{token}/fem", headers=headers))


def test_without_the_token_there_is_nothing(served):
    async def talk(port):
        base = f"http://127.0.0.1:{port}"
        return [
            await code(f"{base}{path}") for path in ("/", "/wrong/", f"/{TOKEN}x/", f"/{TOKEN}/other", "/wrong/fem")
        ]

    assert asked(served, talk) == [404] * 5


def test_another_name_of_the_host_is_refused(served):
    async def talk(port):
        return [
            await code(f"http://127.0.0.1:{port}/{TOKEN}/", Host=host)
            for host in ("evil.example", f"evil.example:{port}")
        ]

    assert asked(served, talk) == [403, 403]


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "none", "https://127.0.0.1", "file://"])
def test_another_origin_gets_no_line(served, origin):
    async def talk(port):
        with pytest.raises(HTTPClientError) as refused:
            await line(port, origin=origin)
        return refused.value.code

    assert asked(served, talk) == 403


def test_a_wrong_token_gets_no_line(served):
    async def talk(port):
        with pytest.raises(HTTPClientError) as refused:
            await line(port, token="guess")
        return refused.value.code

    assert asked(served, talk) == 404


HISTORY = [[0.1, 1e-4], [0.2, 2e-4]]
MALFORMED = [
    "", "{", "[]", "7", "null", '{"press": 0}', "[" * 10_000, '{"press": NaN}',
    json.dumps({"press": 9, "history": HISTORY}),
    json.dumps({"press": -1, "history": HISTORY}),
    json.dumps({"press": "0; rm", "history": HISTORY}),
    json.dumps({"press": 0, "history": [[0.2, 1e-4], [0.1, 2e-4]]}),
    json.dumps({"press": 0, "history": [[0.1, 1e-4], [0.2, 1.0]]}),
    json.dumps({"press": 0, "history": [[0.1, -1e-4], [0.2, 1e-4]]}),
    json.dumps({"press": 0, "history": [[0.1, 1e-4]] * 1000}),
    json.dumps({"press": 0, "history": [[1e9, 1e-4], [2e9, 2e-4]]}),
    json.dumps({"press": 0, "history": HISTORY, "strength": [0.9, 0.9], "time_s": [1.0, 2.0]}),
    json.dumps({"press": 0, "history": HISTORY, "strength": [0.3], "time_s": []}),
    json.dumps({"press": 0, "history": HISTORY, "file": "/etc/passwd"}),
]  # fmt: skip


def test_malformed_messages_are_refused_and_the_line_lives(served):
    async def talk(port):
        open_line = await line(port)
        answers = []
        for message in MALFORMED:
            await open_line.write_message(message)
            answers.append(json.loads(await open_line.read_message()))
        await open_line.write_message(b"\x00\xff", binary=True)
        answers.append(json.loads(await open_line.read_message()))
        await open_line.write_message(json.dumps({"press": 0, "history": HISTORY}))
        return answers, json.loads(await open_line.read_message())

    answers, last = asked(served, talk)
    assert [list(answer) for answer in answers] == [["error"]] * (len(MALFORMED) + 1)
    assert not any("passwd" in answer["error"] for answer in answers)
    assert len(last["force_N"]) == 2


def test_an_oversized_message_ends_its_line_alone(served):
    async def talk(port):
        long, other = await line(port), await line(port)
        await long.write_message("x" * (LONGEST_MESSAGE + 1))
        closed = await long.read_message()
        await other.write_message("{")
        return closed, json.loads(await other.read_message())

    closed, answer = asked(served, talk)
    assert closed is None
    assert "error" in answer


def test_only_so_many_pages_at_once(served):
    async def talk(port):
        lines = [await line(port) for _ in range(4)]
        with pytest.raises(HTTPClientError) as refused:
            await line(port)
        for each in lines:
            each.close()
        return refused.value.code

    assert asked(served, talk) == 503


def test_it_listens_on_the_loopback_interface_alone(served):
    async def talk(port):
        others = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)} - {"127.0.0.1"}
        reached = []
        for address in others:
            with socket.socket() as probe:
                probe.settimeout(0.5)
                reached.append(probe.connect_ex((address, port)) == 0)
        return reached

    assert not any(asked(served, talk))


def test_the_finite_elements_follow_a_press_as_it_was_made(specimen):
    time = np.linspace(0.05, 1.0, 20)
    depth = np.minimum(time / 0.3, 1.0) * 0.6 * specimen.fem.table.deepest
    history = np.column_stack([time, depth]).tolist()
    oracle = FemOnDemand([specimen])
    plain = oracle.answer(json.dumps({"press": 0, "history": history}))
    ramp = np.interp(depth, specimen.fem.table.depth, specimen.fem.table.force)
    np.testing.assert_allclose(plain["force_N"], ramp, rtol=2e-3)
    assert plain["faces_m"][0][0] == pytest.approx(depth[-1], rel=1e-6)
    fading = oracle.answer(json.dumps({"press": 0, "history": history, "strength": [0.4], "time_s": [0.3]}))
    assert 0.6 * ramp[-1] < fading["force_N"][-1] < 0.75 * ramp[-1]


@pytest.mark.skipif(os.name != "posix", reason="needs signals as POSIX has them")
def test_ctrl_c_ends_it_cleanly():
    command = [sys.executable, "-m", "benchmark", "press", "skin-5N", "--no-browser", "--json", "--quiet"]
    settings = ["--set", "fem.mesh=coarse", "--set", "wave.large_press=linear", "--set", "load.peak=1 N"]
    with subprocess.Popen([*command, *settings], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        address = json.loads(process.stdout.readline())["address"]
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=30)
    assert address.startswith("http://127.0.0.1:")
    assert (process.returncode, *said) == (0, "", "")
