"""The twins of one bench, and faults at their times."""

from contextlib import closing

import pytest

from bench_hw.clock import SimulatedClock
from bench_hw.errors import InputError
from bench_hw.simulated.netft_box import BoxSettings
from bench_hw.simulated.specimen import SheetSpecimen
from bench_hw.simulated.tabulated import Scatter, TabulatedSpecimen, read_sheet
from bench_hw.simulated.twins import TimedFault, TwinSettings, switch_on


@pytest.fixture
def clock():
    return SimulatedClock()


@pytest.fixture
def twins(clock):
    twins = switch_on(TwinSettings(SheetSpecimen(), 0.05, 0.02, 0.005, box=BoxSettings(rate=1000)), clock)
    yield twins
    twins.close()


def test_a_fault_begins_and_ends_at_its_time(twins, clock):
    twins.schedule([TimedFault("usb_unplug", at=0.5, duration=0.2)])
    clock.sleep(0.499)
    assert not twins.usb.unplugged
    clock.sleep(0.002)
    assert twins.usb.unplugged
    clock.sleep(0.25)
    assert not twins.usb.unplugged


def test_only_where_presses_differ_does_the_drive_leave_rest_late_and_never_twice_alike(twins, clock):
    scattering = TwinSettings(TabulatedSpecimen(read_sheet("phantom"), scatter=Scatter()), 0.05, 0.02, 0.005)
    late = []
    with closing(switch_on(scattering, clock)) as others:
        for _ in range(50):
            others.lay_anew()
            late.append(others.bench.motion.dead_time)
    assert len(set(late)) == 50
    assert 0.0 <= min(late) < 0.004 < 0.016 < max(late) <= 0.02
    twins.lay_anew()
    assert twins.bench.motion.dead_time == 0.0


def test_a_fault_without_an_end_stays(twins, clock):
    twins.schedule([TimedFault("usb_timeout", at=0.1)])
    clock.sleep(10.0)
    assert twins.usb.lost_answers > 0


def test_a_fault_of_a_device_that_is_not_there_is_refused(twins):
    with pytest.raises(InputError, match=r"camera_freeze.*can show usb_unplug"):
        twins.schedule([TimedFault("camera_freeze", at=0.1)])


def test_closing_ends_what_was_scheduled(twins, clock):
    twins.schedule([TimedFault("usb_unplug", at=0.5)])
    twins.close()
    clock.sleep(1.0)
    assert not twins.usb.unplugged
