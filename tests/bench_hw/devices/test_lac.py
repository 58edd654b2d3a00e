"""The LAC board's bytes, and its driver through the whole of pyusb against the simulated board."""

import pytest
import usb.core

from bench_hw.devices.lac import LacActuator
from bench_hw.devices.lac_usb import GUARDED, LARGEST, Code, packet, parse
from bench_hw.errors import DeviceError
from bench_hw.simulated.lac_board import LacUsbBackend

COUNT = 0.050 / 1024


@pytest.fixture
def actuator(usb):
    with LacActuator(0.050, backend=usb, accuracy=4) as actuator:
        yield actuator


@pytest.mark.parametrize(
    ("code", "value", "golden"),
    [
        (Code.SET_ACCURACY, 4, "01 04 00"),
        (Code.SET_RETRACT_LIMIT, 0, "02 00 00"),
        (Code.SET_EXTEND_LIMIT, 1023, "03 ff 03"),
        (Code.SET_MOVEMENT_THRESHOLD, 3, "04 03 00"),
        (Code.SET_STALL_TIME, 1000, "05 e8 03"),
        (Code.SET_PWM_THRESHOLD, 80, "06 50 00"),
        (Code.SET_DERIVATIVE_THRESHOLD, 10, "07 0a 00"),
        (Code.SET_DERIVATIVE_MAXIMUM, 1023, "08 ff 03"),
        (Code.SET_DERIVATIVE_MINIMUM, 0, "09 00 00"),
        (Code.SET_PWM_MAXIMUM, 1023, "0a ff 03"),
        (Code.SET_PWM_MINIMUM, 80, "0b 50 00"),
        (Code.SET_PROPORTIONAL_GAIN, 1, "0c 01 00"),
        (Code.SET_DERIVATIVE_GAIN, 10, "0d 0a 00"),
        (Code.SET_AVERAGE_RC, 4, "0e 04 00"),
        (Code.SET_AVERAGE_ADC, 8, "0f 08 00"),
        (Code.GET_FEEDBACK, 0, "10 00 00"),
        (Code.SET_POSITION, 512, "20 00 02"),
        (Code.SET_SPEED, 1023, "21 ff 03"),
        (Code.DISABLE_MANUAL, 0, "30 00 00"),
        (Code.RESET, 0, "ff 00 00"),
    ],
)
def test_golden_bytes_of_every_command(code, value, golden):
    assert packet(code, value) == bytes.fromhex(golden)
    assert parse(bytes.fromhex(golden)) == (code, value)


def test_every_command_has_golden_bytes():
    (parameters,) = (mark for mark in test_golden_bytes_of_every_command.pytestmark if mark.name == "parametrize")
    assert {row[0] for row in parameters.args[1]} == set(Code)


@pytest.mark.parametrize("value", [-1, 1024])
def test_values_outside_ten_bits_are_refused(value):
    with pytest.raises(ValueError, match="0 to 1023"):
        packet(Code.SET_SPEED, value)


@pytest.mark.parametrize("data", [b"", b"\x01", b"\x01\x02", b"\x01\x02\x03\x04"])
def test_other_lengths_are_no_packet(data):
    assert parse(data) is None


def test_transcript_of_a_life(usb, board):
    """connect, limits, move, halt, retract: exactly these packets."""
    with LacActuator(0.050, backend=usb, accuracy=4) as actuator:
        actuator.set_limits(0.0, 0.020)
        actuator.move_to(0.015, 0.001)
        actuator.halt()
        actuator.retract()
    heard = [data.hex(" ") for data in board.received]
    assert heard == [
        "01 04 00",  # accuracy
        "10 00 00",  # where is it?
        "02 00 00",  # retract limit 0
        "03 99 01",  # extend limit 409 of 409.6
        "21 33 00",  # speed 51: 1 of 20 mm/s
        "20 33 01",  # to 307: 15 mm
        "10 00 00",  # where is it?
        "20 cd 00",  # stay at 205
        "20 00 00",  # back to the limit
        "21 ff 03",  # at full speed
    ]


def test_every_unguarded_command_is_echoed(actuator, board):
    for code in set(Code) - GUARDED - {Code.SET_POSITION, Code.GET_FEEDBACK}:
        assert actuator.command(code, 77) == 77
        assert board.received[-1] == packet(code, 77)
    assert actuator.command(Code.SET_POSITION, 300) == 205  # the position, not an echo


def test_the_guarded_commands_need_their_word(actuator, board):
    for code in GUARDED:
        with pytest.raises(DeviceError, match="guarded"):
            actuator.command(code)
    with pytest.raises(DeviceError, match="write_eeprom=True"):
        actuator.disable_manual(write_eeprom=False)
    with pytest.raises(DeviceError, match="lose_settings=True"):
        actuator.reset(lose_settings=False)
    assert not {0x30, 0xFF} & {data[0] for data in board.received}
    actuator.disable_manual(write_eeprom=True)
    actuator.reset(lose_settings=True)
    assert [data.hex(" ") for data in list(board.received)[-2:]] == ["30 00 00", "ff 00 00"]
    assert board.eeprom_writes == 1


def test_moves_at_its_speed_and_stops_within_its_uncertainty(actuator, clock):
    start = actuator.position()
    assert start == pytest.approx(0.010, abs=COUNT)
    actuator.move_to(0.015, 0.002)
    clock.sleep(1.0)
    assert actuator.position() - start == pytest.approx(0.002, abs=3 * COUNT)
    clock.sleep(3.0)
    assert abs(actuator.position() - 0.015) <= actuator.uncertainty
    assert actuator.uncertainty == pytest.approx(4.5 * COUNT)
    assert actuator.counts == round(actuator.position() / COUNT)


def test_connecting_moves_nothing(actuator, virtual_bench, clock):
    before = virtual_bench.depth()
    clock.sleep(1.0)
    virtual_bench.advance(clock.now())
    assert virtual_bench.depth() == before


def test_targets_outside_the_travel_are_refused_before_they_are_sent(actuator, board):
    actuator.set_limits(0.0, 0.020)
    sent = len(board.received)
    with pytest.raises(DeviceError, match=r"target 25\.000 mm is outside the travel of 0\.00 to 19\.97 mm"):
        actuator.move_to(0.025, 0.001)
    assert len(board.received) == sent
    actuator.move_to(0.020, 0.001)
    assert board.received[-1] == packet(Code.SET_POSITION, 409)


def test_the_board_holds_the_limits_too(actuator, board, clock):
    actuator.set_limits(0.005, 0.012)
    actuator.command(Code.SET_POSITION, LARGEST)
    clock.sleep(5.0)
    assert actuator.position() == pytest.approx(0.012, abs=actuator.uncertainty)


@pytest.mark.parametrize(("low", "high"), [(0.01, 0.005), (-0.001, 0.01), (0.0, 0.06), (0.01, 0.01)])
def test_impossible_limits_are_refused(actuator, low, high):
    with pytest.raises(DeviceError, match="allowed is 0 mm <= low < high <= 50 mm"):
        actuator.set_limits(low, high)


@pytest.mark.parametrize("speed", [0.0, -0.001, 0.021])
def test_speeds_it_has_not_are_refused(actuator, speed):
    with pytest.raises(DeviceError, match="allowed is above 0 to 20 mm/s"):
        actuator.move_to(0.015, speed)


def test_a_lost_answer_is_asked_for_once_more(actuator, usb):
    usb.lost_answers = 1
    assert actuator.position() == pytest.approx(0.010, abs=COUNT)


def test_no_answer_twice_is_a_time_out(actuator, usb):
    usb.lost_answers = 2
    with pytest.raises(DeviceError, match="no answer in time at GET_FEEDBACK"):
        actuator.position()


def test_a_wrong_echo_is_refused_and_the_next_exchange_is_clean(actuator, usb):
    usb.wrong_echo = True
    with pytest.raises(DeviceError, match="SET_STALL_TIME = 500 was answered with 45 f4 01; expected 05 f4 01"):
        actuator.command(Code.SET_STALL_TIME, 500)
    usb.wrong_echo = False
    assert actuator.command(Code.SET_STALL_TIME, 500) == 500


def test_a_stale_answer_is_thrown_away(actuator, usb):
    usb._answers.append(bytes.fromhex("05 01 00"))
    with pytest.raises(DeviceError, match="was answered with 05 01 00"):
        actuator.command(Code.SET_SPEED, 9)
    assert actuator.command(Code.SET_SPEED, 9) == 9


def test_unplugged_is_named_and_replugged_can_retract(actuator, usb, board, clock):
    actuator.move_to(0.020, 0.005)
    usb.unplugged = True
    with pytest.raises(DeviceError, match="unplugged"):
        actuator.position()
    with pytest.raises(DeviceError, match=r"lost|not found"):
        actuator.retract()
    with pytest.raises(DeviceError, match="not found"):
        actuator.retract()
    usb.unplugged = False
    actuator.retract()
    assert board.target == 0.0
    clock.sleep(2.0)
    assert actuator.position() <= 5 * COUNT


def test_no_board_is_said_with_what_to_check(usb):
    usb.unplugged = True
    with pytest.raises(DeviceError, match=r"04D8:FC5F.*not found; check the USB cable"):
        LacActuator(0.050, backend=usb).connect()


def test_serial_numbers(board, usb):
    with LacActuator(0.050, backend=usb, serial="LAC00001") as actuator:
        assert actuator.info.serial == "LAC00001"
        assert actuator.info.settings["uncertainty"] == "0.22 mm"
    with pytest.raises(DeviceError, match=r"serial 'LAC00001'; the rig asks for 'LAC9'"):
        LacActuator(0.050, backend=usb, serial="LAC9").connect()


def test_two_boards_need_a_serial(board, usb, monkeypatch):
    monkeypatch.setattr(LacUsbBackend, "enumerate_devices", lambda self: ["lac", "lac"])
    with pytest.raises(DeviceError, match="2 boards; name one by `serial`"):
        LacActuator(0.050, backend=usb).connect()


def test_missing_libusb_is_named_with_its_fix(monkeypatch):
    def no_backend(**_):
        raise usb.core.NoBackendError("No backend available")

    monkeypatch.setattr(usb.core, "find", no_backend)
    with pytest.raises(DeviceError, match="apt install libusb"):
        LacActuator(0.050).connect()


def test_missing_permission_is_named_with_its_fix(usb, monkeypatch):
    def refuse(*_):
        raise usb_error("Access denied", 13)

    monkeypatch.setattr(LacUsbBackend, "set_configuration", refuse)
    with pytest.raises(DeviceError, match="udev rule"):
        LacActuator(0.050, backend=usb).connect()


def usb_error(text, number):
    return usb.core.USBError(text, -3, number)


def test_everything_needs_a_connection(usb):
    actuator = LacActuator(0.050, backend=usb)
    with pytest.raises(DeviceError, match="not connected"):
        actuator.position()
    actuator.close()
