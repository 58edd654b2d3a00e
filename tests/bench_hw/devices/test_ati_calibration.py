"""ATI calibration files: both versions of the same made-up transducer (synthetic numbers)."""

import numpy as np
import pytest

from bench_hw.devices.ati_calibration import read_calibration
from bench_hw.errors import DeviceError


@pytest.fixture
def read(tmp_path, calibration_text):
    def read(text=None, **options):
        path = tmp_path / "FT54321.cal"
        path.write_text(calibration_text(**options) if text is None else text)
        return read_calibration(path)

    return read


def test_version_1_1_takes_the_user_axis(read, made_up_transducer):
    found = read(version="1.1")
    assert found.matrix == pytest.approx(made_up_transducer, abs=1e-8)
    assert (found.serial, found.full_scale) == ("FT54321", 10.0)
    assert found.ranges == pytest.approx([25, 25, 35, 0.25, 0.25, 0.25])


@pytest.mark.parametrize(("torque", "distance"), [("N-mm", "mm"), ("N-m", "m"), ("N-mm", "m"), ("N-m", "mm")])
def test_version_1_0_agrees_with_1_1_of_the_same_sensor(read, torque, distance):
    new = read(version="1.1", torque="N-mm", distance="mm").matrix
    old = read(version="1.0", torque=torque, distance=distance).matrix
    in_the_files_units = np.repeat([1.0, 1e3], 3)[:, None]
    assert np.abs((old - new) * in_the_files_units).max() < 1e-5


def test_the_wrong_sign_of_the_shift_would_be_far_off(read, made_up_transducer):
    """The trap: the torque rows with the other sign differ by N-mm, not by 1e-5."""
    old = read(version="1.0").matrix
    forces, torques = old[:3], old[3:]
    twice = 2.0 * np.cross(np.array([0.35, -0.20, 6.10]) * 1e-3, forces.T).T
    assert np.abs((torques + twice - made_up_transducer[3:]) * 1e3).max() > 40.0


def test_a_wrench_from_volts(read, made_up_transducer):
    found = read()
    volts = np.array([[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.5] * 6])
    bias = np.full(6, 0.5)
    assert found.wrench(volts, bias)[1] == pytest.approx(np.zeros(6), abs=1e-12)
    assert found.wrench(volts, bias)[0] == pytest.approx(made_up_transducer @ (volts[0] - 0.5), abs=1e-6)


def test_the_fingerprint_follows_the_file(read):
    assert read().fingerprint == read().fingerprint
    assert read().fingerprint != read(serial="FT54322").fingerprint


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("1.1", "2.0"), "CalFileVersion = '2.0'; allowed is 1.0 or 1.1"),
        (('Name="Fx"', 'Name="Q"'), "without Fx"),
        (('ForceUnits="N"', 'ForceUnits="stone"'), "ForceUnits = 'stone'"),
        (("<UserAxis", "<Other"), "no <UserAxis>; allowed is six"),
        (("</FTSensor>", ""), "no XML"),
        (("FTSensor", "Sensor"), "root <Sensor>"),
        (("-0.01120", "many"), "values = 'many"),
        (("-0.01120", ""), "six numbers"),
    ],
)
def test_refuses_with_file_and_element(read, calibration_text, change, says):
    with pytest.raises(DeviceError, match=says) as caught:
        read(calibration_text().replace(*change))
    assert "FT54321.cal" in str(caught.value)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (('Rx="0"', 'Rx="90"'), "turned by"),
        (('scale="2.75"', 'scale="0"'), "scale"),
        (("<BasicTransform", "<Gone"), "no <BasicTransform>"),
        (('DistUnits="mm"', 'DistUnits="ell"'), "DistUnits"),
    ],
)
def test_refuses_what_only_version_1_0_needs(read, calibration_text, change, says):
    with pytest.raises(DeviceError, match=says):
        read(calibration_text(version="1.0").replace(*change))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(DeviceError, match=r"gone\.cal: cannot be read"):
        read_calibration(tmp_path / "gone.cal")


def test_entities_are_not_expanded(read):
    with pytest.raises(DeviceError, match="no XML"):
        read('<!DOCTYPE a [<!ENTITY b "c">]><FTSensor>&b;</FTSensor>')
