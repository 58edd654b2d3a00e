"""Making and connecting the devices of a rig."""

import socket

import numpy as np
import pytest

from bench_hw.clock import SimulatedClock
from bench_hw.devices.protocols import ForceBlock
from bench_hw.errors import DeviceError, InputError
from bench_hw.rig.opening import open_bench
from bench_hw.rig.rig_file import load_rig, simulated_rig


def connect(loaded, clock=None):
    with open_bench(loaded, clock or SimulatedClock()) as bench:
        return bench.infos()


def test_a_simulated_rig_connects_and_tells_of_its_devices():
    infos = connect(load_rig("simulated"))
    assert set(infos) == {"force", "actuator", "camera"}
    assert infos["force"].serial == "FT00000"
    assert infos["actuator"].serial == "LAC00001"


def test_press_is_along_the_rigs_axis():
    wrench = np.arange(12.0).reshape(2, 6)
    numbers = np.zeros(2, np.uint32)
    for axis, expected in (("-z", [-2.0, -8.0]), ("+x", [0.0, 6.0]), ("-y", [-1.0, -7.0])):
        loaded = simulated_rig({"force": {"press_axis": axis}, "camera": None})
        with open_bench(loaded, SimulatedClock()) as bench:
            block = ForceBlock(np.array([0.0, 1.0]), wrench, numbers, numbers, numbers)
            assert bench.press(block).tolist() == expected


@pytest.mark.parametrize(
    ("section", "keys", "says"),
    [
        ("force", {"serial": "FT99999"}, r"serial 'FT00000'; the rig asks for 'FT99999'"),
        ("actuator", {"serial": "LAC9"}, r"serial 'LAC00001'; the rig asks for 'LAC9'"),
        ("camera", {"calibration": "gone.toml"}, r"camera\.calibration 'gone\.toml': .*cannot be read"),
    ],
)
def test_a_wrong_device_is_refused_and_nothing_moves(section, keys, says):
    with pytest.raises(DeviceError, match=says):
        connect(simulated_rig({section: keys}))


def test_a_wrong_address_is_refused_and_the_others_are_let_go(tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    path = tmp_path / "rig.toml"
    path.write_text(
        f'schema = 1\nname = "r"\n[force]\nkind = "netft"\nhost = "127.0.0.1"\nhttp_port = {port}\n'
        '[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
    )
    with pytest.raises(DeviceError, match=f"http://127.0.0.1:{port}/netftapi2.xml: no answer"):
        connect(load_rig(path))


def test_a_missing_daq_calibration_is_refused(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "daq"\ndevice = "Dev1/ai0:5"\ncalibration = "gone.cal"\n'
        '[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
    )
    with pytest.raises(DeviceError, match=r"gone\.cal: cannot be read"):
        connect(load_rig(path))


def test_a_camera_calibration_of_another_size_is_refused(tmp_path):
    (tmp_path / "camera.toml").write_text("schema = 1\nimage_size = [1280, 720]\n")
    loaded = simulated_rig({"camera": {"calibration": str(tmp_path / "camera.toml")}})
    with pytest.raises(DeviceError, match=r"made for pictures of \[1280, 720\] pixels"):
        connect(loaded)


def test_picture_files_beside_the_rig_file(tmp_path):
    (tmp_path / "pictures").mkdir()
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "simulated"\n[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
        '[camera]\nkind = "images"\nfolder = "pictures"\n'
    )
    with pytest.raises(DeviceError, match=r"no picture in .*pictures"):
        connect(load_rig(path))


def test_a_fault_of_a_device_that_is_not_simulated_is_refused():
    loaded = simulated_rig({"camera": None, "simulation": {"faults": [{"kind": "camera_freeze", "at": "1 s"}]}})
    with pytest.raises(InputError, match="camera_freeze"):
        open_bench(loaded, SimulatedClock())


def test_a_stream_over_http_must_have_the_rigs_size():
    loaded = simulated_rig({"camera": {"kind": "http", "url": "http://127.0.0.1:1/x", "size": [64, 48]}})
    bench = open_bench(loaded, SimulatedClock())
    try:
        assert bench.camera._size == (64, 48)
    finally:
        bench.close()


def test_a_specimen_that_there_is_not_is_told_with_its_key():
    loaded = simulated_rig({"camera": None, "simulation": {"specimen": "phantm"}})
    with pytest.raises(InputError, match=r"simulated\.toml: key simulation\.specimen: specimen 'phantm': no such file"):
        open_bench(loaded, SimulatedClock())


def test_the_travel_is_set_in_the_board():
    with open_bench(load_rig("simulated"), SimulatedClock()) as bench:
        heard = [data.hex(" ") for data in bench.twins.board.received]
    assert "02 00 00" in heard
    assert "03 99 01" in heard
