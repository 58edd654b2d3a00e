import csv
import json
from html.parser import HTMLParser

import pytest

from benchmark.verification.cases import run_cases
from benchmark.verification.folder import write_verification
from benchmark.verification.verification_page import document, verification_page

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
