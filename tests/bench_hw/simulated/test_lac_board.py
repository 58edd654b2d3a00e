"""The simulated board's firmware: bytes in, bytes out."""

import pytest

from bench_hw.clock import SimulatedClock
from bench_hw.simulated.lac_board import LacBoard
from bench_hw.simulated.specimen import SheetSpecimen
from bench_hw.simulated.virtual_bench import ActuatorMotion, VirtualBench


@pytest.fixture
def clock():
    return SimulatedClock()


@pytest.fixture
def board(clock):
    bench = VirtualBench(SheetSpecimen(), ActuatorMotion(0.05, position=0.01, target=0.01), contact=0.02)
    return LacBoard(bench, clock)


def ask(board, text):
    answer = board.handle(bytes.fromhex(text))
    return None if answer is None else answer.hex(" ")


@pytest.mark.parametrize(
    "command", ["01 04 00", "02 00 00", "03 ff 03", "05 e8 03", "0c 01 00", "21 ff 03", "30 00 00", "ff 00 00"]
)
def test_commands_are_echoed(board, command):
    assert ask(board, command) == command


def test_feedback_and_set_position_answer_with_the_position(board, clock):
    assert ask(board, "10 00 00") == "10 cd 00"  # 205 of 1024 on 50 mm: 10 mm
    assert ask(board, "21 33 00") == "21 33 00"  # 51: 1 of 20 mm/s
    assert ask(board, "20 e1 00") == "20 cd 00"  # to 225
    clock.sleep(2.0)
    assert ask(board, "10 00 00") == "10 dd 00"  # 221: four counts short, the factory's dead band


@pytest.mark.parametrize("rubbish", ["", "10", "10 00", "10 00 00 00", "99 00 00", "20 00 04"])
def test_rubbish_has_no_answer(board, rubbish):
    assert ask(board, rubbish) is None


def test_reset_restores_what_was_set(board, clock):
    ask(board, "01 00 00")
    ask(board, "03 00 01")
    ask(board, "ff 00 00")
    ask(board, "20 00 02")
    clock.sleep(2.0)
    position = int.from_bytes(board.handle(bytes.fromhex("10 00 00"))[1:], "little")
    assert 508 <= position <= 512  # past the limit of 256, within the dead band of four
