"""What a rig file may say."""

import re
import typing
from pathlib import Path

import pytest

from bench_hw.configuration import StrictModel
from bench_hw.errors import InputError
from bench_hw.rig.opening import sheet_of, specimen_of
from bench_hw.rig.rig_file import Rig, ScheduledFault, load_rig, shipped_rigs, simulated_rig
from bench_hw.simulated.tabulated import read_sheet
from bench_hw.simulated.virtual_specimen import SpecimenFile

FORCE = '[force]\nkind = "netft"\nhost = "192.0.2.10"\n'
ACTUATOR = '[actuator]\nkind = "lac"\nstroke = "50 mm"\n'
HEAD = 'schema = 1\nname = "bench-1"\n'


@pytest.fixture
def load(tmp_path):
    def load(text):
        path = tmp_path / "rig.toml"
        path.write_text(text)
        return load_rig(path).rig

    return load


def test_the_documented_file(load):
    rig = load(
        HEAD
        + FORCE
        + 'rate = "1000 Hz"\nmode = "realtime"\nbias = false\nserial = "FT12345"\npress_axis = "-z"\n'
        + ACTUATOR
        + '[camera]\nkind = "webcam"\nrate = "30 Hz"\nsize = [640, 480]\ncalibration = "camera.toml"\n'
        + '[safety]\nforce_limit = "6 N"\nforce_stale = "50 ms"\ntravel = ["0 mm", "20 mm"]\n'
    )
    assert (rig.force.http_port, rig.force.rdt_port, rig.force.rate) == (80, 49152, 1000.0)
    assert (rig.actuator.stroke, rig.travel) == (pytest.approx(0.05), pytest.approx((0.0, 0.02)))
    assert (rig.safety.force_limit, rig.safety.force_stale) == (6.0, pytest.approx(0.05))
    assert rig.camera.size == (640, 480)
    assert not rig.simulated


def test_what_is_left_out_has_safe_defaults(load):
    rig = load(HEAD + FORCE + ACTUATOR)
    assert (rig.safety.force_limit, rig.safety.force_stale) == (6.0, 0.05)
    assert rig.travel == (0.0, pytest.approx(0.05))
    assert rig.camera is None


def test_a_daq_names_its_calibration(load):
    rig = load(HEAD + '[force]\nkind = "daq"\ndevice = "Dev1/ai0:5"\ncalibration = "FT12345.cal"\n' + ACTUATOR)
    assert rig.force.calibration == "FT12345.cal"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (HEAD + ACTUATOR, "force: is missing"),
        (HEAD + FORCE + "colour = 1\n" + ACTUATOR, "colour: is unknown here"),
        (HEAD + FORCE + 'rate = "8 kHz"\n' + ACTUATOR, "allowed is at most 7000 Hz"),
        (HEAD + FORCE + 'press_axis = "z"\n' + ACTUATOR, "press_axis"),
        (HEAD + FORCE + "http_port = 99999\n" + ACTUATOR, "http_port"),
        (HEAD + FORCE.replace("netft", "scale") + ACTUATOR, "force"),
        (HEAD + FORCE + ACTUATOR + 'contact = "60 mm"\n', "outside safety.travel"),
        (HEAD + FORCE + ACTUATOR + '[safety]\ntravel = ["5 mm", "60 mm"]\n', "allowed is 0 <= low < high <= stroke"),
        (HEAD + FORCE + ACTUATOR + '[safety]\ntravel = ["9 mm", "5 mm"]\n', r"rig\.toml: safety\.travel is 9 to 5 mm"),
        (HEAD + FORCE + ACTUATOR + '[safety]\nforcelimit = "5 N"\n', "safety.forcelimit: .* did you mean force_limit"),
        (HEAD + FORCE + "hots = 1\n" + ACTUATOR, "key force.hots: is unknown here; did you mean host"),
        (HEAD + FORCE + ACTUATOR + '[safety]\nforce_limit = "0 N"\n', "allowed is more than 0 N"),
        (HEAD + FORCE + ACTUATOR + '[camera]\nkind = "simulated"\n', "knows nothing of a real tool"),
        (HEAD + '[force]\nkind = "simulated"\n' + ACTUATOR, "could not protect the specimen"),
        ("schema = 3\n" + FORCE + ACTUATOR, "schema"),
        (
            HEAD + '[force]\nkind = "netft"\nhost = "my box"\n' + ACTUATOR,
            "key force.host = 'my box': allowed is the name",
        ),
        (HEAD + '[force]\nkind = "netft"\nhost = "a\\nb"\n' + ACTUATOR, "allowed is the name or address of a host"),
        (HEAD + '[force]\nkind = "netft"\nhost = "box/path"\n' + ACTUATOR, "without blanks and slashes"),
    ],
)
def test_refuses_with_file_and_key(load, text, says):
    with pytest.raises(InputError, match=says) as caught:
        load(text)
    assert "rig.toml" in str(caught.value)


def test_a_real_force_sensor_may_stand_beside_a_simulated_actuator(load):
    rig = load(HEAD + FORCE + ACTUATOR.replace("lac", "simulated"))
    assert rig.simulated
    assert not rig.all_simulated


def test_the_shipped_rig_is_all_simulated():
    assert "simulated" in shipped_rigs()
    loaded = load_rig("simulated")
    assert loaded.rig.all_simulated
    assert 'name = "simulated"' in loaded.text


def test_changes_to_the_shipped_rig_are_checked_and_stand_in_its_text():
    loaded = simulated_rig({"force": {"rate": "500 Hz"}, "camera": None})
    assert (loaded.rig.force.rate, loaded.rig.camera) == (500.0, None)
    assert "500 Hz" in loaded.text
    with pytest.raises(InputError, match="colour"):
        simulated_rig({"force": {"colour": 1}})


def test_an_unknown_name_lists_the_shipped_ones():
    with pytest.raises(InputError, match=r"rig 'simulatd'.*simulated"):
        load_rig("simulatd")


def test_the_rig_of_the_demonstration_says_what_is_pressed() -> None:
    loaded = load_rig("simulated_phantom")
    assert specimen_of(loaded) is None
    keys = sheet_of(loaded).session_keys()
    assert keys["specimen"] == "rtv3498_sheet"
    assert keys["tool"] == {"radius": "5 mm", "contact": "rigid_bonded"}
    deepest = loaded.rig.safety.travel[1] - loaded.rig.actuator.contact
    assert deepest <= read_sheet("phantom").depth[-1]
    plain = load_rig("simulated").rig
    assert (plain.force, plain.camera, plain.actuator) == (loaded.rig.force, loaded.rig.camera, loaded.rig.actuator)


def models(annotation):
    """Each model in an annotation, and in the fields of these."""
    if isinstance(annotation, type) and issubclass(annotation, StrictModel):
        yield annotation
        for field in annotation.model_fields.values():
            yield from models(field.annotation)
    for part in typing.get_args(annotation):
        yield from models(part)


def test_the_manual_has_every_key():
    """It sent the reader to a page on which no key of a rig stood."""
    manual = (Path(__file__).parents[3] / "docs" / "bench.md").read_text()
    section = manual.partition("## A rig file, key by key")[2].partition("## Safety")[0]
    known = set(re.findall(r"`\[{0,2}(\w+)\]{0,2}`", section))
    inside = [model for root in (Rig, SpecimenFile) for model in models(root)]
    assert {field.alias or name for each in inside for name, field in each.model_fields.items()} <= known
    assert set(typing.get_args(ScheduledFault.model_fields["kind"].annotation)) <= known
