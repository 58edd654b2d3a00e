"""Recordings in MCAP by another program: JSON topics on one clock, and what is refused or asked for."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.instrument_files import Told, preview, read_instrument_file
from bench_hw.instrument_files.mcap_topics import is_foreign, topic_blocks
from tests.instruments.samples import WRENCH, cdr, encoded, press, recording, robot_mcap

ONE = press()


def one_topic(path, messages, schema=None, name="rig/Sample", encoding="json"):
    times = (5.0 + ONE.time).tolist()
    return recording(path, {"/rig": (name, schema or {}, list(zip(times, messages, strict=True)))}, encoding)


def rig(force="force_N", depth="depth_mm"):
    return [{force: f, depth: d, "state": "ok"} for f, d in zip(ONE.force.tolist(), ONE.depth.tolist(), strict=True)]


def test_topics_come_on_the_clock_of_the_force(tmp_path):
    (record,) = read_instrument_file(robot_mcap(tmp_path)).records
    np.testing.assert_allclose(np.diff(record.table.time), 0.02, atol=1e-6)
    steady = np.abs(record.table.depth - 1e-3 * ONE.depth[: len(record.table.depth)])
    assert np.median(steady) < 2e-5
    text = "\n".join(preview(read_instrument_file(robot_mcap(tmp_path))))
    for said in ("/ft, with /stage at its times", "time from time stamp", "force.z [N]", "position [mm]", "is turned"):
        assert said in text


def test_plain_messages_are_read_by_their_names(tmp_path):
    (record,) = read_instrument_file(one_topic(tmp_path / "a.mcap", rig())).records
    np.testing.assert_allclose(record.table.force, ONE.force)
    assert record.columns["time"] == "time [s]"


def test_joints_are_columns_by_their_names_and_their_unit_is_asked_for(tmp_path):
    messages = [
        {"name": ["actuator", "wrist"], "position": [d, 0.3], "effort": [f, 0.0]}
        for f, d in zip(ONE.force.tolist(), ONE.depth.tolist(), strict=True)
    ]
    path = one_topic(tmp_path / "joints.mcap", messages, name="sensor_msgs/JointState")
    with pytest.raises(InputError, match=r"unit of the position.*import\.depth=\"actuator position:mm\""):
        read_instrument_file(path)
    told = Told({"force": "actuator effort:N", "depth": "actuator position:mm"})
    (record,) = read_instrument_file(path, told).records
    np.testing.assert_allclose(record.table.force, ONE.force)


def apart(path):
    times = ONE.time.tolist()
    force = [(t, {"force_N": f}) for t, f in zip(times, ONE.force.tolist(), strict=True)]
    depth = [(100.0 + t, {"depth_mm": d}) for t, d in zip(times, ONE.depth.tolist(), strict=True)]
    return recording(path, {"/force": ("f", {}, force), "/depth": ("d", {}, depth)})


def damaged(path):
    one_topic(path, rig())
    path.write_bytes(path.read_bytes()[:-400])
    return path


@pytest.mark.parametrize(
    ("write", "message"),
    [
        (lambda path: one_topic(path, rig(), encoding="cdr"), r"/rig \(cdr.*instruments.*import\.force"),
        (lambda path: one_topic(path, rig(), encoding="protobuf"), r"/rig \(protobuf"),
        (lambda path: one_topic(path, rig(force="load")), r"unit of the force.*import\.force"),
        (lambda path: one_topic(path, rig(force="voltage")), r"no column is the force.*import\.force"),
        (lambda path: one_topic(path, [{"state": "ok"}] * len(ONE.time)), "no topic"),
        (lambda path: recording(path, {}), "no messages"),
        (apart, "do not overlap in time"),
        (damaged, "no whole MCAP recording"),
    ],
)
def test_what_cannot_be_read_is_refused_with_the_way_out(write, message, tmp_path):
    path = write(tmp_path / "other.mcap")
    assert is_foreign(path)
    with pytest.raises(InputError, match=message) as refusal:
        read_instrument_file(path)
    assert "\n" not in str(refusal.value)
    assert str(path) in str(refusal.value)


def test_a_message_that_breaks_off_is_named(tmp_path):
    pytest.importorskip("mcap_ros2", reason="needs the extra `instruments`")
    messages = [(5.0 + 0.1 * k, cdr(5.0 + 0.1 * k, *range(6))) for k in range(40)]
    messages[30] = (messages[30][0], messages[30][1][:40])
    topics = {"/ft": ("geometry_msgs/msg/WrenchStamped", WRENCH.encode(), messages)}
    path = encoded(tmp_path / "bag.mcap", topics, "cdr", "ros2msg")
    with pytest.raises(InputError, match=r"message 31 of /ft cannot be read \(cdr"):
        read_instrument_file(path)


def test_a_picture_beside_the_force_gives_no_columns(tmp_path):
    messages = [{**each, "data": [7] * 900} for each in rig()]
    (block,) = topic_blocks(one_topic(tmp_path / "a.mcap", messages))
    assert block.names == ("time", "force", "depth")


@pytest.mark.parametrize("head", [b"", b"\x89MCAP0\r\n", b"no recording at all, but text"])
def test_what_has_no_whole_head_is_the_benchs_to_recover(head, tmp_path):
    path = tmp_path / "cut.mcap"
    path.write_bytes(head)
    assert not is_foreign(path)
    with pytest.raises(InputError, match="bench_hw capture"):
        read_instrument_file(path)
