import pytest

from benchmark.errors import InputError
from benchmark.verification.selection import all_cases, families, select, wanted


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
