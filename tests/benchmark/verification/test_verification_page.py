import pytest

from benchmark.verification.cases import run_cases
from benchmark.verification.verification_page import columns, document, headline, signed_error, text_table

KEYS = [
    "case", "source", "reference", "ours", "unit", "error_percent", "allowed_percent", "unknowns", "seconds", "passed"
]  # fmt: skip


@pytest.fixture
def rows(case):
    return run_cases([case("good", 0.25), case("off", 1.0, -0.1), case("broken", raises=ValueError("why"))])


def test_the_document_has_exactly_the_keys_of_the_schema(rows):
    found = document(rows)
    assert list(found) == ["schema", "cases"]
    assert found["schema"] == 1
    assert all(list(entry) == KEYS for entry in found["cases"])
    good = found["cases"][0]
    assert good["reference"] == 200.0
    assert good["ours"] == pytest.approx(200.5)
    assert good["error_percent"] == pytest.approx(0.25)
    assert [entry["passed"] for entry in found["cases"]] == [True, False, True, False]


def test_columns_are_the_same_table(rows):
    found, entries = columns(rows), document(rows)["cases"]
    assert list(found) == KEYS
    assert [dict(zip(found, line, strict=True)) for line in zip(*found.values(), strict=True)] == entries


def test_the_text_is_aligned_and_says_what_failed(rows):
    lines = text_table(rows).splitlines()
    assert len(lines) == 1 + len(rows)
    start = lines[0].index("source")
    assert all(line[start:] == "made up for a test" for line in lines[1:])
    ends = [line[: line.index("mm")].rstrip() for line in lines[1:4]]
    assert len({len(end) for end in ends}) == 1
    assert ["FAILED" in line for line in lines[1:]] == [False, True, False, True]


def test_the_headline_counts(rows):
    assert headline(rows) == "2 of 4 verification values are outside what is allowed"
    assert headline(rows[:1]) == "All 1 verification values are within what is allowed"


@pytest.mark.parametrize(("error", "text"), [(0.25, "+0.2500"), (-3e-12, "-3.0e-12"), (0.0, "+0.0000")])
def test_round_off_stays_recognisable(error, text):
    assert signed_error(error) == text
