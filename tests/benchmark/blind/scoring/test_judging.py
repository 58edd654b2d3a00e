"""What an answer is worth, and the table of a blind run."""

from dataclasses import replace

import pytest

from benchmark.blind.cases import BlindCase, CaseName
from benchmark.blind.scoring.judging import (
    IMPOSSIBLE,
    Judged,
    confusion,
    f1,
    failed,
    judge,
    table,
    unanswered,
)
from benchmark.blind.scoring.lab_measures import lab_table, right
from benchmark.blind.scoring.measure_rows import BlindRow, clopper_pearson

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


CASE = Judged(
    case="",
    kind="effect",
    truth="adhesion",
    seed=0,
    session="",
    strength=20.0,
    verdict="named",
    said="adhesion",
    reported="adhesion",
    first_set="adhesion",
    p=0.01,
    strongest="force_z after_lift_off",
    place_found=True,
    place_f1=1.0,
    gap_closed=0.9,
    seconds=2.0,
)
WRONG = replace(
    CASE,
    said="force_drift",
    reported="force_drift+adhesion",
    first_set="force_drift+adhesion",
    place_f1=0.5,
    gap_closed=0.5,
)
SILENT = replace(
    CASE, verdict="no_discrepancy", said="", reported="", first_set="", place_found=False, place_f1=0.0, gap_closed=None
)
NULL = replace(SILENT, kind="null", truth="", strongest="", place_found=None, place_f1=None, strength=0.0)


def rows_of(*cases: Judged) -> dict[str, BlindRow]:
    return {row.measure: row for row in table(cases)}


def test_shares_of_effects() -> None:
    rows = rows_of(CASE, CASE, WRONG, SILENT)
    assert rows["right name first"].value == 0.5
    assert rows["right name first"].passed is False
    assert rows["right name first, up to look-alikes"].value == 0.75
    assert rows["truth inside the reported set"].value == 0.75
    assert rows["mean size of the reported set"].value == pytest.approx(4 / 3)
    assert rows["mean size of the reported set"].passed is True
    assert rows["place contains the true one"].value == 0.75
    assert rows["F1 over cells"].value == pytest.approx(2.5 / 4)
    assert rows["gap closed on a held-out condition"].value == 0.9
    assert "effects named on nulls" not in rows


def test_nulls_pairs_and_outside() -> None:
    named = replace(NULL, verdict="lookalikes", said="adhesion", reported="adhesion")
    outside = replace(CASE, kind="outside", truth="outside_lamp_heat")
    pair = replace(CASE, kind="pair", truth="adhesion+force_drift", said="force_drift+adhesion")
    rows = rows_of(
        NULL,
        NULL,
        NULL,
        named,
        outside,
        replace(outside, verdict="outside_catalogue", said=""),
        pair,
        replace(pair, said="adhesion"),
    )
    assert rows["effects named on nulls"].value == 0.25
    assert rows["nulls without a discrepancy"].value == 0.75
    assert rows["outside: wrong confident name"].value == 0.5
    assert rows["outside: flagged"].value == 0.5
    assert rows["pairs: both named"].value == 0.5


def test_clopper_pearson_against_published_values() -> None:
    # 0 of 40: 1 - 0.025^(1/40); 39 of 40: a standard textbook table
    assert clopper_pearson(0, 40) == pytest.approx((0.0, 1 - 0.025 ** (1 / 40)))
    assert clopper_pearson(40, 40) == pytest.approx((0.025 ** (1 / 40), 1.0))
    assert clopper_pearson(5, 10) == pytest.approx((0.1871, 0.8129), abs=1e-4)


def test_confusion_counts_the_first_name_or_the_verdict() -> None:
    found = confusion([CASE, WRONG, SILENT, NULL])
    assert found["adhesion"] == {"adhesion": 1, "force_drift": 1, "(no_discrepancy)": 1}
    assert found["none"] == {"(no_discrepancy)": 1}


def lab_rows(*cases: Judged) -> dict[str, BlindRow]:
    return {row.measure: row for row in lab_table(cases)}


def test_in_a_lab_the_set_up_may_be_the_answer() -> None:
    clamped = replace(CASE, lab="clamped_otherwise", setup_off="setup.support.clamp")
    setup = replace(clamped, said="setup.support.clamp+adhesion")
    instrument = replace(clamped, said="perspective", reported="perspective")
    unsure = replace(instrument, verdict="lookalikes")
    rows = lab_rows(clamped, setup, instrument, unsure)
    assert rows["clamp: right name or set-up first"].value == 0.5
    assert rows["clamp: wrong instrument, confident"].value == 0.25
    assert rows["clamp: wrong instrument, confident"].passed is False
    assert rows["tissue: sensor, confident"].value == 0.25
    assert rows["printed: right name first"].n == 0
    assert rows["printed: right name first"].passed is None


def test_a_set_up_that_is_wrong_is_no_effect_named_on_a_null() -> None:
    setup = replace(NULL, verdict="named", said="setup.tool.radius", reported="setup.tool.radius")
    rows = lab_rows(NULL, setup, replace(setup, setup_off="setup.tool.radius"), replace(setup, said="adhesion"))
    assert rows["nulls named, all labs"].value == 0.25
    assert rows["nulls: set-up said that is as told"].value == 0.25


def test_too_few_trials_count_by_themselves() -> None:
    few = replace(CASE, trials=4, lab="printed")
    rows = lab_rows(few, replace(CASE, lab="printed"), replace(WRONG, lab="printed"))
    assert rows["printed: right name first"].n == 2
    assert rows["fewer than six trials: something named"].value == 1.0
    assert rows["effects with 80 % in the set"].passed is True


def test_a_case_that_cannot_be_made_counts_nowhere() -> None:
    none = unanswered(CaseName("effect", "adhesion", 3, lab="printed"), IMPOSSIBLE, "out of reach")
    assert rows_of(CASE, none)["right name first"].n == 1
    assert lab_rows(none)["printed: right name first"].n == 0


@pytest.mark.parametrize(
    ("case", "said"),
    [(CASE, True), (WRONG, False), (NULL, True), (replace(CASE, kind="pair", truth="adhesion+force_drift"), False)],
)
def test_what_is_right_depends_on_the_kind(case: Judged, said: bool) -> None:
    assert right(case) is said


def test_what_a_session_lets_show_counts_by_itself() -> None:
    """Beside the bar, which takes every case."""
    seen = replace(CASE, lab="printed", unexplained=20.0)
    hidden = replace(SILENT, lab="printed", unexplained=2.3)
    pair = replace(CASE, kind="pair", truth="adhesion+force_drift", said="adhesion", unexplained=4.9)
    rows = lab_rows(seen, hidden, pair, replace(NULL, lab="printed"), replace(WRONG, lab="printed"))
    assert (rows["printed: right name first"].n, rows["printed: right name first"].passed) == (3, False)
    assert (rows["printed, if it can show: first"].n, rows["printed: right name first"].bar) == (
        1,
        ">= 0.9",
    )
    assert rows["printed, if it can show: first"].value == 1.0
    assert rows["pairs: both named, all labs"].n == 1
    assert rows["pairs, if both can show: both named"].n == 0
