"""The rows as a table, and as a result folder with its page."""

import csv
import json
from html.parser import HTMLParser

import pytest

from benchmark.verification.cases import run_cases
from benchmark.verification.verification_page import (
    columns,
    document,
    headline,
    signed_error,
    text_table,
    verification_page,
    write_verification,
)

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


ENVIRONMENT = {"made": "2026-01-01", "processor": "any", "packages": {"tissuebench": "0", "numpy": "2"}}


class Text(HTMLParser):
    def __init__(self, html):
        super().__init__()
        self.found = ""
        self.feed(html)

    def handle_data(self, data):
        self.found += data


def test_the_three_files_tell_the_same(case, tmp_path):
    rows = run_cases([case("good", 0.25), case("wave_off", 1.0), case("broken", raises=ValueError("the reason"))])
    page = write_verification(rows, tmp_path / "out")
    assert json.loads((tmp_path / "out/verification.json").read_text()) == document(rows)
    with (tmp_path / "out/verification.csv").open(newline="") as stream:
        table = list(csv.DictReader(stream))
    assert [line["case"] for line in table] == ["good", "wave_off", "broken"]
    assert [line["passed"] for line in table] == ["true", "false", "false"]
    assert float(table[0]["ours"]) == rows[0].quantity.ours
    assert table[2]["ours"] == ""
    text = Text(page.read_text()).found
    for word in ("2 of 3 verification values", "wave_off is outside", "the reason", "Finite elements", "Wave model"):
        assert word in text


def test_a_page_of_good_cases_says_so_and_has_no_empty_part(case):
    page = verification_page(run_cases([case("good/one", 0.1), case("good/two", 0.2)]), ENVIRONMENT)
    assert page.verdict.status == "good"
    assert [figure.value for figure in page.key_figures] == ["2 of 2", pytest.approx(40.0)]
    assert page.key_figures[1].note == "good/two"
    assert not page.notices
    assert [section.title for section in page.sections] == ["Finite elements", "Method"]
    (table,) = [block for block in page.sections[0].blocks if hasattr(block, "rows")]
    assert [row[0] for row in table.rows] == ["good/one", "good/two"]
