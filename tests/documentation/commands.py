"""The commands and the Python that README and docs tell a reader to type, in the order of each page."""

import ast
import re
import shlex
import textwrap
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))


@dataclass(frozen=True)
class Command:
    """One command line of a page: the page's name, the line's number, the program and its arguments."""

    page: str
    line: int
    program: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.page}:{self.line} {self.program} {shlex.join(self.arguments)}"


def snippets() -> list[tuple[str, int, str]]:
    """Page, line and text of every block that is Python and calls something, as it is pasted; none with TOML in it."""
    return [found for page in PAGES for found in _snippets(page)]


def _snippets(page: Path) -> list[tuple[str, int, str]]:
    text = page.read_text(encoding="utf-8")
    found = []
    for match in re.finditer(
        r"(?:^    [^\n]*\n(?:[ ]*\n(?=    ))?)+|^```python\n.*?^```$", text, re.MULTILINE | re.DOTALL
    ):
        block = textwrap.dedent(match[0]).strip().removeprefix("```python").removesuffix("```")
        try:
            calls = any(isinstance(node, ast.Call) for node in ast.walk(ast.parse(block)))
        except SyntaxError:
            continue
        if calls and not re.search(r"^\[\w+\]$", block, re.MULTILINE):
            found.append((page.name, text[: match.start()].count("\n") + 1, block))
    return found


def documented() -> list[Command]:
    """Every `python -m benchmark ...` and `python -m bench_hw ...` of an indented block."""
    return [command for page in PAGES for command in _commands(page)]


def _commands(page: Path) -> list[Command]:
    text = page.read_text(encoding="utf-8")
    found = []
    for match in re.finditer(r"^    python -m (benchmark|bench_hw)(?= )((?:[^\n]*\\\n)*[^\n]*)$", text, re.MULTILINE):
        arguments = shlex.split(match[2].replace("\\\n", " "), comments=True)
        found.append(Command(page.name, text[: match.start()].count("\n") + 1, match[1], tuple(arguments)))
    return found
