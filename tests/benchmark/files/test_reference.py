"""The file reference is the schemas', and the one in docs/ is current."""

from pathlib import Path

from benchmark.files.reference import reference

ROOT = Path(__file__).resolve().parents[3]


def test_the_page_in_docs_is_current() -> None:
    page = (ROOT / "docs/reference-files.md").read_text()
    assert page == reference(), "make it anew: python -m benchmark.files.reference > docs/reference-files.md"


def test_every_key_has_its_bounds_default_and_words() -> None:
    page = reference()
    assert "## Scenario: tool\n" in page
    assert "| `poisson_ratio` | 0 to 0.49999 (at 0.5 the material has no finite bulk modulus) | needed |" in page
    assert '| `mesh` | `"coarse"`, `"default"`, `"fine"` | `"default"` |' in page
    assert "## session.toml: trials" in page


def test_lists_and_tables_are_no_text() -> None:
    page = reference().replace("two in a list, each -100000 m to 100000 m", "PLACE")
    assert '| `position` | PLACE | `["0 mm", "0 mm"]` |' in page
    assert "| `between` | two in a list, text each | needed |" in page
    assert "| `free` | a list, text each | none |" in page
    assert "| `table` | a list of rows, each of two, a quantity with its unit each |" in page
    assert page.count("| `tool` | a table | left out |") == 2  # of a session, and of one of its conditions
    assert "| `conditions` | tables by their names, see below |" in page
    assert "| `peak` | a quantity with its unit | needed |" in page
