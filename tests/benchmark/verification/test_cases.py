"""Which cases a user means, and rows of cases that compute or fail."""

import itertools

import pytest

from benchmark.errors import InputError
from benchmark.verification.cases import all_cases, families, run_case, run_cases, select, wanted


@pytest.fixture
def cases(case):
    return [case("hayes/ratio_1", 0.0), case("hayes/ratio_1.5", 0.0), case("disc/nu_0.3", 0.0, 0.0)]


def names(chosen):
    return [case.name for case in chosen]


def test_nothing_named_is_everything(cases):
    assert select(cases, []) == tuple(cases)


def test_by_family_case_and_quantity(cases):
    assert names(select(cases, ["hayes"])) == ["hayes/ratio_1", "hayes/ratio_1.5"]
    assert names(select(cases, ["hayes/ratio_1"])) == ["hayes/ratio_1"]
    assert names(select(cases, ["disc/nu_0.3/part_1"])) == ["disc/nu_0.3"]


def test_order_and_repetition_do_not_matter(cases):
    assert names(select(cases, ["hayes", "disc", "hayes/ratio_1"])) == names(cases)


def test_an_unknown_name_gets_near_ones_and_all_families(cases):
    with pytest.raises(InputError, match=r"'hays'.*did you mean hayes.*Families: hayes, disc"):
        select(cases, ["disc", "hays"])


def test_half_a_word_is_no_name(cases):
    with pytest.raises(InputError, match="'hay'"):
        select(cases, ["hay"])


def test_rows_within_what_is_named():
    assert wanted("disc/nu_0.3/part_0", [])
    assert wanted("disc/nu_0.3/part_0", ["disc"])
    assert not wanted("disc/nu_0.3/part_0", ["disc/nu_0.3/part_1"])


def test_every_case_of_both_models_has_a_name_and_a_source_of_its_own():
    cases = all_cases()
    assert len({case.name for case in cases}) == len(cases)
    assert all(case.source and " " not in case.name for case in cases)
    assert {"half_space_disc", "hayes", "layered", "cook", "wave_hayes"} <= set(families(cases))


def ticking():
    return itertools.count(0.0, 2.5).__next__


def test_quantities_of_a_case_share_its_time_and_get_names(case):
    rows = run_case(case("disc/nu_0.3", 0.1, -0.9), ticking())
    assert [row.case for row in rows] == ["disc/nu_0.3/part_0", "disc/nu_0.3/part_1"]
    assert [row.seconds for row in rows] == [2.5, 2.5]
    assert [row.passed for row in rows] == [True, False]


@pytest.mark.parametrize("error", [ArithmeticError("no equilibrium"), ValueError("bad"), RuntimeError("stuck")])
def test_a_case_that_cannot_be_computed_fails_and_the_others_go_on(case, error):
    broken, good = run_cases([case("a", raises=error), case("b", 0.0)])
    assert not broken.passed
    assert str(error) in broken.reason
    assert broken.to_dict()["ours"] is None
    assert good.passed


def test_a_fault_of_the_program_is_not_hidden(case):
    with pytest.raises(TypeError):
        run_case(case("a", raises=TypeError("typo")))


def test_only_what_is_named_is_shown(case):
    rows = run_cases([case("disc", 0.1, 0.2)], ["disc/part_1"])
    assert [row.case for row in rows] == ["disc/part_1"]


def test_a_quantity_that_a_case_does_not_have(case):
    with pytest.raises(InputError, match=r"'disc/part_7'.*disc/part_0, disc/part_1"):
        run_cases([case("disc", 0.1, 0.2)], ["disc/part_7"])


def test_a_broken_case_stands_for_its_quantity(case):
    (row,) = run_cases([case("disc", raises=ValueError("broken"))], ["disc/part_7"])
    assert row.case == "disc"


def test_progress_names_each_case_before_it_runs(case):
    seen = []
    run_cases([case("a", 0.0), case("b", 0.0)], on_case=lambda each, number: seen.append((each.name, number)))
    assert seen == [("a", 0), ("b", 1)]
