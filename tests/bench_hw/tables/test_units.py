"""Units in column names."""

import numpy as np
import pytest

from bench_hw.tables.units import UNITS, from_si, join_unit, split_unit, to_si


@pytest.mark.parametrize(
    ("column", "parts"),
    [
        ("gap_mm", ("gap", "mm")),
        ("force_x_N", ("force_x", "N")),
        ("torque_z_Nmm", ("torque_z", "Nmm")),
        ("speed_mm_per_s", ("speed", "mm_per_s")),
        ("cycle", ("cycle", "")),
        ("_mm", ("_mm", "")),
        ("comm", ("comm", "")),
    ],
)
def test_the_longest_known_ending_is_the_unit(column, parts):
    assert split_unit(column) == parts
    assert join_unit(*parts) == column


def test_one_millimetre_is_the_double_nearest_to_a_thousandth():
    assert to_si(np.array([1.0, 7.0]), "mm").tolist() == [0.001, 0.007]


@pytest.mark.parametrize("unit", [*UNITS, ""])
def test_back_and_forth(unit):
    values = np.array([-3.25, 0.0, 1e-9, 12345.678])
    np.testing.assert_allclose(from_si(to_si(values, unit), unit), values, rtol=4e-16)
