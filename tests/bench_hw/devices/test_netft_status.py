"""Status words."""

import pytest

from bench_hw.devices.netft_status import describe, is_fault, is_saturated


@pytest.mark.parametrize(
    ("status", "fault", "saturated", "says"),
    [
        (0x00000000, False, False, "healthy"),
        (0x80010000, False, False, "condition latched"),
        (0x80020000, True, True, "transducer saturated"),
        (0x00020000, True, True, "transducer saturated"),
        (0xC0000000, True, False, "CPU or RAM error"),
        (0x80030000, True, True, "transducer saturated, condition latched"),
        (0x00000100, True, False, "other bits 0x100"),
    ],
)
def test_meaning(status, fault, saturated, says):
    assert (is_fault(status), is_saturated(status), describe(status)) == (fault, saturated, says)
