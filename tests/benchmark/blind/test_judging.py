"""Scoring against answers made by hand."""

import pytest

from benchmark.blind.cases import BlindCase
from benchmark.blind.judging import f1, failed, judge

HOLD, LOAD, LIFTED = ("force_z", "hold"), ("force_z", "load"), ("force_z", "after_lift_off")


def test_a_right_answer(saturation: BlindCase, answer) -> None:
    strongest = saturation.cells.strongest
    said = answer(
        "named",
        {"force_saturation": ("strain_stiffening",)},
        where=saturation.cells.shows,
        gap=(("force_z", "trial", 0.2), ("force_z", "condition", 0.9)),
    )
    judged = judge(saturation, said, 3.0)
    assert judged.said == "force_saturation"
    assert judged.reported == judged.first_set == "force_saturation+strain_stiffening"
    assert judged.place_found is True
    assert judged.place_f1 == 1.0
    assert judged.gap_closed == 0.9
    assert judged.strongest == " ".join(strongest)


def test_under_outside_catalogue_nothing_is_named(saturation: BlindCase, answer) -> None:
    judged = judge(saturation, answer("outside_catalogue", {"force_saturation": ()}), 1.0)
    assert judged.said == judged.reported == ""
    assert judged.place_found is False
    assert judged.gap_closed is None


def test_a_discovery_that_raises_has_said_nothing(saturation: BlindCase) -> None:
    judged = failed(saturation, ValueError("no luck"), 1.0)
    assert (judged.verdict, judged.said, judged.place_found) == ("error", "", False)
    assert judged.remark == "ValueError: no luck"


def test_f1_over_cells() -> None:
    assert f1({HOLD, LOAD}, {HOLD, LOAD}, set()) == 1.0
    assert f1({HOLD}, {HOLD, LOAD}, set()) == pytest.approx(2 / 3)
    assert f1({HOLD, LIFTED}, {HOLD}, set()) == pytest.approx(2 / 3)
    assert f1({HOLD, LIFTED}, {HOLD}, {LIFTED}) == 1.0
    assert f1(set(), {HOLD}, set()) == 0.0
