"""The documentation's pages, links and ready files belong together."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

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


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_pictures_are_there_with_words_and_small(page: Path) -> None:
    for words, target in re.findall(r"!\[([^\]]*)\]\(([^)]+)\)", page.read_text()):
        picture = DOCS / target
        assert len(words) > 10, f"{page.name}: {target} says nothing to who cannot see it"
        assert picture.read_bytes()[:4] == b"\x89PNG"
        assert picture.stat().st_size < 100_000


def test_every_picture_is_one_that_a_script_of_ours_makes_and_a_page_shows() -> None:
    shown = "".join(page.read_text() for page in PAGES)
    scripts = "".join(path.read_text() for path in (ROOT / "examples" / "gallery").glob("*.py"))
    scripts += "".join(path.read_text() for path in (ROOT / "examples").glob("*_figures.py"))
    for picture in (DOCS / "pictures").glob("*"):
        assert f"](pictures/{picture.name})" in shown
        assert f'"{picture.name}"' in scripts or f'"{picture.stem.removeprefix("theory-")}": ' in scripts


def test_the_theory_has_its_derivation_and_every_figure_of_its_script() -> None:
    text = (DOCS / "theory.md").read_text()
    tree = ast.parse((ROOT / "examples" / "theory_figures.py").read_text())
    (figures,) = (
        node.value for node in tree.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "FIGURES"
    )
    assert isinstance(figures, ast.Dict)
    for key in figures.keys:
        assert isinstance(key, ast.Constant)
        assert f"pictures/theory-{key.value}.png" in text


@pytest.mark.parametrize("name", ["github-gate.yml", "gitlab-gate.yml"])
def test_the_ready_ci_files_run_the_gate_with_options_that_it_has(name: str) -> None:
    text = (ROOT / "ci" / name).read_text()
    assert name in (DOCS / "gate.md").read_text()
    (command,) = re.findall(r"tissuebench check [^\n]*\n[^\n]*", "\n".join(_strings(yaml.safe_load(text))) + "\n\n")
    options = set(re.findall(r"--[a-z]+", command))
    assert {"--against", "--junit", "--markdown", "--history"} <= options
    known = (ROOT / "benchmark" / "cli" / "check.py").read_text() + (
        ROOT / "benchmark" / "cli" / "options.py"
    ).read_text()
    assert options <= set(re.findall(r'"(--[a-z]+)"', known))


def _strings(node: object) -> Iterator[str]:
    """All texts of a YAML document."""
    if isinstance(node, str):
        yield node
    for inner in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from _strings(inner)


def test_the_site_has_its_own_look_and_its_links_stand_out_from_the_page() -> None:
    settings = yaml.safe_load((ROOT / "mkdocs.yml").read_text())
    (look,), (script,) = settings["extra_css"], settings["extra_javascript"]
    assert "tabIndex = 0" in (DOCS / script).read_text()
    links = re.findall(r"--bs-link(?:-hover)?-color: #(\w{6})", (DOCS / look).read_text())
    assert len(links) == 2
    for colour in links:
        shares = [int(colour[k : k + 2], 16) / 255 for k in (0, 2, 4)]
        linear = [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in shares]
        luminance = sum(weight * share for weight, share in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
        assert 1.05 / (luminance + 0.05) > 4.5  # Web Content Accessibility Guidelines 2.1, 1.4.3
