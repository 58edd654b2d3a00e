"""The simulated box on its sockets, with a client made of nothing but bytes."""

import socket
import urllib.error
import urllib.request

import numpy as np
import pytest

from bench_hw.clock import SimulatedClock
from bench_hw.devices.rdt import parse_records
from bench_hw.simulated.netft_box import BoxSettings, NetFTBox
from bench_hw.simulated.sensor import SensorModel


class Client:
    """A UDP client that writes the bytes of the manual."""

    def __init__(self, box, clock):
        self.box, self.clock = box, clock
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.setblocking(False)

    def send(self, text):
        self.socket.sendto(bytes.fromhex(text), ("127.0.0.1", self.box.rdt_port))

    def after(self, duration):
        self.clock.sleep(duration)
        datagrams = []
        while True:
            try:
                datagrams.append(self.socket.recv(65_536))
            except BlockingIOError:
                return datagrams


def pressed(instants):
    force = np.zeros((len(instants), 3))
    force[:, 2] = 3.0
    return force


@pytest.fixture
def clock():
    return SimulatedClock()


@pytest.fixture
def box(clock):
    settings = BoxSettings(rate=1000, sensor=SensorModel(force_noise=0.0, torque_noise=0.0), records_per_datagram=5)
    with NetFTBox(pressed, clock, settings, np.random.default_rng(1)) as box:
        yield box


@pytest.fixture
def client(box, clock):
    client = Client(box, clock)
    yield client
    client.socket.close()


def get(box, path):
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with opener.open(f"http://127.0.0.1:{box.http_port}{path}", timeout=5.0) as answer:
        return answer.read().decode()


def test_realtime_is_a_record_a_datagram_until_stop(client):
    client.send("12 34 00 02 00 00 00 00")
    datagrams = client.after(0.0205)
    assert {len(data) for data in datagrams} == {36}
    assert [int(parse_records(data)["rdt_sequence"][0]) for data in datagrams] == list(range(1, len(datagrams) + 1))
    assert datagrams[0][12:24].hex() == "0000000000000000ffd23940"  # Fx, Fy = 0, Fz = -3000000
    client.send("12 34 00 00 00 00 00 00")
    client.after(0.005)
    assert client.after(0.05) == []


def test_buffered_packs_records(client):
    client.send("12 34 00 03 00 00 00 00")
    assert {len(data) for data in client.after(0.05)} == {5 * 36}


def test_a_count_ends_by_itself(client, box):
    client.send("12 34 00 02 00 00 00 03")
    assert len(client.after(0.05)) == 3
    assert (box.sent, box.dropped) == (3, 0)


def test_bias_zeroes_the_present_load(client):
    client.send("12 34 00 42 00 00 00 00")
    client.after(0.005)
    client.send("12 34 00 02 00 00 00 01")
    (datagram,) = client.after(0.01)
    assert parse_records(datagram)["counts"].tolist() == [[0] * 6]


def test_the_latch_is_reset_on_request(client, box):
    box.set_status(0x80010000)
    client.send("12 34 00 02 00 00 00 01")
    assert client.after(0.01)[0][8:12].hex() == "80010000"
    client.send("12 34 00 41 00 00 00 00")
    client.after(0.005)
    client.send("12 34 00 02 00 00 00 01")
    assert client.after(0.01)[0][8:12].hex() == "00000000"


def test_a_later_client_takes_the_stream_over(client, box, clock):
    other = Client(box, clock)
    client.send("12 34 00 02 00 00 00 00")
    assert client.after(0.01)
    other.send("12 34 00 02 00 00 00 00")
    assert other.after(0.01)
    client.after(0.0)
    assert client.after(0.01) == []
    other.socket.close()


@pytest.mark.parametrize("rubbish", ["", "12 34", "00 00 00 02 00 00 00 00", "12 34 12 34 00 00 00 00"])
def test_rubbish_is_ignored(client, rubbish):
    client.send(rubbish)
    assert client.after(0.02) == []


def test_the_page_says_what_the_box_is(box):
    page = get(box, "/netftapi2.xml")
    for element in (
        "<netft>",
        "<cfgcalsn>FT00000</cfgcalsn>",
        "<cfgcpf>1000000</cfgcpf>",
        "<scfgfu>N</scfgfu>",
        "<scfgtu>N-m</scfgtu>",
        "<comrdtrate>1000</comrdtrate>",
        "<comrdtbsiz>5</comrdtbsiz>",
        "<cfgmr>25;25;35;0.25;0.25;0.25</cfgmr>",
    ):
        assert element in page


@pytest.mark.parametrize(("asked", "runs_at"), [(900, 1000), (3000, 3500), (7000, 7000), (0, 1000), (9999, 1000)])
def test_the_rate_is_set_by_the_boxs_rule(box, asked, runs_at):
    get(box, f"/comm.cgi?comrdtrate={asked}")
    assert f"<comrdtrate>{runs_at}</comrdtrate>" in get(box, "/netftapi2.xml")


@pytest.mark.parametrize(("asked", "becomes"), [(10, 10), (40, 40), (0, 5), (41, 5)])
def test_the_buffer_is_set_within_its_bounds(box, asked, becomes):
    get(box, f"/comm.cgi?comrdtbsiz={asked}")
    assert f"<comrdtbsiz>{becomes}</comrdtbsiz>" in get(box, "/netftapi2.xml")


def test_other_pages_are_not_there(box):
    with pytest.raises(urllib.error.HTTPError, match="404"):
        get(box, "/other")


def test_saturation_is_flagged(clock):
    def heavy(instants):
        return np.tile([0.0, 0.0, 50.0], (len(instants), 1))

    settings = BoxSettings(rate=1000, sensor=SensorModel(force_noise=0.0, torque_noise=0.0))
    with NetFTBox(heavy, clock, settings, np.random.default_rng(1)) as box:
        client = Client(box, clock)
        client.send("12 34 00 02 00 00 00 01")
        (datagram,) = client.after(0.01)
        client.socket.close()
    assert datagram[8:12].hex() == "80020000"
    assert parse_records(datagram)["counts"][0, 2] == -35_000_000
