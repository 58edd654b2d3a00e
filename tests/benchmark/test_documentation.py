"""The documentation's pages, links and ready files belong together."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md"))


def test_every_page_is_in_the_navigation() -> None:
    listed = set(re.findall(r": ([\w-]+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    assert {page.name for page in PAGES} <= listed


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_pages_of_the_navigation(page: Path) -> None:
    listed = (ROOT / "mkdocs.yml").read_text()
    for target in re.findall(r"\]\(([^)#:]+\.md)(?:#[\w-]+)?\)", page.read_text()):
        assert target in listed, f"{page.name} links to {target}"


def test_the_ready_ci_file_is_the_one_explained() -> None:
    explained = re.search(r"```yaml\n(.*?)```", (DOCS / "gate.md").read_text(), re.DOTALL)
    assert explained is not None
    assert (DOCS / "ci-gate.yml").read_text().partition("\n")[2] == explained[1]
