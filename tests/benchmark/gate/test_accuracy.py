"""The verdict on accuracy."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.errors import InputError, NotComparableError
from benchmark.gate.accuracy import WIDE, compare_values, tolerance_of, wide_remarks
from benchmark.gate.baseline import StoredValue
from benchmark.gate.gate_file import Tolerance
from benchmark.gate.plan import load_plan

SHIPPED = load_plan(None).file.tolerances


def mm(value: float | None, reason: str | None = None) -> StoredValue:
    return StoredValue(value=value, unit="mm", reason=reason)


def compare(now: StoredValue, base: StoredValue, name: str = "press.max_deformation_mm.skin"):
    return compare_values({name: now}, {name: base}, SHIPPED, "the baseline")[0]


@given(
    value=st.floats(1e-3, 100.0),
    sign=st.sampled_from([-1.0, 1.0]),
    off=st.one_of(st.floats(0.0099, 0.5), st.floats(-0.5, -0.0099)),
)
def test_one_per_cent_in_any_deflection_is_always_caught(value: float, sign: float, off: float) -> None:
    row = compare(mm(sign * value * (1.0 + off)), mm(sign * value))
    assert not row.passed
    assert row.share > 1.0


@given(value=st.floats(1e-3, 100.0), off=st.floats(-0.0009, 0.0009))
def test_less_than_the_tolerance_passes(value: float, off: float) -> None:
    row = compare(mm(value * (1.0 + off)), mm(value))
    assert row.passed
    assert row.share <= 1.0


def test_allowed_is_relative_and_absolute() -> None:
    assert compare(mm(5.0), mm(5.0)).allowed == pytest.approx(5e-3 + 1e-6)
    assert compare(mm(0.9e-6), mm(0.0)).passed
    assert not compare(mm(1.1e-6), mm(0.0)).passed


def test_a_value_that_is_gone_fails_with_its_reason() -> None:
    row = compare(mm(None, "stopped early at step 3"), mm(5.0))
    assert not row.passed
    assert row.share == math.inf
    assert row.to_dict()["reason"] == "stopped early at step 3"


def test_without_a_value_on_both_sides_nothing_got_worse() -> None:
    row = compare(mm(None, "stopped early"), mm(None, "stopped early"))
    assert row.passed
    assert row.share == 0.0


@pytest.mark.parametrize(
    ("now", "base"),
    [
        ({"a_mm": mm(1.0)}, {"b_mm": mm(1.0)}),
        ({"a_mm": mm(1.0)}, {}),
        ({"a": StoredValue(value=1, unit="N")}, {"a": mm(1.0)}),
    ],
)
def test_other_quantities_cannot_be_compared(now: dict, base: dict) -> None:
    with pytest.raises(NotComparableError, match=r"a.*--accept"):
        compare_values(now, base, SHIPPED, "the baseline")


def test_a_quantity_in_another_unit_is_said_to_be() -> None:
    with pytest.raises(NotComparableError, match=r"a \(in mm there, in N here\)"):
        compare_values({"a": StoredValue(value=1, unit="N")}, {"a": mm(1.0)}, SHIPPED, "the baseline")


def with_curve(*values: float | None) -> StoredValue:
    return StoredValue(value=5.0, unit="mm", curve={f"step {k}": value for k, value in enumerate(values, start=1)})


def curve_row(now: StoredValue, base: StoredValue, tolerances=SHIPPED):
    name = "press.max_deformation_mm.skin"
    return compare_values({name: now}, {name: base}, tolerances, "the baseline")[1]


def test_a_curve_is_allowed_a_share_of_its_largest_value() -> None:
    base = with_curve(0.0, 1.0, 5.0)
    row = curve_row(with_curve(0.0, 1.004, 5.0), base)
    assert row.passed
    assert row.allowed == pytest.approx(5e-3 + 1e-6)
    row = curve_row(with_curve(0.0, 1.006, 5.0), base)
    assert not row.passed
    assert (row.label, row.baseline, row.now) == ("press.max_deformation_mm.skin.curve at step 2", 1.0, 1.006)
    assert curve_row(base, base).at == "step 3"


def test_a_step_without_a_number_fails_where_there_was_one() -> None:
    row = curve_row(with_curve(1.0, None), with_curve(1.0, 2.0))
    assert not row.passed
    assert row.reason == "it is not a finite number"
    assert not curve_row(with_curve(1.0, 2.0), with_curve(1.0, None)).passed
    assert curve_row(with_curve(1.0, None), with_curve(1.0, None)).passed


def test_a_curve_follows_its_value_unless_a_tolerance_is_for_curves() -> None:
    """Gate files from before there were curves have a tolerance for each value, and may have none that fits a curve."""
    base, now = with_curve(1.0, 5.0), with_curve(1.2, 5.0)
    for_values = Tolerance(quantity="*.max_deformation_mm.skin", rtol=0.05, atol="0 mm")
    last = Tolerance(quantity="*", rtol=1e-9, atol="1e-9")
    assert curve_row(now, base, [for_values]).passed
    assert curve_row(now, base, [for_values, last]).passed
    for_curves = Tolerance(quantity="*.curve", rtol=0.01, atol="0 mm")
    assert not curve_row(now, base, [for_values, for_curves]).passed


def test_a_tolerance_that_gates_little_is_warned_of() -> None:
    """0.5 for half a per cent let half of a deflection pass, without a word."""
    values = {"a.max_deformation_mm.skin": with_curve(1.0, 5.0), "fit.zero_N": StoredValue(value=1e-6, unit="N")}
    assert wide_remarks(values, SHIPPED) == []
    (said,) = wide_remarks(values, [Tolerance(quantity="*_mm*", rtol=0.5, atol="1 nm"), *SHIPPED])
    assert "a.max_deformation_mm.skin (50 %)" in said
    assert "zero_N" not in said
    (said,) = wide_remarks(values, [Tolerance(quantity="*_mm*", rtol=0.001, atol="1 mm"), *SHIPPED])
    assert "skin (20.1 %)" in said
    (said,) = wide_remarks(values, [Tolerance(quantity="*.curve", rtol=0.06, atol="1 nm"), *SHIPPED])
    assert "a.max_deformation_mm.skin.curve (6 %)" in said
    assert wide_remarks(values, [Tolerance(quantity="*_mm*", rtol=WIDE, atol="0 mm"), *SHIPPED]) == []


def test_a_curve_is_not_judged_where_its_value_changed() -> None:
    """One change would be red twice."""
    now = with_curve(1.0, 6.0).model_copy(update={"value": 6.0})
    name = "press.max_deformation_mm.skin"
    rows = compare_values({name: now}, {name: with_curve(1.0, 5.0)}, SHIPPED, "the baseline")
    assert [(row.quantity, row.passed) for row in rows] == [(name, False)]


def test_the_first_pattern_that_fits_holds() -> None:
    rules = [
        Tolerance(quantity="*.skin", rtol=0.02, atol="0.5 mm"),
        Tolerance(quantity="*", rtol=0.01, atol="1 um"),
    ]
    assert tolerance_of("press.max_deformation_mm.skin", "mm", rules) == pytest.approx((0.02, 0.5))
    assert tolerance_of("press.max_deformation_mm.fat", "mm", rules) == pytest.approx((0.01, 1e-3))
    with pytest.raises(InputError, match=r"atol.*press\.peak_force_N"):
        tolerance_of("press.peak_force_N", "N", rules)
    with pytest.raises(InputError, match="no tolerance"):
        tolerance_of("press.peak_force_N", "N", rules[:1])
