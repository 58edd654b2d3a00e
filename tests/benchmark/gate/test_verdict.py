"""The words of a verdict."""

import pytest


def test_nothing_worse(verdict) -> None:
    found = verdict()
    assert found.passed
    assert found.failures() == []
    assert found.headline() == "Nothing got worse: 1 value and 1 timing are within limits."
    assert found.summary()[0].startswith("values: 1 against the baseline b.json")


def test_failures_name_quantity_baseline_now_and_allowed(verdict) -> None:
    found = verdict(slow=True, off=True)
    assert not found.passed
    value, time = found.failures()
    assert value == "skin_mm: baseline 5 mm, now 5.05 mm, allowed a difference of 0.005 mm"
    assert time == (
        "frame: baseline 2 x the reference workload, now 2.6 (95 % interval 2.574 to 2.626; +30.0 %), allowed 2.24"
    )
    assert found.headline() == "1 of 1 value changed, 1 of 1 timing slower."


@pytest.mark.parametrize("part", ["slow", "off"])
def test_one_of_both_is_enough(verdict, part: str) -> None:
    assert not verdict(**{part: True}).passed


def test_the_document_has_what_the_contract_asks_for(verdict) -> None:
    document = verdict(slow=True).to_dict()
    assert document["schema"] == 1
    assert document["passed"] is False
    assert set(document["accuracy"][0]) >= {"quantity", "baseline", "now", "allowed", "passed"}
    assert set(document["timing"][0]) >= {"quantity", "baseline_ratio", "now_ratio", "ci95", "allowed", "passed"}
