"""Python on a page works as it is pasted: page by page in one namespace, every name defined before it is used."""

import ast
import builtins
from itertools import groupby
from pathlib import Path

import pytest

from tests.documentation.commands import snippets

PAGES = {page: [text for _, _, text in found] for page, found in groupby(snippets(), key=lambda snippet: snippet[0])}
RUN = {"wavemodel.md", "press.md", "own-model.md"}
RUN_SLOWLY = {"fem.md", "README.md", "scripts.md"}
"""The others need a session of the reader's."""


def test_there_is_python_to_look_at() -> None:
    assert set(PAGES) >= RUN | RUN_SLOWLY


@pytest.mark.parametrize("page", sorted(PAGES))
def test_every_name_of_a_page_is_defined_on_it(page: str) -> None:
    tree = ast.parse("\n".join(PAGES[page]))
    known = set(dir(builtins))
    for node in ast.walk(tree):
        if isinstance(node, ast.alias):
            known.add((node.asname or node.name).partition(".")[0])
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            known.add(node.name)
        elif isinstance(node, ast.arg):
            known.add(node.arg)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            known.add(node.id)
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert used <= known, f"{page} uses {sorted(used - known)} without a definition"


@pytest.mark.parametrize(
    "page", [*sorted(RUN), *(pytest.param(page, marks=pytest.mark.slow) for page in sorted(RUN_SLOWLY))]
)
def test_what_a_page_has_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    namespace: dict[str, object] = {"__name__": "pasted"}
    for text in PAGES[page]:
        exec(compile(text, page, "exec"), namespace)
