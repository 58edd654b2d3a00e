"""Looking for devices."""

import pytest

from bench_hw.rig import survey as module
from bench_hw.rig.rig_file import load_rig
from bench_hw.rig.survey import survey, survey_rig


def test_nothing_is_sent_to_the_network_unasked(monkeypatch):
    monkeypatch.setattr(module, "_netft", lambda *_: pytest.fail("asked the network"))
    force = survey()[0]
    assert (force.kind, force.found) == ("netft", False)
    assert "--host" in force.fix


def test_every_kind_is_listed_with_a_fix_where_it_is_missing():
    findings = survey("127.0.0.1", http_port=9)
    assert {finding.device for finding in findings} == {"force", "actuator", "camera"}
    assert {finding.kind for finding in findings} == {"netft", "daq", "lac", "webcam", "v4l2"}
    for finding in findings:
        assert finding.found or finding.fix
        assert finding.to_dict()["device"] == finding.device


def test_a_simulated_rig_has_everything():
    assert all(finding.found for finding in survey_rig(load_rig("simulated")))


def test_each_missing_device_of_a_rig_is_named(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "netft"\nhost = "127.0.0.1"\nhttp_port = 9\n'
        '[actuator]\nkind = "lac"\nstroke = "50 mm"\nserial = "none such"\n'
        '[camera]\nkind = "images"\nfolder = "gone"\n'
    )
    findings = survey_rig(load_rig(path))
    assert [finding.found for finding in findings] == [False, False, False]
    assert "no answer" in findings[0].fix
    assert "LAC board" in findings[1].fix
    assert "is no folder" in findings[2].fix


@pytest.fixture
def cal(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "daq"\ndevice = "Dev1/ai0:5"\ncalibration = "gone.cal"\n'
        '[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
    )
    return load_rig(path)


def test_a_daq_rig_names_the_missing_calibration(cal):
    assert "gone.cal" in survey_rig(cal)[0].fix
