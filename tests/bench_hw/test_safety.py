"""The safety monitor."""

import numpy as np
import pytest

from bench_hw.devices.protocols import ForceBlock
from bench_hw.safety import FROZEN, SafetyError, SafetyLimits, SafetyMonitor


def block(force, time=0.001, sample=7, status=0):
    force = np.atleast_2d(np.asarray(force, float))
    n = len(force)
    wrench = np.zeros((n, 6))
    wrench[:, : force.shape[1]] = force
    time = time + 1e-3 * np.arange(n)
    samples = (sample + 7 * np.arange(n)).astype(np.uint32)
    return ForceBlock(time, wrench, samples, samples, np.full(n, status, np.uint32))


@pytest.fixture
def monitor():
    limits = SafetyLimits(6.0, 0.05, (0.0, 0.02), (25.0, 25.0, 35.0, 0.25, 0.25, 0.25), FROZEN)
    return SafetyMonitor(limits, started=0.0, tolerance=1e-4)


def test_a_force_below_the_limit_passes(monitor):
    monitor.check_force(block([[0.0, 0.0, -5.99]] * 3))


def test_the_first_sample_over_the_limit_is_named(monitor):
    with pytest.raises(SafetyError, match=r"6\.100 N is above the limit of 6 N") as caught:
        monitor.check_force(block([[0, 0, -5.0], [0, 0, -6.1], [0, 0, -7.0]], time=1.0))
    assert caught.value.kind == "force_limit"
    assert caught.value.time == pytest.approx(1.001)


def test_the_limit_is_on_the_magnitude_whatever_the_direction(monitor):
    with pytest.raises(SafetyError, match="force"):
        monitor.check_force(block([[4.0, 4.0, 3.0]]))
    with pytest.raises(SafetyError, match="force"):
        monitor.check_force(block([[0.0, 0.0, 6.5]]))


def test_a_torque_beyond_the_sensors_range_is_a_fault(monitor):
    with pytest.raises(SafetyError, match=r"Ty = -0\.260") as caught:
        monitor.check_force(block([[0, 0, 0, 0, -0.26, 0]]))
    assert caught.value.kind == "force_range"


def test_unknown_ranges_check_nothing():
    SafetyMonitor(SafetyLimits(), 0.0).check_force(block([[0, 0, 1, 9, 9, 9]]))


@pytest.mark.parametrize(
    ("status", "kind"),
    [
        (0x80020000, "force_saturated"),
        (0xC0000000, "force_status"),
        (0x80000000, "force_status"),
        (0x00000001, "force_status"),
    ],
)
def test_a_bad_status_is_a_fault(monitor, status, kind):
    with pytest.raises(SafetyError) as caught:
        monitor.check_force(block([[0, 0, 0]], status=status))
    assert caught.value.kind == kind


def test_the_condition_latch_alone_is_no_fault(monitor):
    monitor.check_force(block([[0, 0, 0]], status=0x80010000))


def test_silence_is_stale_after_the_allowed_time(monitor):
    monitor.check_force(block([[0, 0, 0]], time=1.0))
    monitor.check_fresh(1.049)
    with pytest.raises(SafetyError, match="no new force data for 60 ms; allowed are 50 ms") as caught:
        monitor.check_fresh(1.060)
    assert caught.value.kind == "force_stale"


def test_a_repeated_sample_number_is_stale_though_records_come(monitor):
    monitor.check_force(block([[0, 0, 0]], time=1.0, sample=70))
    for k in range(1, 49):
        monitor.check_force(block([[0, 0, 0]], time=1.0 + 1e-3 * k, sample=70))
        monitor.check_fresh(1.0 + 1e-3 * k)
    with pytest.raises(SafetyError, match="no new force data"):
        monitor.check_fresh(1.055)


def test_data_is_fresh_from_where_its_sample_number_last_moved(monitor):
    frozen = block([[0, 0, 0]] * 4, time=1.0)
    samples = np.array([7, 14, 14, 14], np.uint32)
    monitor.check_force(ForceBlock(frozen.time, frozen.wrench, samples, samples, frozen.status))
    monitor.check_fresh(1.050)
    with pytest.raises(SafetyError, match="no new force data"):
        monitor.check_fresh(1.052)


def test_travel_is_watched_with_the_actuators_own_uncertainty(monitor):
    monitor.check_position(0.02005, 1.0)
    with pytest.raises(SafetyError, match=r"position 20\.20 mm is outside") as caught:
        monitor.check_position(0.0202, 1.0)
    assert caught.value.kind == "travel"


def test_a_silent_camera_is_lost_after_a_second(monitor):
    monitor.check_camera(1, 0.5)
    monitor.check_camera(0, 1.4)
    with pytest.raises(SafetyError, match="no frame") as caught:
        monitor.check_camera(0, 1.6)
    assert caught.value.kind == "camera_lost"


@pytest.mark.parametrize(("value", "shown"), [(np.nan, "nan"), (-np.inf, "-inf")])
def test_a_force_that_is_no_number_is_a_fault(monitor, value, shown):
    with pytest.raises(SafetyError, match=f"gives Fz = {shown}; allowed are finite numbers") as caught:
        monitor.check_force(block([[0, 0, 0], [0, 0, value]], time=1.0))
    assert caught.value.kind == "force_invalid"
    assert caught.value.time == pytest.approx(1.001)


def test_a_reading_that_never_changes_is_a_fault_though_samples_are_numbered_on(monitor):
    monitor.check_force(block([[0, 0, -1.0], [0, 0, -1.1]], time=1.0))
    for k in range(1, 251):
        monitor.check_force(block([[0, 0, -1.1]], time=1.001 + 1e-3 * k, sample=7 + 7 * k))
    with pytest.raises(SafetyError, match=r"changed by one digit for 251 ms; allowed are 250 ms") as caught:
        monitor.check_force(block([[0, 0, -1.1]], time=1.252, sample=7 * 400))
    assert caught.value.kind == "force_frozen"


def test_one_component_that_moves_is_enough(monitor):
    for k in range(600):
        monitor.check_force(block([[0, 0, -1.1, 0, 1e-6 * (k % 2), 0]], time=1e-3 * k, sample=7 * k))


def test_few_equal_samples_of_a_slow_sensor_are_no_fault(monitor):
    for k in range(4):
        monitor.check_force(block([[0, 0, -1.1]], time=float(k), sample=7 * k))
    with pytest.raises(SafetyError, match="repeats one value"):
        monitor.check_force(block([[0, 0, -1.1]], time=4.0, sample=7 * 4))
