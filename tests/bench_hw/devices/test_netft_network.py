"""The Net F/T box's XML configuration and its web interface."""

import math
import time

import pytest

from bench_hw.devices.netft_network import fetch, parse_configuration, read_configuration, set_rate
from bench_hw.errors import DeviceError

PAGE = """<?xml version="1.0"?>
<netft><prodname>Net F/T</prodname><runstat>0x00000000</runstat><cfgcalsn>FT12345</cfgcalsn>
<scfgfu>{fu}</scfgfu><scfgtu>{tu}</scfgtu><cfgcpf>{cpf}</cfgcpf><cfgcpt>1000000</cfgcpt>
<cfgmr>25;25;35;250;250;250</cfgmr><comrdte>Enabled</comrdte><comrdtrate>1000</comrdtrate>
<comrdtbsiz>10</comrdtbsiz></netft>"""


def page(fu="N", tu="N-mm", cpf="1000000") -> bytes:
    return PAGE.format(fu=fu, tu=tu, cpf=cpf).encode()


def test_reads_what_the_box_says_of_itself():
    found = parse_configuration(page(), "box")
    assert (found.product, found.serial, found.rate, found.buffer) == ("Net F/T", "FT12345", 1000, 10)
    assert found.newton_per_count == 1e-6
    assert found.newton_metre_per_count == pytest.approx(1e-9, rel=1e-12)
    assert found.ranges == pytest.approx((25.0, 25.0, 35.0, 0.25, 0.25, 0.25))
    assert (found.enabled, found.status) == (True, 0)


@pytest.mark.parametrize(
    ("unit", "si"), [("Nmm", 1e-3), ("N-mm", 1e-3), ("Nm", 1.0), ("N-m", 1.0), ("lbf-in", 0.112985)]
)
def test_torque_units_with_and_without_a_dash(unit, si):
    found = parse_configuration(page(tu=unit), "box")
    assert found.newton_metre_per_count == pytest.approx(1e-6 * si, rel=1e-5)


@pytest.mark.parametrize(
    ("bad", "says"),
    [
        (b"no xml at all", "no XML"),
        (b"<html></html>", "root element <html>"),
        (page(fu="stone"), "scfgfu = 'stone'"),
        (page(cpf="0"), "cfgcpf = '0'"),
        (page(cpf="many"), "cfgcpf = 'many'"),
        (page(cpf="inf"), "cfgcpf = 'inf'"),
        (b"<netft></netft>", "cfgcpf = ''"),
        (page().replace(b"0x00000000", b"healthy"), "runstat = 'healthy'"),
        (b'<!DOCTYPE a [<!ENTITY b "c">]><netft>&b;</netft>', "no XML"),
    ],
)
def test_refuses_with_the_element_and_its_value(bad, says):
    with pytest.raises(DeviceError, match=says):
        parse_configuration(bad, "10.1.2.3:80")


def test_ranges_that_are_not_six_numbers_are_unknown():
    found = parse_configuration(page().replace(b"25;25;35;250;250;250", b"25;25"), "box")
    assert all(math.isnan(value) for value in found.ranges)


def test_the_fingerprint_follows_the_calibration():
    same, other = parse_configuration(page(), "a"), parse_configuration(page(cpf="500000"), "a")
    assert same.fingerprint == parse_configuration(page(), "b").fingerprint
    assert same.fingerprint != other.fingerprint


def test_asks_with_the_exact_request_lines(tcp_server):
    heard: list[bytes] = []

    def answer(client):
        heard.append(client.recv(4096))
        body = page()
        client.sendall(b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\n\r\n" % len(body) + body)

    port = tcp_server(answer)
    read_configuration("127.0.0.1", port, 2.0)
    set_rate("127.0.0.1", port, 1000, 2.0)
    set_rate("127.0.0.1", port, 7000, 2.0, buffer=40)
    assert heard[0].startswith(b"GET /netftapi2.xml HTTP/1.1\r\n")
    assert heard[1].startswith(b"GET /comm.cgi?comrdtrate=1000 HTTP/1.1\r\n")
    assert heard[2].startswith(b"GET /comm.cgi?comrdtrate=7000&comrdtbsiz=40 HTTP/1.1\r\n")


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n", "status 404"),
        (b"SSH-2.0-thing\r\n", "no answer"),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 2000000\r\n\r\n" + b"x" * 2_000_000, "larger than"),
    ],
)
def test_what_is_no_box_is_said_to_be_none(tcp_server, answer, says):
    def talk(client):
        client.recv(4096)
        client.sendall(answer)

    with pytest.raises(DeviceError, match=says):
        fetch("127.0.0.1", tcp_server(talk), "/netftapi2.xml", 2.0)


def test_a_silent_address_ends_at_the_time_out(tcp_server):
    port = tcp_server(lambda client: client.recv(4096) and client.recv(4096))
    with pytest.raises(DeviceError, match=r"no answer .* within 0\.2 s, .*; check host"):
        fetch("127.0.0.1", port, "/", 0.2)


def test_nobody_there_is_one_clear_error(ear):
    with pytest.raises(DeviceError, match="no answer"):
        fetch("127.0.0.1", ear.port, "/", 1.0)


@pytest.mark.parametrize(
    "head", [b"HTTP/1.1 200 OK\r\nContent-Length: 1000\r\n\r\n", b"HTTP/1.0 200 OK\r\n\r\n", b"HTTP/1.1 200 OK\r\nX: "]
)
def test_a_box_that_drips_is_given_up_after_a_total_time(tcp_server, head):
    def drip(client):
        client.recv(4096)
        client.sendall(head)
        for _ in range(200):  # each byte within the time-out of a piece
            client.sendall(b"x")
            time.sleep(0.05)

    started = time.monotonic()
    with pytest.raises(DeviceError, match=r"no whole one within 0\.6 s"):
        fetch("127.0.0.1", tcp_server(drip), "/", 0.2)
    assert time.monotonic() - started < 8.0, "10 s is what the box would take"
